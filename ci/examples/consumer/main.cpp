// A white sky: path-traced irradiance at a point is pi, and so is what its SH coefficients say. Then a picture is written
// and read again, which loads the module for pictures. Exit code 1 when a number is not what it should be.
#include <cmath>
#include <cstdio>

#include "prt/sh/lighting.hpp"
#include "reference/image/file.hpp"
#include "reference/integrate/gather.hpp"
#include "reference/scene/builtin.hpp"
#include "validation/metrics/statistics.hpp"

int main() {
  using namespace plumbline;
  const light::Environment white = light::make_builtin_environment("white");
  const integrate::World world(scene::make_builtin_scene("convex"), white);
  const auto point = trace::free_point({0.0F, 100.0F, 0.0F}, {0.0F, 1.0F, 0.0F});
  const double traced = integrate::gather_irradiance(world, point, 0, integrate::GatherSettings{}).mean.y;
  // E = A_0 c_00 y_00, A_0 = pi, c_00 = sqrt(4 pi), y_00 = 1 / sqrt(4 pi).
  const double projected = kPi * sh::project_radiance(white, 1).coefficients[0].y / std::sqrt(4.0 * kPi);
  const image::Image picture =
      image::read_image(image::encode_png(image::tone_map(image::make_image(2, 1, Rgb(1.0F)))), "white.png");
  std::printf("irradiance %.6f path traced, %.6f from SH; white reads as %g; two-sided p of 1.96: %.3f\n",
              traced, projected, static_cast<double>(picture.pixels[0].x), metrics::two_sided_p(1.96));
  const bool is_right =
      std::abs(traced - kPi) <= 1e-4 && std::abs(projected - kPi) <= 1e-6 && picture.pixels[0].x == 1.0F;
  return is_right ? 0 : 1;
}
