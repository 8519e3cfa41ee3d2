#include "validation/truth/distant.hpp"

#include <cmath>

#include "validation/truth/require.hpp"

namespace plumbline::truth {

// By symmetry only the part along the axis is left: 2 pi int_0^a cos sin = pi sin^2 a.
Vec3d disc_vector_irradiance(const Vec3d& axis, double half_angle, double radiance) {
  require(half_angle >= 0.0 && half_angle <= kPi, "disc_vector_irradiance", "0 <= half_angle <= pi",
          half_angle);
  const double s = std::sin(half_angle);
  return kPi * radiance * s * s * axis;
}

// w = (sin t cos p, cos t, sin t sin p), dw = sin t dt dp.
DistantMoments lat_long_moments(std::span<const double> texels, int width, int height) {
  const auto count = static_cast<double>(width) * static_cast<double>(height);
  require(static_cast<double>(texels.size()) == count, "lat_long_moments", "width x height texels",
          static_cast<double>(texels.size()));
  DistantMoments result;
  for (int row = 0; row < height; ++row) {
    const double t0 = kPi * row / height;
    const double t1 = kPi * (row + 1) / height;
    const double sine2 = (t1 - t0) / 2.0 - (std::sin(2.0 * t1) - std::sin(2.0 * t0)) / 4.0;
    const double upright = (std::sin(t1) * std::sin(t1) - std::sin(t0) * std::sin(t0)) / 2.0;
    for (int column = 0; column < width; ++column) {
      const double p0 = 2.0 * kPi * (static_cast<double>(column) / width - 0.5);
      const double p1 = 2.0 * kPi * (static_cast<double>(column + 1) / width - 0.5);
      const double radiance = texels[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                                     static_cast<std::size_t>(column)];
      result.flux += radiance * (p1 - p0) * (std::cos(t0) - std::cos(t1));
      result.vector += radiance * Vec3d(sine2 * (std::sin(p1) - std::sin(p0)), upright * (p1 - p0),
                                        sine2 * (std::cos(p0) - std::cos(p1)));
    }
  }
  return result;
}

// The outline is the cone of half-angle asin(R/D): on the image plane at distance 1 a circle of radius
// R/sqrt(D^2 - R^2), in a square of side 2 tan(f/2).
double sphere_silhouette_share(double radius, double distance, double fov) {
  const char* const name = "sphere_silhouette_share";
  require(radius >= 0.0 && distance > radius, name, "0 <= radius < distance", radius);
  require(fov > 0.0 && fov < kPi, name, "0 < fov < pi", fov);
  const double squared = radius * radius / (distance * distance - radius * radius);
  const double half_side = std::tan(fov / 2.0);
  require(squared <= half_side * half_side, name, "outline inside the image", std::sqrt(squared) / half_side);
  return kPi * squared / (4.0 * half_side * half_side);
}

}  // namespace plumbline::truth
