// prt/sh/lighting.hpp: incident radiance as SH coefficients.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "prt/sh/basis.hpp"
#include "reference/light/environment.hpp"

namespace plumbline::sh {

/// RGB coefficients of a function on the sphere, coefficient_count(bands) of them, index l(l+1)+m.
struct ShRgb {
  int bands = 0;
  std::vector<RgbD> coefficients;
};

/// Value of the band-limited function in a direction (may be negative where the function it came from is
/// not).
[[nodiscard]] RgbD evaluate(const ShRgb& function, const Vec3d& direction);

/// Low-pass windows against ringing. Band l is scaled by a factor that is 1 at l = 0.
enum class Window { none, hann, lanczos, gauss, laplacian };
/// Factor of degree l among `bands` bands; `laplacian` is 1 / (1 + lambda l^2 (l+1)^2), the others ignore
/// lambda.
[[nodiscard]] double window_factor(Window window, int degree, int bands, double lambda);
[[nodiscard]] ShRgb windowed(ShRgb function, Window window, double lambda = 0.0);

/// c_lm = integral over the sphere of L(w) y_lm(w) dw by quadrature: images by their texels' exact solid
/// angles with Gauss nodes inside each texel, analytic skies by Gauss-Legendre x uniform nodes, suns in
/// closed form.
[[nodiscard]] ShRgb project_radiance(const light::Environment& environment, int bands);

/// The band-limited light as an environment, so that the path tracer can be lit by exactly what PRT sees.
[[nodiscard]] light::Environment band_limited_environment(const ShRgb& lighting, const std::string& name);

/// {"bands": n, "convention": "...", "coefficients": n^2 rows of [r, g, b]}, see CONVENTIONS.md.
[[nodiscard]] std::string to_json(const ShRgb& lighting);
/// @throws InputError naming the file and what is wrong with it.
[[nodiscard]] ShRgb read_coefficients(const std::filesystem::path& path);

}  // namespace plumbline::sh
