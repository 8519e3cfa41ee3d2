// reference/image/image.hpp: images as plain values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "reference/base/vector.hpp"

namespace plumbline::image {

/// Linear RGB, row 0 at the top, row-major.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<Rgb> pixels;  // width * height

  [[nodiscard]] const Rgb& at(int x, int y) const { return pixels[index(x, y)]; }
  [[nodiscard]] Rgb& at(int x, int y) { return pixels[index(x, y)]; }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

[[nodiscard]] inline Image make_image(int width, int height, Rgb fill = Rgb(0.0F)) {
  const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  return {width, height, std::vector<Rgb>(count, fill)};
}

/// 8-bit sRGB, as shown on a screen; row 0 at the top.
struct Image8 {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  // 3 * width * height
};

/// An OpenEXR image: any number of named 32-bit float channels ("R", "stderr.G", "depth") and text
/// attributes. CONVENTIONS.md#images lists the names in use.
struct LayeredImage {
  int width = 0;
  int height = 0;
  std::map<std::string, std::vector<float>> channels;  // each width * height
  std::map<std::string, std::string> attributes;
};

}  // namespace plumbline::image
