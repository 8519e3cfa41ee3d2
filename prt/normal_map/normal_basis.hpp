// prt/normal_map/normal_basis.hpp: few functions of the normal that carry what a smooth light reflects.
// [1] Sloan, "Practical PRT" (part II: normal mapping), SIGGRAPH 2005 course "Precomputed Radiance Transfer: Theory and
//     Practice". [2] Ramamoorthi & Hanrahan, "An Efficient Representation for Irradiance Environment Maps", SIGGRAPH 2001.
#pragma once

#include <array>
#include <span>

#include "reference/base/vector.hpp"

namespace plumbline::normal_map {

/// Degrees 0, 1, 2: all that an unblocked Lambertian surface reflects, up to 0.8 % of the clamped cosine's energy [2].
inline constexpr int kQuadraticBands = 3;
inline constexpr std::size_t kQuadraticCount = 9;
/// SH coefficients of 3 bands in a tangent frame (normal = +z), index l(l+1)+m.
using Quadratic = std::array<double, kQuadraticCount>;

/// Column j of row n of the normal-direction matrix: what a white Lambertian surface with the unit normal n reflects of incident
/// radiance y_j: (A_l / pi) y_j(n), with A_l = pi, 2 pi/3, pi/4 [1, "matrix A"; 2]. Nothing is clamped to the hemisphere above
/// the surface (see make_normal_basis).
[[nodiscard]] Quadratic reflected(const Vec3d& normal);

/// How often a normal occurs in a map: every direction of the hemisphere alike, or in proportion to n.z.
enum class NormalWeight { uniform, cosine };

/// Singular value decomposition of the normal-direction matrix: (A_l / pi) y_j(n) = sum_k u_k(n) s_k v_k[j]. The u_k are orthonormal over
/// the hemisphere n.z >= 0 under the weight, which sums to 1; the v_k are orthonormal rows.
struct NormalBasis {
  NormalWeight weight = NormalWeight::uniform;
  std::array<double, kQuadraticCount> singular_values{};   // descending, > 0
  std::array<Quadratic, kQuadraticCount> light_vectors{};  // v_k
};

/// The integrals over the hemisphere are exact: the integrands are polynomials of degree 5 at most.
///
/// The course [1] prints the squared energy kept by 4 and 6 terms: 93.9 and 98.7 % (uniform), 96.4 and 99.3 % (cosine-weighted).
/// This matrix keeps 93.92, 98.64, 96.29 and 99.24 %. Erratum: the speaker's notes say that the light should be clamped to the hemisphere
/// before the convolution; that matrix would keep 98.3, 99.99, 99.1 and 100.0 %: the printed figures are those of the unclamped one.
[[nodiscard]] NormalBasis make_normal_basis(NormalWeight weight);

/// Share of the squared energy (sum of squared singular values) in the first `terms`. @throws InputError unless 1 <= terms <= 9
[[nodiscard]] double energy_kept(const NormalBasis& basis, int terms);

/// u_k(n) for k = 0 … values.size()-1, n unit. Their product with s_k v_k . light is the exit radiance of a white surface.
/// @throws InputError for more than 9 values
void evaluate_normal_functions(const NormalBasis& basis, const Vec3d& normal, std::span<double> values);

/// s_k v_k: a light (tangent frame) times it gives the number that u_k(n) multiplies. @throws InputError unless 0 <= k <= 8
[[nodiscard]] Quadratic light_row(const NormalBasis& basis, int k);

}  // namespace plumbline::normal_map
