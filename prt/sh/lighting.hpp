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

/// Value of the band-limited function in a direction (unit; may be negative where the function it came from
/// is not). @throws InputError when the number of coefficients does not fit the bands
[[nodiscard]] RgbD evaluate(const ShRgb& function, const Vec3d& direction);

/// Low-pass windows against ringing. Degree l of `bands` bands n is scaled by a factor that is 1 at l = 0:
///   hann       (1 + cos(pi l / n)) / 2
///   lanczos    sin(pi l / n) / (pi l / n)
///   gauss      exp(-(pi l / n)^2 / 2)
///   laplacian  1 / (1 + lambda l^2 (l + 1)^2)        (Sloan 2008: least squared Laplacian)
enum class Window { none, hann, lanczos, gauss, laplacian };
/// Factor of degree l in 0 … bands-1. Only `laplacian` reads lambda, which must be finite and >= 0 (0 changes
/// nothing). @throws InputError outside these ranges
[[nodiscard]] double window_factor(Window window, int degree, int bands, double lambda);
[[nodiscard]] ShRgb windowed(ShRgb function, Window window, double lambda = 0.0);

/// c_lm = integral over the sphere of L(w) y_lm(w) dw, in world axes, L as environment.lookup reads the image.
///
/// - constant, suns: closed forms.
/// - lat-long: integrated exactly, be texels regions of constant radiance or interpolated bilinearly: the error is
///   rounding, 1e-14.
/// - cube map: Gauss nodes inside each texel (bilinear: each cell between texel centres), weights summing to its
///   exact solid angle: relative error below 1e-9 (2e-7 for faces of a single texel). Nearest lookup to 64 bands makes use
///   of the faces' symmetries, to the same error.
/// - angular map: the same over the part inside the disc, all weights summing to 4 pi: relative error 1e-8.
/// - analytic: Gauss-Legendre over each hemisphere of the sky's Y times uniform nodes, max(512, 8 bands) rows
///   and twice as many columns: float rounding for smooth skies and for a jump at the horizon, O(1/rows^2)
///   for other kinks (two-lobes: below 1e-6 for up to 20 bands).
///
/// Same bits for any number of threads (0 = all), but for the last ones on machines with other vector
/// instructions. Cost: O(texels bands) for lat-long, O(texels bands^2) for the others, and O(bands^4) for turning
/// the results into world axes.
/// @throws InputError for an empty image, a non-finite texel (named), a matrix that is no rotation, or bands
/// out of range
[[nodiscard]] ShRgb project_radiance(const light::Environment& environment, int bands, int threads = 0);

/// The band-limited light as an environment, so that the path tracer can be lit by exactly what PRT sees.
/// Evaluated in double, returned as float; may be called from any number of threads.
/// @throws InputError when the number of coefficients does not fit the bands
[[nodiscard]] light::Environment band_limited_environment(const ShRgb& lighting, const std::string& name);

/// What the "convention" field of a coefficient file says; readers know no other.
inline constexpr const char* kConventionName = "orthonormal, Condon-Shortley, index l(l+1)+m, z-polar";
/// {"bands": n, "convention": kConventionName, "coefficients": n^2 rows of [r, g, b]}, 17 significant digits:
/// reading gives the same bits. @throws InputError for a non-finite coefficient or a count that does not fit
/// the bands
[[nodiscard]] std::string to_json(const ShRgb& lighting);
/// @throws InputError naming the file and what is wrong with it: missing, malformed, bands out of range,
/// another convention, another number of rows, a row that is not three finite numbers.
[[nodiscard]] ShRgb read_coefficients(const std::filesystem::path& path);

}  // namespace plumbline::sh
