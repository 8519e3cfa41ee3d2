// reference/light/sky_density.hpp: densities in proportion to a sky's radiance, without its suns and its
// rotation. Internal to reference/light; EnvironmentSampler is the interface.
#pragma once

#include <functional>
#include <span>
#include <variant>
#include <vector>

#include "reference/light/environment.hpp"
#include "reference/light/texel_table.hpp"

namespace plumbline::light {

// Each density has sample(x, y), a direction for two numbers in [0, 1); pdf(direction); and centre(x, y), the
// middle of the texel that sample(x, y) lies in, for when rounding has carried that over the border.

/// A direction inside a given cell of a density's table, and the density per solid angle with which it is drawn there.
struct PlacedDirection {
  Vec3d direction{0.0};
  double density = 0.0;
};

/// A black sky.
class NoDensity {
 public:
  [[nodiscard]] Vec3d sample(double /*x*/, double /*y*/) const { return {0.0, 1.0, 0.0}; }
  [[nodiscard]] Vec3d centre(double x, double y) const { return sample(x, y); }
  [[nodiscard]] double pdf(const Vec3& /*direction*/) const { return 0.0; }
};

/// 1 / 4 pi.
class UniformDensity {
 public:
  [[nodiscard]] Vec3d sample(double x, double y) const;
  [[nodiscard]] Vec3d centre(double x, double y) const { return sample(x, y); }
  [[nodiscard]] double pdf(const Vec3& direction) const;
};

/// Cells of a lat-long grid in proportion to peak times solid angle, uniform in solid angle inside a cell.
class LatLongDensity {
 public:
  /// Writes the peaks (largest magnitude of radiance) of one row of cells; called from several threads.
  using RowPeaks = std::function<void(int row, std::span<double> peaks)>;
  LatLongDensity(int width, int height, const RowPeaks& row_peaks);

  [[nodiscard]] Vec3d sample(double x, double y) const;
  [[nodiscard]] Vec3d centre(double x, double y) const;
  [[nodiscard]] double pdf(const Vec3& direction) const;
  /// Sum of peak times solid angle.
  [[nodiscard]] double power() const { return table_.total(); }
  [[nodiscard]] const TexelTable& table() const { return table_; }
  [[nodiscard]] PlacedDirection place(const TexelTable::Pick& pick) const;

 private:
  [[nodiscard]] double cell_solid_angle(int row) const;
  [[nodiscard]] Vec3d inside_cell(const TexelTable::Pick& pick, double x, double y) const;

  int width_ = 0;
  int height_ = 0;
  std::vector<double> row_borders_;   // height + 1 values of (1 - cos theta) / 2
  std::vector<glm::dvec2> azimuths_;  // (cos, sin) of the azimuth in the middle of each column
  TexelTable table_;
};

/// Nearly in proportion to the bilinear interpolant of a lat-long image's magnitudes, which bounds the magnitude of
/// the interpolated radiance. Cells run from texel centre to texel centre; inside a cell the density per solid
/// angle is bilinear in azimuth and cos(theta), the interpolant in azimuth and theta: their ratio is within 1/2
/// and 3/2 beside a pole and within 1 +- (pi / 2 height) cot(theta) elsewhere (derivation in the .cpp).
class BilinearLatLongDensity {
 public:
  /// @throws InputError, beginning with `name`, when a texel is not finite
  BilinearLatLongDensity(const image::Image& image, const std::string& name);

  [[nodiscard]] Vec3d sample(double x, double y) const;
  [[nodiscard]] Vec3d centre(double x, double y) const;
  [[nodiscard]] double pdf(const Vec3& direction) const;
  [[nodiscard]] double power() const { return table_.total(); }
  [[nodiscard]] const TexelTable& table() const { return table_; }
  [[nodiscard]] PlacedDirection place(const TexelTable::Pick& pick) const;

 private:
  struct Corners {
    double upper_left = 0.0;
    double upper_right = 0.0;
    double lower_left = 0.0;
    double lower_right = 0.0;
    [[nodiscard]] double mean() const;
    [[nodiscard]] double at(double x, double y) const;
  };
  [[nodiscard]] Corners corners(int row, int column) const;
  [[nodiscard]] double cell_solid_angle(int row) const;
  [[nodiscard]] double height_in_cell(int row, double fraction) const;
  [[nodiscard]] Vec3d inside_cell(int row, int column, double x, double y) const;

  int width_ = 0;
  int height_ = 0;
  std::vector<float> magnitudes_;
  std::vector<double> row_borders_;  // height + 2 values of (1 - cos theta) / 2
  TexelTable table_;  // of height + 1 rows of width cells; cell (0, 0) has texel (0, 0) at its lower right
};

/// Texels of a cube map in proportion to magnitude times solid angle, uniform on the face inside a texel.
class CubeDensity {
 public:
  explicit CubeDensity(const CubeMapSky& sky);

  [[nodiscard]] Vec3d sample(double x, double y) const;
  [[nodiscard]] Vec3d centre(double x, double y) const;
  [[nodiscard]] double pdf(const Vec3& direction) const;
  [[nodiscard]] double power() const { return table_.total(); }
  [[nodiscard]] const TexelTable& table() const { return table_; }
  [[nodiscard]] PlacedDirection place(const TexelTable::Pick& pick) const;

 private:
  [[nodiscard]] Vec3d inside_texel(const TexelTable::Pick& pick, double x, double y) const;

  int side_ = 0;
  TexelTable table_;  // the six faces under each other
};

using SkyDensity =
    std::variant<NoDensity, UniformDensity, LatLongDensity, BilinearLatLongDensity, CubeDensity>;

struct SkyPart {
  SkyDensity density;
  double power = 0.0;  // integral of the density before it was normalised [W m^-2 sr^-1 sr]
};
/// @throws InputError when an image is empty, the faces of a cube are not equal squares, or a radiance is not
/// finite; the message begins with `name`.
[[nodiscard]] SkyPart make_sky_density(const Sky& sky, Lookup lookup, const std::string& name);

}  // namespace plumbline::light
