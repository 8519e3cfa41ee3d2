#include "reference/light/sky_density.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"
#include "reference/light/environment_lookup.hpp"

namespace plumbline::light {
namespace {

using image::Image;

constexpr double kUniformShare = 0.05;  // of a table that is filled from lookups
constexpr int kAnalyticCells = 256;     // across; half as many down
constexpr int kLeastCells = 64;
constexpr int kMostCells = 2048;

double magnitude_of(const Rgb& radiance, const std::string& where) {
  if (!is_finite(radiance)) {
    throw InputError(
        fmt::format("{}: radiance ({}, {}, {}) is not finite", where, radiance.x, radiance.y, radiance.z));
  }
  return static_cast<double>(max_magnitude(radiance));
}

// A point in (0, 1) of a texel that float rounding of the direction cannot carry over the border: coordinates
// are good to about 1e-7 of the image, and four times that is left free.
double inside(double offset, int texels) {
  const double margin = std::min(0.25, static_cast<double>(texels) * 0x1p-21);
  return margin + (1.0 - 2.0 * margin) * offset;
}

// Polar angle from +Y by versine = (1 - cos theta) / 2 = sin^2(theta / 2), which is uniform where solid angle
// is, and precise at both poles.
Vec3d direction_from(double turns, double versine) {
  const double phi = 2.0 * kPi * (turns - 0.5);
  const double sine = 2.0 * std::sqrt(versine * (1.0 - versine));
  return {sine * std::cos(phi), 1.0 - 2.0 * versine, sine * std::sin(phi)};
}

// Solid angle of the corner (0 … s, 0 … t) of a cube face at distance 1; s or t may be negative.
double corner_solid_angle(double s, double t) {
  return std::atan2(s * t, std::sqrt(1.0 + s * s + t * t));
}
// Of the texels of one face, row by row; all six are alike.
std::vector<double> cube_texel_solid_angles(int side) {
  const auto count = static_cast<std::size_t>(side);
  const auto border = [side](std::size_t i) { return 2.0 * static_cast<double>(i) / side - 1.0; };
  std::vector<double> corners((count + 1) * (count + 1));
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] = corner_solid_angle(border(i % (count + 1)), border(i / (count + 1)));
  }
  std::vector<double> result(count * count);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const double* corner = &corners[i / count * (count + 1) + i % count];
    result[i] = corner[count + 2] - corner[count + 1] - corner[1] + corner[0];
  }
  return result;
}

using Radiance = std::function<Rgb(const Vec3&)>;

// A grid of lookups at cell centres, corners and edge midpoints: 2 width x (2 height + 1), shared by the
// cells around.
std::vector<float> lookups(const Radiance& radiance, const std::string& name, int width, int height) {
  const int across = 2 * width;
  const int down = 2 * height + 1;
  std::vector<float> result(static_cast<std::size_t>(across) * static_cast<std::size_t>(down));
  parallel_for(static_cast<std::size_t>(down), 0, [&](std::size_t row) {
    const float v = static_cast<float>(row) / static_cast<float>(down - 1);
    for (int i = 0; i < across; ++i) {
      const float u = static_cast<float>(i) / static_cast<float>(across);
      result[row * static_cast<std::size_t>(across) + static_cast<std::size_t>(i)] =
          static_cast<float>(magnitude_of(radiance(direction_from_lat_long({u, v})), name));
    }
  });
  return result;
}

// The largest of the nine lookups in and around each cell.
std::vector<float> cell_peaks(const Radiance& radiance, const std::string& name, int width, int height) {
  const std::vector<float> values = lookups(radiance, name, width, height);
  const auto across = static_cast<std::size_t>(2 * width);
  std::vector<float> peaks(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0.0F);
  for (std::size_t cell = 0; cell < peaks.size(); ++cell) {
    const std::size_t column = cell % static_cast<std::size_t>(width);
    const std::size_t row = cell / static_cast<std::size_t>(width);
    for (std::size_t j = 2 * row; j <= 2 * row + 2; ++j) {
      for (std::size_t i = 2 * column; i <= 2 * column + 2; ++i) {
        peaks[cell] = std::max(peaks[cell], values[j * across + i % across]);
      }
    }
  }
  return peaks;
}

// A texel smaller than a cell may slip between the lookups: each texel's centre raises the cell it lies in.
void raise_by_texels(std::vector<float>& peaks, int width, int height, const Image& map,
                     const std::string& name) {
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const Vec2 uv((static_cast<float>(x) + 0.5F) / static_cast<float>(map.width),
                    (static_cast<float>(y) + 0.5F) / static_cast<float>(map.height));
      if (glm::length(uv - Vec2(0.5F)) > 0.5F) continue;
      const Vec2 cell_uv = lat_long_from_direction(direction_from_angular_map(uv));
      const Texel cell = texel_at(cell_uv, width, height);
      float& peak = peaks[static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(width) +
                          static_cast<std::size_t>(cell.x)];
      peak = std::max(peak, static_cast<float>(magnitude_of(map.at(x, y), name)));
    }
  }
}

// p = (1 - share) peak / sum(peak omega) + share / 4 pi: the same constant added to every peak.
LatLongDensity mixed_with_uniform(const std::vector<float>& peaks, int width, int height) {
  double total = 0.0;
  for (int row = 0; row < height; ++row) {
    const double borders = std::cos(kPi * row / height) - std::cos(kPi * (row + 1) / height);
    for (int column = 0; column < width; ++column) {
      total += static_cast<double>(peaks[static_cast<std::size_t>(row * width + column)]) * borders;
    }
  }
  const double mean = total / (2.0 * width);
  const double base = mean > 0.0 ? mean * kUniformShare / (1.0 - kUniformShare) : 1.0;
  return {width, height, [&](int row, std::span<double> row_peaks) {
            const auto first = static_cast<std::size_t>(row) * row_peaks.size();
            for (std::size_t i = 0; i < row_peaks.size(); ++i) {
              row_peaks[i] = base + static_cast<double>(peaks[first + i]);
            }
          }};
}

void require_texels(const Image& image, const std::string& name) {
  const auto texels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.width > 0 && image.height > 0 && image.pixels.size() == texels) return;
  throw InputError(fmt::format("{}: an environment of {}x{} texels holds {}", name, image.width, image.height,
                               image.pixels.size()));
}

template <class Density>
SkyPart part_of(Density density) {
  const double power = density.power();
  if (power > 0.0) return {std::move(density), power};
  return {};
}

// The magnitudes of an image, each the largest of the 3 x 3 texels around it: at every point the bilinear lookup is
// at most this image's nearest texel, so that a density made for the nearest lookup of this image bounds it.
template <class TexelAt>
Image neighbourhood_peaks(const Image& image, const TexelAt& texel) {
  Image across = image::make_image(image.width, image.height);
  Image result = across;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (int i = std::max(x - 1, 0); i <= std::min(x + 1, image.width - 1); ++i)
        across.at(x, y) = glm::max(across.at(x, y), Rgb(max_magnitude(texel(i, y))));
    }
  }
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (int j = std::max(y - 1, 0); j <= std::min(y + 1, image.height - 1); ++j)
        result.at(x, y) = glm::max(result.at(x, y), across.at(x, j));
    }
  }
  return result;
}

void require_finite(const Image& image, const std::string& name) {
  for (const Rgb& texel : image.pixels) (void)magnitude_of(texel, name);
}

CubeMapSky neighbourhood_peaks(const CubeMapSky& sky) {
  CubeMapSky result;
  for (std::size_t face = 0; face < 6; ++face) {
    const Image& image = sky.faces.at(face);
    result.faces.at(face) = neighbourhood_peaks(image, [&](int x, int y) { return image.at(x, y); });
  }
  return result;
}

// A number in [0, 1) to one whose density is linear from `first` at 0 to `second` at 1, both >= 0:
// the root of number (first + second) / 2 = first x + (second - first) x^2 / 2 without cancellation.
double with_linear_density(double number, double first, double second) {
  const double end = std::sqrt((1.0 - number) * first * first + number * second * second);
  return first + end > 0.0 ? std::min(number * (first + second) / (first + end), 1.0) : number;
}

SkyPart make_part(const ConstantSky& sky, Lookup /*lookup*/, const std::string& name) {
  const double magnitude = magnitude_of(sky.radiance, name);
  if (magnitude > 0.0) return {UniformDensity{}, 4.0 * kPi * magnitude};
  return {};
}

SkyPart make_part(const LatLongSky& sky, Lookup lookup, const std::string& name) {
  const Image& image = sky.image;
  require_texels(image, name);
  if (lookup == Lookup::bilinear) return part_of(BilinearLatLongDensity(image, name));
  return part_of(LatLongDensity(image.width, image.height, [&](int row, std::span<double> peaks) {
    for (int x = 0; x < image.width; ++x) {
      peaks[static_cast<std::size_t>(x)] = magnitude_of(image.at(x, row), name);
    }
  }));
}

SkyPart make_part(const CubeMapSky& sky, Lookup lookup, const std::string& name) {
  const int side = sky.faces[0].width;
  for (const Image& face : sky.faces) {
    require_texels(face, name);
    if (face.width == side && face.height == side) continue;
    throw InputError(fmt::format("{}: a cube face of {}x{} texels, expected {}x{} as the first", name,
                                 face.width, face.height, side, side));
  }
  for (const Image& face : sky.faces) require_finite(face, name);
  if (lookup == Lookup::bilinear) return part_of(CubeDensity(neighbourhood_peaks(sky)));
  return part_of(CubeDensity(sky));
}

// `map` is what is looked up by nearest texel.
SkyPart part_of_angular_map(const Image& map, const std::string& name) {
  const auto is_dark = [](const Rgb& texel) { return plumbline::is_black(texel); };
  if (std::all_of(map.pixels.begin(), map.pixels.end(), is_dark)) return {};
  const int width = std::clamp(2 * map.width, kLeastCells, kMostCells);
  const auto lookup = [&](const Vec3& direction) {
    const Texel texel = texel_at(angular_map_from_direction(direction), map.width, map.height);
    return map.at(texel.x, texel.y);
  };
  std::vector<float> peaks = cell_peaks(lookup, name, width, width / 2);
  raise_by_texels(peaks, width, width / 2, map, name);
  return part_of(mixed_with_uniform(peaks, width, width / 2));
}

SkyPart make_part(const AngularMapSky& sky, Lookup lookup, const std::string& name) {
  require_texels(sky.image, name);
  if (lookup == Lookup::nearest) return part_of_angular_map(sky.image, name);
  require_finite(sky.image, name);
  const auto texel = [&](int x, int y) { return angular_map_texel(sky.image, x, y); };
  return part_of_angular_map(neighbourhood_peaks(sky.image, texel), name);
}

SkyPart make_part(const AnalyticSky& sky, Lookup /*lookup*/, const std::string& name) {
  if (!sky.radiance) throw InputError(name + ": an analytic sky without a function");
  constexpr int kHeight = kAnalyticCells / 2;
  return part_of(
      mixed_with_uniform(cell_peaks(sky.radiance, name, kAnalyticCells, kHeight), kAnalyticCells, kHeight));
}

}  // namespace

Vec3d UniformDensity::sample(double x, double y) const {
  return direction_from(x, y);
}

double UniformDensity::pdf(const Vec3& /*direction*/) const {
  return 1.0 / (4.0 * kPi);
}

LatLongDensity::LatLongDensity(int width, int height, const RowPeaks& row_peaks)
    : width_(width), height_(height), row_borders_(static_cast<std::size_t>(height) + 1) {
  for (int row = 0; row <= height; ++row) {
    const double sine = std::sin(0.5 * kPi * row / height);
    row_borders_[static_cast<std::size_t>(row)] = sine * sine;
  }
  for (int column = 0; column < width; ++column) {
    const double phi = 2.0 * kPi * ((column + 0.5) / width - 0.5);
    azimuths_.emplace_back(std::cos(phi), std::sin(phi));
  }
  table_ = TexelTable(height, width, [&](int row, std::span<double> weights) {
    row_peaks(row, weights);
    const double omega = cell_solid_angle(row);
    for (double& weight : weights) weight *= omega;
  });
}

// (2 pi / width) (cos t0 - cos t1)
double LatLongDensity::cell_solid_angle(int row) const {
  const auto i = static_cast<std::size_t>(row);
  return 4.0 * kPi / width_ * (row_borders_[i + 1] - row_borders_[i]);
}

Vec3d LatLongDensity::sample(double x, double y) const {
  return place(table_.pick(x, y)).direction;
}

PlacedDirection LatLongDensity::place(const TexelTable::Pick& pick) const {
  return {inside_cell(pick, inside(pick.x, width_), inside(pick.y, 2 * height_)),
          1.0 / cell_solid_angle(pick.row)};
}

Vec3d LatLongDensity::centre(double x, double y) const {
  return inside_cell(table_.pick(x, y), 0.5, 0.5);
}

// The azimuth is that of the column's middle turned by a = 2 pi (x - 1/2) / width: for narrow columns (|a| < 0.05) by the
// series, whose rest is below a^5 / 120 < 3e-9, for others by the library.
Vec3d LatLongDensity::inside_cell(const TexelTable::Pick& pick, double x, double y) const {
  constexpr int kNarrow = 64;
  const auto row = static_cast<std::size_t>(pick.row);
  const double versine = row_borders_[row] + (row_borders_[row + 1] - row_borders_[row]) * y;
  if (width_ < kNarrow) return direction_from((pick.column + x) / width_, versine);
  const double a = 2.0 * kPi * (x - 0.5) / width_;
  const double cosine = 1.0 - a * a * (0.5 - a * a / 24.0);
  const double sine = a * (1.0 - a * a / 6.0);
  const glm::dvec2 middle = azimuths_[static_cast<std::size_t>(pick.column)];
  const double radius = 2.0 * std::sqrt(versine * (1.0 - versine));
  return {radius * (cosine * middle.x - sine * middle.y), 1.0 - 2.0 * versine,
          radius * (sine * middle.x + cosine * middle.y)};
}

double LatLongDensity::pdf(const Vec3& direction) const {
  const Texel cell = texel_at(lat_long_from_direction(direction), width_, height_);
  return table_.probability(cell.y, cell.x) / cell_solid_angle(cell.y);
}

// Let s = (cos t0 - cos t) / (cos t0 - cos t1) be the height in a cell between the polar angles t0 and t1 = t0 + h,
// proportional to solid angle, and g = (t - t0) / h the height by angle, which the interpolant is linear in. With
// A … D the magnitudes at the corners the density of the cell is
//
//   p(x, s) = P m(x, s) / (omega (A + B + C + D) / 4),  m(x, s) bilinear with corners A … D,
//
// P the table's probability, proportional to omega (A + B + C + D) / 4 = integral of m. Marginal in s and
// conditional in x are linear: inverted in closed form. The interpolant is m(x, g); m(x, g) / m(x, s) lies between
// (1 - g) / (1 - s) and g / s, and these are between sin(tm) / sin(t1) and sin(tm) / sin(t0) to O(h^2), tm in the
// middle (in the northern half; mirrored in the southern): 1 -+ (h / 2) cot(tm). Beside the pole, t0 = h / 2, they
// are 2/3 and 2. In the half cells at the poles the two corners of each side are equal: m does not depend on s.
BilinearLatLongDensity::BilinearLatLongDensity(const Image& image, const std::string& name)
    : width_(image.width), height_(image.height) {
  magnitudes_.reserve(image.pixels.size());
  for (const Rgb& texel : image.pixels) magnitudes_.push_back(static_cast<float>(magnitude_of(texel, name)));
  row_borders_.push_back(0.0);
  for (int row = 0; row < height_; ++row) {
    const double sine = std::sin(0.5 * kPi * (row + 0.5) / height_);
    row_borders_.push_back(sine * sine);
  }
  row_borders_.push_back(1.0);
  table_ = TexelTable(height_ + 1, width_, [&](int row, std::span<double> weights) {
    const double omega = cell_solid_angle(row);
    for (int x = 0; x < width_; ++x) weights[static_cast<std::size_t>(x)] = corners(row, x).mean() * omega;
  });
}

double BilinearLatLongDensity::Corners::mean() const {
  return 0.25 * ((upper_left + upper_right) + (lower_left + lower_right));
}

double BilinearLatLongDensity::Corners::at(double x, double y) const {
  return (1.0 - y) * ((1.0 - x) * upper_left + x * upper_right) +
         y * ((1.0 - x) * lower_left + x * lower_right);
}

BilinearLatLongDensity::Corners BilinearLatLongDensity::corners(int row, int column) const {
  const int left = column > 0 ? column - 1 : width_ - 1;
  const auto magnitude = [&](int x, int y) {
    return static_cast<double>(magnitudes_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                           static_cast<std::size_t>(x)]);
  };
  const int upper = std::max(row - 1, 0);
  const int lower = std::min(row, height_ - 1);
  return {magnitude(left, upper), magnitude(column, upper), magnitude(left, lower), magnitude(column, lower)};
}

double BilinearLatLongDensity::cell_solid_angle(int row) const {
  const auto i = static_cast<std::size_t>(row);
  return 4.0 * kPi / width_ * (row_borders_[i + 1] - row_borders_[i]);
}

// s of g, by sin^2 a - sin^2 b = sin(a + b) sin(a - b) with half polar angles: no cancellation, so that s is 0 or 1
// only where g is.
double BilinearLatLongDensity::height_in_cell(int row, double fraction) const {
  if (row == 0 || row == height_) return 0.5;
  const double half_step = 0.5 * kPi / height_;
  const double first = half_step * (row - 0.5);
  const double across = half_step * fraction;
  const auto i = static_cast<std::size_t>(row);
  return std::sin(2.0 * first + across) * std::sin(across) / (row_borders_[i + 1] - row_borders_[i]);
}

Vec3d BilinearLatLongDensity::sample(double x, double y) const {
  return place(table_.pick(x, y)).direction;
}

PlacedDirection BilinearLatLongDensity::place(const TexelTable::Pick& pick) const {
  const Corners c = corners(pick.row, pick.column);
  const double height =
      with_linear_density(pick.y, c.upper_left + c.upper_right, c.lower_left + c.lower_right);
  const double left = (1.0 - height) * c.upper_left + height * c.lower_left;
  const double right = (1.0 - height) * c.upper_right + height * c.lower_right;
  const double across = with_linear_density(pick.x, left, right);
  return {inside_cell(pick.row, pick.column, across, height),
          c.at(across, height) / (c.mean() * cell_solid_angle(pick.row))};
}

Vec3d BilinearLatLongDensity::centre(double x, double y) const {
  const TexelTable::Pick pick = table_.pick(x, y);
  return inside_cell(pick.row, pick.column, 0.5, 0.5);
}

Vec3d BilinearLatLongDensity::inside_cell(int row, int column, double x, double y) const {
  const auto i = static_cast<std::size_t>(row);
  const double versine = row_borders_[i] + (row_borders_[i + 1] - row_borders_[i]) * y;
  return direction_from((column - 0.5 + x) / width_, versine);
}

double BilinearLatLongDensity::pdf(const Vec3& direction) const {
  const Vec2 uv = lat_long_from_direction(direction);
  const Neighbours u = wrapped_neighbours(uv.x, width_);
  const Neighbours v = clamped_neighbours(uv.y, height_);
  const int column = u.cell % width_;
  const Corners c = corners(v.cell, column);
  const double mean = c.mean();
  if (!(mean > 0.0)) return 0.0;
  const double height = height_in_cell(v.cell, static_cast<double>(v.fraction));
  return table_.probability(v.cell, column) * c.at(static_cast<double>(u.fraction), height) /
         (mean * cell_solid_angle(v.cell));
}

CubeDensity::CubeDensity(const CubeMapSky& sky) : side_(sky.faces[0].width) {
  const std::vector<double> solid_angles = cube_texel_solid_angles(side_);
  table_ = TexelTable(6 * side_, side_, [&](int row, std::span<double> weights) {
    const Image& face = sky.faces[static_cast<std::size_t>(row / side_)];
    const std::size_t first = static_cast<std::size_t>(row % side_) * weights.size();
    for (std::size_t x = 0; x < weights.size(); ++x) {
      weights[x] = static_cast<double>(max_magnitude(face.pixels[first + x])) * solid_angles[first + x];
    }
  });
}

Vec3d CubeDensity::sample(double x, double y) const {
  const TexelTable::Pick pick = table_.pick(x, y);
  return inside_texel(pick, inside(pick.x, side_), inside(pick.y, side_));
}

// (s, t) is at the distance r = |point| of the face's plane from the centre: ds dt = r^3 d omega.
PlacedDirection CubeDensity::place(const TexelTable::Pick& pick) const {
  const Vec3d point = inside_texel(pick, inside(pick.x, side_), inside(pick.y, side_));
  const double r = glm::length(point);
  const double texel_area = 4.0 / (static_cast<double>(side_) * side_);
  return {point / r, r * r * r / texel_area};
}

Vec3d CubeDensity::centre(double x, double y) const {
  return inside_texel(table_.pick(x, y), 0.5, 0.5);
}

Vec3d CubeDensity::inside_texel(const TexelTable::Pick& pick, double x, double y) const {
  const double s = 2.0 * (pick.column + x) / side_ - 1.0;
  const double t = 2.0 * (pick.row % side_ + y) / side_ - 1.0;
  return cube_face_point(pick.row / side_, s, t);
}

// d omega = ds dt / r^3 with r the distance to the point (s, t) of the face, 1 / (largest component of the
// unit direction); a texel is (2 / side)^2 of ds dt.
double CubeDensity::pdf(const Vec3& direction) const {
  const CubeCoordinate coordinate = cube_from_direction(direction);
  const Texel texel = texel_at(coordinate.uv, side_, side_);
  const auto nearness = static_cast<double>(max_magnitude(direction));
  const double texel_area = 4.0 / (static_cast<double>(side_) * side_);
  return table_.probability(coordinate.face * side_ + texel.y, texel.x) /
         (texel_area * nearness * nearness * nearness);
}

SkyPart make_sky_density(const Sky& sky, Lookup lookup, const std::string& name) {
  return std::visit([&](const auto& kind) { return make_part(kind, lookup, name); }, sky);
}

}  // namespace plumbline::light
