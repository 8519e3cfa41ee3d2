// prt/sh/convention.hpp: the spherical-harmonic conventions of others, and the way to ours and back.
// Ours: CONVENTIONS.md#spherical-harmonics. All of theirs: CONVENTIONS.md#conventions-of-others.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "prt/sh/lighting.hpp"

namespace plumbline::sh {

/// Place of the functions of one degree. Degrees always follow each other.
enum class Arrangement {
  ascending,   // m = -l … l: 1, y, z, x, xy, yz, 3z^2-1, xz, x^2-y^2, …
  descending,  // m = l … -l: 1, x, z, y, …
  xyz,         // degree 1 as x, y, z, the others ascending
  zero_first,  // m = 0, 1, -1, 2, -2, …: 1, z, x, y, …
};

enum class Sign {
  condon_shortley,  // factor (-1)^m: -y, z, -x, xy, -yz, …
  positive,         // none
};

/// How long the functions are: B_lm = f y_lm with y_lm orthonormal.
enum class Normalization {
  orthonormal,   // f = 1
  four_pi,       // f = sqrt(4 pi): geodesy's 4 pi, N3D, e3nn's "component"
  schmidt,       // f = sqrt(4 pi/(2l + 1)): SN3D, e3nn's "norm"
  unnormalized,  // P_lm(cos theta) times cos or sin of |m| phi
  polynomial,    // 1, y, z, x, xy, yz, 3z^2-1, xz, x^2-y^2; up to 3 bands
};
/// What the numbers are to the functions; the same for orthonormal ones.
enum class Role {
  expansion,   // L = sum of c B
  projection,  // c = integral of L B
};

/// A direction's components in their frame: theirs[i] = sign[i] ours[axis[i]]. 48 there are; half mirror.
struct SignedAxes {
  std::array<int, 3> axis{0, 1, 2};
  std::array<int, 3> sign{1, 1, 1};
  bool operator==(const SignedAxes&) const = default;
};
[[nodiscard]] Vec3d apply(const SignedAxes& axes, const Vec3d& ours);
/// What `second` after `first` does.
[[nodiscard]] SignedAxes combined(const SignedAxes& first, const SignedAxes& second);
[[nodiscard]] SignedAxes inverse(const SignedAxes& axes);
[[nodiscard]] bool is_mirrored(const SignedAxes& axes);
/// All 48, identity first.
[[nodiscard]] std::vector<SignedAxes> all_signed_axes();

/// Whose coefficients they are: factor of degree l. A_l as in clamped_cosine_factor.
enum class Quantity {
  radiance,                  // 1
  irradiance,                // A_l
  irradiance_over_pi,        // A_l/pi: exit radiance at albedo 1
  radiance_over_pi,          // 1/pi
  radiance_over_4pi,         // 1/(4 pi): a mean over directions where the integral was meant
  irradiance_over_pi_twice,  // A_l/pi^2
  radiance_minus_half,       // of L - 1/2: only degree 0 is shifted
  custom,                    // Convention::factors
};

enum class Layout {
  interleaved,  // n^2 rows of r, g, b
  planar,       // r: n^2, g: n^2, b: n^2
  rgba,         // n^2 rows of r, g, b and a number that means nothing (written as 0)
  splat,        // degree 0 as r, g, b, then the rest planar (3D Gaussian splatting)
  cosine_sine,  // each channel c[2][n][n]: [0][l][m] is m >= 0, [1][l][m] is -m; unused ones 0 (SHTOOLS)
  packed,       // SHA r, g, b = (c3, c1, c2, c0 - c6), SHB r, g, b = (c4, c5, 3 c6, c7), SHC = c8 r, g, b, 1
  packed_square,  // the same with SHA.w = c0 and SHB.z = c6: the shader forms 3z^2-1 itself
};

/// What the numbers weigh. All but `sphere` see only half of the directions: they can be written, not read.
enum class Functions {
  sphere,
  h_basis_4,          // on z >= 0: 1/sqrt(2pi), sqrt(3/2pi) {y, 2z - 1, x}
  h_basis_6,          // and sqrt(15/2pi) {xy, (x^2 - y^2)/2}
  h_basis_4_half_dc,  // as h_basis_4 with 1/(2 sqrt(pi)) for the first function
  cosine_lightmap,    // means over cosine-distributed directions about +z: L0 = <L>/4, then
                      // <L w>/(8 L0) + 1/2 for w = y, z, x
};

/// A convention: six independent choices (arrangement, sign, normalisation, axes, quantity, layout).
/// The default is ours.
struct Convention {
  Arrangement arrangement = Arrangement::ascending;
  Sign sign = Sign::condon_shortley;
  Normalization normalization = Normalization::orthonormal;
  Role role = Role::expansion;
  SignedAxes axes;
  Quantity quantity = Quantity::radiance;
  std::vector<double> factors;  // of degrees 0, 1, …; only for Quantity::custom
  Layout layout = Layout::interleaved;
  Functions functions = Functions::sphere;
};

/// Theirs of ours: the factor of y_lm's coefficient by sign, normalisation and quantity together (in their
/// frame). @throws InputError for |m| > l, a degree the convention does not have (polynomial above 2, custom
/// without a factor), an overflow
[[nodiscard]] double coefficient_factor(const Convention& convention, int l, int m);
/// Place of (l, m) among the n^2 functions.
[[nodiscard]] int position(Arrangement arrangement, int l, int m);

/// How many numbers an RGB set of that many bands takes. @throws InputError where the convention does not
/// have that many bands (packed layouts: 3, polynomial: up to 3)
[[nodiscard]] std::size_t value_count(const Convention& convention, int bands);
/// The bands of a set with that many numbers; none when no number of bands gives it, or where the convention has
/// no bands (functions on a hemisphere: value_count does not look at `bands` then).
[[nodiscard]] std::optional<int> bands_of_count(const Convention& convention, std::size_t count);

/// Their numbers of our coefficients. Exact up to rounding: 1e-14 of the largest for up to 10 bands.
/// Functions on a hemisphere take all bands there are and give always the same few numbers.
/// @throws InputError where the convention does not have these bands, for a non-finite coefficient, or where
/// it would divide by a light of zero (cosine_lightmap)
[[nodiscard]] std::vector<double> from_ours(const ShRgb& ours, const Convention& convention);

struct Converted {
  ShRgb ours;
  std::vector<int>
      lost_degrees;  // the convention multiplies them by 0 (A_3, A_5, …): zero in `ours`, unknown
};
/// Our coefficients of their numbers.
/// @throws InputError for another count of numbers, a non-finite one, or functions that see only half of the
/// directions (they do not determine a light on the sphere)
[[nodiscard]] Converted to_ours(std::span<const double> values, const Convention& convention, int bands);

/// A convention as a project uses it.
struct KnownConvention {
  std::string name;     // one word, unique: the name in commands
  std::string project;  // who uses it
  std::string where;    // file or function
  Convention convention;
  int max_bands = kMaxBands;
  std::string notes;     // what one has to know
  std::string unstated;  // what the source leaves open ("sign, quantity"); the convention is then one reading
};
/// Every convention we know, in the order of CONVENTIONS.md. Ours is the first.
[[nodiscard]] const std::vector<KnownConvention>& known_conventions();
/// @throws InputError naming it where there is none of that name
[[nodiscard]] const KnownConvention& known_convention(const std::string& name);

/// {"bands", "convention": the known one's name, "coefficients": its numbers in rows}, as to_json of lighting.hpp for
/// the first, ours; read_coefficients refuses all others.
/// @throws InputError as from_ours, and for more bands than the convention has
[[nodiscard]] std::string to_json(const ShRgb& lighting, const KnownConvention& known);

/// In words, as the table of CONVENTIONS.md has them.
[[nodiscard]] std::string to_string(Arrangement arrangement);
[[nodiscard]] std::string to_string(Sign sign);
[[nodiscard]] std::string to_string(Normalization normalization, Role role);
[[nodiscard]] std::string to_string(const SignedAxes& axes);  // "x, -z, y": their x, y, z in ours
[[nodiscard]] std::string to_string(Quantity quantity);
[[nodiscard]] std::string to_string(Layout layout);
[[nodiscard]] std::string to_string(Functions functions);

}  // namespace plumbline::sh
