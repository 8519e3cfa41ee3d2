// reference/image/exr.hpp: layered OpenEXR in and out.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "reference/image/image.hpp"

namespace plumbline::image {

/// Reads every channel as 32-bit float and every text attribute.
/// @throws InputError when the file is missing, is no OpenEXR image, or is truncated.
[[nodiscard]] LayeredImage read_exr(const std::filesystem::path& path);

/// Writes 32-bit float channels, ZIP compressed, by rename.
/// @throws InputError when a channel has the wrong size or the path cannot be written.
void write_exr(const std::filesystem::path& path, const LayeredImage& layers);

/// The RGB image of a layer: channels "R G B" for an empty name, else "<layer>.R" …; none when one is
/// missing.
[[nodiscard]] std::optional<Image> rgb_layer(const LayeredImage& layers, std::string_view layer);
void set_rgb_layer(LayeredImage& layers, std::string_view layer, const Image& image);

}  // namespace plumbline::image
