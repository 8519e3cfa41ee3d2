// validation/conformance/subject.hpp: an implementation under test, called so that nothing it does goes unseen.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reference/base/vector.hpp"
#include "reference/image/image.hpp"
#include "validation/conformance/border.hpp"
#include "validation/conformance/plumbline_conformance.h"

namespace plumbline::conformance {

using Values = std::vector<double>;
/// None: refused.
using Answer = std::optional<Values>;

/// Calls the functions of an implementation. Coefficients go in and come out in Plumbline's own convention. Arrays
/// lie between guard values, inputs are compared with what was sent, outputs are filled with a marker before: what is
/// written outside, changed or left out is noted in misdeeds(). Functions that are not offered must not be called.
class Subject {
 public:
  /// The implementation must outlive this.
  explicit Subject(const plumbline_implementation& implementation);
  /// The same, with coefficients taken to be in this convention whatever was declared.
  Subject(const plumbline_implementation& implementation, const plumbline_convention& convention);

  [[nodiscard]] const plumbline_implementation& raw() const { return *implementation_; }
  [[nodiscard]] const Border& border() const { return border_; }
  /// Unit roundoff of the declared precision: 2^-52 or 2^-23.
  [[nodiscard]] double epsilon() const;
  /// One line each, without repetitions.
  [[nodiscard]] const std::vector<std::string>& misdeeds() const { return misdeeds_; }

  /// directions.size() rows of n^2 values.
  [[nodiscard]] Answer basis(int bands, const std::vector<Vec3d>& directions);
  [[nodiscard]] Answer hemisphere_basis(int bands, const std::vector<Vec3d>& directions);
  /// n^2 rows of r, g, b.
  [[nodiscard]] Answer project_lat_long(int bands, const image::Image& image);
  /// Six faces one after the other, each size x size.
  [[nodiscard]] Answer project_cube(int bands, int size, const std::vector<Rgb>& texels);
  [[nodiscard]] Answer lookup_lat_long(const image::Image& image, const Vec3d& direction);
  [[nodiscard]] Answer rotate(int bands, const glm::dmat3& rotation, const Values& in);
  [[nodiscard]] Answer multiply(int bands, const Values& a, const Values& b);
  [[nodiscard]] Answer exponential(int bands, const Values& in);
  [[nodiscard]] Answer logarithm(int bands, const Values& in);
  [[nodiscard]] Answer rotate_zonal(int bands, const Values& zonal, const Vec3d& axis);
  [[nodiscard]] Answer irradiance(int bands, const Values& coefficients, const Vec3d& normal);
  [[nodiscard]] Answer light_directional(int bands, const Vec3d& direction);
  [[nodiscard]] Answer light_cone(int bands, const Vec3d& direction, double half_angle_rad);
  [[nodiscard]] Answer light_sphere(int bands, const Vec3d& centre, double radius);
  [[nodiscard]] Answer light_hemisphere(int bands, const Vec3d& up, double top, double bottom);
  [[nodiscard]] Answer transfer_unshadowed(int bands, const Vec3d& normal);
  [[nodiscard]] Answer relight(int bands, const Values& transfer, const Values& lighting);
  [[nodiscard]] Answer window(int bands, const Values& in);
  [[nodiscard]] Answer dominant_direction(int bands, const Values& coefficients);
  struct Samples {
    std::vector<Vec3d> directions;
    Values densities;
  };
  [[nodiscard]] std::optional<Samples> sample_directions(int distribution, std::uint64_t seed,
                                                         std::uint64_t stream, std::size_t count);
  /// The mean, then its standard error.
  [[nodiscard]] Answer mean_and_error(const Values& samples);
  [[nodiscard]] Answer rmse(const Values& reference, const Values& test);

 private:
  class Call;
  void note(const std::string& misdeed);
  [[nodiscard]] Answer converted(int bands, const Answer& answer) const;

  const plumbline_implementation* implementation_;
  Border border_;
  std::vector<std::string> misdeeds_;
};

}  // namespace plumbline::conformance
