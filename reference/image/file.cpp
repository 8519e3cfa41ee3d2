#include "reference/image/file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/base/text.hpp"
#include "reference/image/exr.hpp"
#include "reference/image/picture_library.hpp"

namespace plumbline::image {
namespace {

enum class Content { colour, data };

// The first three channels; a gray image is repeated. Data are linear whatever the file says of its colours.
Image colours_of(const RawPicture& raw, Content content) {
  const auto channels = static_cast<std::size_t>(raw.channels);
  const bool is_gray = channels < 3;
  const bool is_srgb = content == Content::colour && raw.is_srgb_encoded;
  Image result = make_image(raw.width, raw.height);
  for (std::size_t i = 0; i < result.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float value = raw.values[i * channels + (is_gray ? 0U : static_cast<std::size_t>(c))];
      result.pixels[i][c] = is_srgb ? linear_from_srgb(value) : value;
    }
  }
  return result;
}

// Runs `body` of the picture library; its reasons may have several lines.
template <class Body>
auto naming_the_file(const std::string& name, const char* failure, Body&& body) {
  try {
    return body(picture_library());
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: {}: {}", name, failure, one_line(error.what())));
  }
}

Image read_from_memory(std::string_view bytes, const std::string& name, Content content) {
  if (bytes.empty()) throw InputError(name + ": is empty");
  if (auto colours = read_plain_exr(bytes, name)) return *std::move(colours);
  return naming_the_file(name, "cannot read as an image", [&](const PictureLibrary& library) {
    return colours_of(library.decode(bytes, name), content);
  });
}

}  // namespace

Image read_image(const std::filesystem::path& path) {
  return read_image(read_file(path), path.string());
}

Image read_image(std::string_view bytes, const std::string& name) {
  return read_from_memory(bytes, name, Content::colour);
}

Image read_data_image(std::string_view bytes, const std::string& name) {
  return read_from_memory(bytes, name, Content::data);
}

float linear_from_srgb(float srgb) {
  return srgb <= 0.04045F ? srgb / 12.92F : std::pow((srgb + 0.055F) / 1.055F, 2.4F);
}

float srgb_from_linear(float linear) {
  return linear <= 0.0031308F ? linear * 12.92F : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

Image8 tone_map(const Image& image, float exposure_stops) {
  const float scale = std::exp2(exposure_stops);
  Image8 result{image.width, image.height, {}};
  result.rgb.reserve(image.pixels.size() * 3);
  for (const Rgb& pixel : image.pixels) {
    const Rgb shown = is_finite(pixel) ? pixel * scale : Rgb(1.0F, 0.0F, 1.0F);
    for (int c = 0; c < 3; ++c) {
      const float encoded = srgb_from_linear(std::clamp(shown[c], 0.0F, 1.0F));
      result.rgb.push_back(static_cast<std::uint8_t>(std::lround(encoded * 255.0F)));
    }
  }
  return result;
}

Image8 quantise_data(const Image& image) {
  Image8 result{image.width, image.height, {}};
  result.rgb.reserve(image.pixels.size() * 3);
  for (const Rgb& pixel : image.pixels) {
    for (int c = 0; c < 3; ++c) {
      result.rgb.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(pixel[c], 0.0F, 1.0F) * 255.0F)));
    }
  }
  return result;
}

void write_png(const std::filesystem::path& path, const Image8& image) {
  write_text_atomically(path, encode_png(image));
}

std::string encode_png(const Image8& image) {
  return naming_the_file("preview.png", "cannot write",
                         [&](const PictureLibrary& library) { return library.encode_png(image); });
}

}  // namespace plumbline::image
