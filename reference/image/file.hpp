// reference/image/file.hpp: pictures from any file OpenImageIO reads, and PNG previews. OpenEXR files with channels R, G and B
// are read without OpenImageIO, which is loaded when something else is asked for (picture_library.hpp).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "reference/image/image.hpp"

namespace plumbline::image {

/// Reads the first three channels (a gray image is repeated) as linear Rec. 709: 8- and 16-bit files are sRGB
/// decoded unless they say otherwise, float and half files are taken as they are. Values are never clamped or
/// repaired.
/// @throws InputError when the file is missing, is no image, or is truncated, or OpenImageIO cannot be loaded.
[[nodiscard]] Image read_image(const std::filesystem::path& path);
/// The same from memory; `name` stands for the file in messages, its extension is a hint only.
[[nodiscard]] Image read_image(std::string_view bytes, const std::string& name);

/// Numbers that are no colours (a normal map): whatever the file says of its colour space, 0 … 255 or 65535 become 0 … 1 and nothing
/// is decoded.
[[nodiscard]] Image read_data_image(std::string_view bytes, const std::string& name);

/// The exact sRGB curve (IEC 61966-2-1), one component.
[[nodiscard]] float srgb_from_linear(float linear);
[[nodiscard]] float linear_from_srgb(float srgb);

/// Exposure (in stops), clamp to [0, 1], sRGB curve, 8 bits: the preview of a linear image. NaN shows as
/// magenta.
[[nodiscard]] Image8 tone_map(const Image& image, float exposure_stops = 0.0F);

/// The inverse of read_data_image for 8 bits: [0, 1] to 0 … 255, nearest.
[[nodiscard]] Image8 quantise_data(const Image& image);

void write_png(const std::filesystem::path& path, const Image8& image);
/// The same into memory (for pages that carry their pictures inside).
[[nodiscard]] std::string encode_png(const Image8& image);

}  // namespace plumbline::image
