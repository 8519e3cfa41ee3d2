// reference/image/picture_library.hpp: OpenImageIO behind a table of functions, loaded when the first picture needs it.
// Debian's OpenImageIO brings some 250 shared libraries along, and loading them takes a third of a second: nobody who reads
// and writes OpenEXR alone should wait for that.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "reference/image/image.hpp"

namespace plumbline::image {

/// The most texels a picture may have on a side.
constexpr int kMaxPictureSide = 1 << 16;

/// Whether a file of that many bytes can hold that many texels. The best ratios of the formats in use are those of one
/// colour all over: 8256 texels a byte in PNG (1 bit, deflate's 1032), some 10,000 in OpenEXR's DWAB. A damaged header asks
/// for more, and must not be given memory.
[[nodiscard]] constexpr bool is_plausible(std::size_t texels, std::size_t bytes) {
  constexpr std::size_t kMostPerByte = 16384;
  constexpr std::size_t kAlways = std::size_t{1} << 20U;
  return texels <= kAlways + kMostPerByte * bytes;
}

/// What a file stores: `channels` values a texel, row 0 at the top; integers as fractions of their largest.
struct RawPicture {
  int width = 0;
  int height = 0;
  int channels = 0;
  bool is_srgb_encoded = false;
  std::vector<float> values;  // width * height * channels
};

/// What the module `plumbline_pictures` offers (pictures/module.cpp). Both functions throw std::runtime_error
/// with the reason alone: the caller knows the file's name.
struct PictureLibrary {
  RawPicture (*decode)(std::string_view bytes, const std::string& name);
  std::string (*encode_png)(const Image8& image);
};

/// The module's entry, and its name: a changed table is a new name.
using PictureLibraryEntry = const PictureLibrary* (*)();
constexpr const char* kPictureLibraryEntry = "plumbline_pictures_1";

/// Loads the module at the first call: from the folder <LIBDIR>/plumbline beside the running program or beside
/// the folder it lies in (a build tree, an installation), else from wherever the dynamic loader looks.
/// @throws InputError when it is not there or does not load.
[[nodiscard]] const PictureLibrary& picture_library();

}  // namespace plumbline::image
