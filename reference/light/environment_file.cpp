#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "reference/base/error.hpp"
#include "reference/image/file.hpp"
#include "reference/light/environment.hpp"

namespace plumbline::light {
namespace {

using image::Image;

constexpr std::string_view kBuiltinPrefix = "builtin:";

void require_finite(const Image& image, const std::string& name) {
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const float value = image.at(x, y)[c];
        if (std::isfinite(value)) continue;
        throw InputError(fmt::format("{}: texel ({}, {}) channel {} is {}, expected a finite radiance", name,
                                     x, y, "RGB"[c], value));
      }
    }
  }
}

std::size_t set_negative_to_zero(Image& image) {
  std::size_t count = 0;
  for (Rgb& texel : image.pixels) {
    const bool is_negative = texel.x < 0.0F || texel.y < 0.0F || texel.z < 0.0F;
    if (!is_negative) continue;
    texel = glm::max(texel, Rgb(0.0F));
    ++count;
  }
  return count;
}

bool has_aspect(const Image& image, int across, int down) {
  return static_cast<long long>(image.width) * down == static_cast<long long>(image.height) * across;
}

bool has_cube_aspect(const Image& image) {
  return has_aspect(image, 4, 3) || has_aspect(image, 3, 4) || has_aspect(image, 6, 1) ||
         has_aspect(image, 1, 6);
}

EnvironmentLayout layout_of(const Image& image, EnvironmentLayout wanted, const std::string& name) {
  using enum EnvironmentLayout;
  if (wanted == lat_long) return lat_long;
  if (wanted != cube && has_aspect(image, 1, 1)) return angular_map;
  if (wanted != angular_map && has_cube_aspect(image)) return cube;
  if (wanted == automatic && has_aspect(image, 2, 1)) return lat_long;
  const char* expected = wanted == angular_map ? "1:1 for an angular map"
                         : wanted == cube      ? "4:3 or 3:4 for a cube cross, 6:1 or 1:6 for a cube strip"
                                          : "2:1 (lat-long), 1:1 (angular map), 4:3 or 3:4 (cube cross), "
                                            "6:1 or 1:6 (cube strip)";
  throw InputError(fmt::format("{}: {}x{} texels, expected an aspect ratio of {}", name, image.width,
                               image.height, expected));
}

// Where the faces +X -X +Y -Y +Z -Z lie, in units of a face, and whether the last is turned by 180 degrees.
struct CubeArrangement {
  int columns = 0;
  int rows = 0;
  std::array<glm::ivec2, 6> cells;
  bool is_last_turned = false;
};

CubeArrangement arrangement_of(const Image& image) {
  using Cells = std::array<glm::ivec2, 6>;
  if (has_aspect(image, 4, 3)) {
    return {4, 3, Cells{{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}}}, false};
  }
  if (has_aspect(image, 3, 4)) {
    return {3, 4, Cells{{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {1, 3}}}, true};
  }
  if (has_aspect(image, 6, 1)) {
    return {6, 1, Cells{{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}}}, false};
  }
  return {1, 6, Cells{{{0, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}}}, false};
}

CubeMapSky slice_cube(const Image& image) {
  const CubeArrangement arrangement = arrangement_of(image);
  const int side = image.width / arrangement.columns;
  CubeMapSky result;
  for (std::size_t face = 0; face < 6; ++face) {
    const glm::ivec2 corner = arrangement.cells.at(face) * side;
    Image& target = result.faces.at(face);
    target = image::make_image(side, side);
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) target.at(x, y) = image.at(corner.x + x, corner.y + y);
    }
  }
  if (arrangement.is_last_turned) std::reverse(result.faces[5].pixels.begin(), result.faces[5].pixels.end());
  return result;
}

Sky sky_from(Image image, EnvironmentLayout layout) {
  switch (layout) {
    case EnvironmentLayout::angular_map:
      return AngularMapSky{std::move(image)};
    case EnvironmentLayout::cube:
      return slice_cube(image);
    default:
      return LatLongSky{std::move(image)};
  }
}

}  // namespace

Environment load_environment(const std::string& source, EnvironmentLayout layout) {
  if (source.starts_with(kBuiltinPrefix)) {
    return make_builtin_environment(source.substr(kBuiltinPrefix.size()));
  }
  Image image = image::read_image(std::filesystem::path(source));
  if (image.pixels.empty()) throw InputError(fmt::format("{}: has no texels", source));
  const EnvironmentLayout found = layout_of(image, layout, source);
  require_finite(image, source);
  Environment result;
  result.name = source;
  result.texels = image.pixels.size();
  result.negative_texels = set_negative_to_zero(image);
  result.sky = sky_from(std::move(image), found);
  return result;
}

}  // namespace plumbline::light
