// reference/image/exr.hpp: layered OpenEXR in and out.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "reference/image/image.hpp"

namespace plumbline::image {

/// Reads every channel as 32-bit float and every text attribute.
/// @throws InputError when the file is missing, is no OpenEXR image, or is truncated.
[[nodiscard]] LayeredImage read_exr(const std::filesystem::path& path);

/// Reads the channels R, G and B of an OpenEXR image in memory; `name` stands for the file in messages. None when
/// the bytes are no OpenEXR image, or one that wants a fuller reader: several parts, deep data, no R, G and B of
/// float or half, subsampled channels.
/// @throws InputError when the image is truncated or damaged, or a side is above kMaxPictureSide.
[[nodiscard]] std::optional<Image> read_plain_exr(std::string_view bytes, const std::string& name);

/// Writes 32-bit float channels, ZIP compressed, by rename.
/// @throws InputError when a channel has the wrong size or the path cannot be written.
void write_exr(const std::filesystem::path& path, const LayeredImage& layers);

/// The RGB image of a layer: channels "R G B" for an empty name, else "<layer>.R" …; none when one is
/// missing.
[[nodiscard]] std::optional<Image> rgb_layer(const LayeredImage& layers, std::string_view layer);
void set_rgb_layer(LayeredImage& layers, std::string_view layer, const Image& image);

}  // namespace plumbline::image
