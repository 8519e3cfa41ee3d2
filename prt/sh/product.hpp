// prt/sh/product.hpp: products of functions held in spherical harmonics, computed on their coefficients.
// Conventions: CONVENTIONS.md#spherical-harmonics.
// Every vector holds n^2 coefficients; functions throw InputError when sizes are not equal squares of
// 1 … kMaxProductBands. NaN and infinity propagate by the rules of arithmetic; nothing is clamped.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "prt/sh/tripling.hpp"

namespace plumbline::sh {

/// Coefficients of the product of two functions of n bands, projected back to n bands (thesis eq. 3.19):
///   (a * b)_i = sum_jk a_j b_k integral y_i y_j y_k.
/// Commutative to the last bit; not associative, for the truncation comes after every product.
/// Cost grows with bands^5; straight-line code for 2 … 6 bands.
[[nodiscard]] std::vector<double> product(const std::vector<double>& a, const std::vector<double>& b);
[[nodiscard]] std::vector<float> product(const std::vector<float>& a, const std::vector<float>& b);

/// The same without allocation: `out` has the size of a and b and must not overlap them.
void multiply(std::span<const double> a, std::span<const double> b, std::span<double> out);
void multiply(std::span<const float> a, std::span<const float> b, std::span<float> out);

/// All of the product: 2n - 1 bands, nothing lost. @throws InputError too when 2n - 1 > kMaxProductBands
[[nodiscard]] std::vector<double> full_product(const std::vector<double>& a, const std::vector<double>& b);

/// product(a, a), at about two thirds of its cost.
[[nodiscard]] std::vector<double> square(const std::vector<double>& a);
[[nodiscard]] std::vector<float> square(const std::vector<float>& a);
void square(std::span<const double> a, std::span<double> out);
void square(std::span<const float> a, std::span<float> out);

/// Row-major n^2 by n^2 matrix M with M g = product(f, g) for every g (thesis eq. 3.22, whose integral lacks
/// its ds). Symmetric to the last bit. Applying it costs bands^4.
[[nodiscard]] std::vector<double> product_matrix(const std::vector<double>& f);

/// product(z, f) where z is symmetric about +z, given by its n zonal coefficients (of y_l0): bands^4.
[[nodiscard]] std::vector<double> zonal_product(const std::vector<double>& zonal,
                                                const std::vector<double>& f);

/// Pairs that multiply_blocks takes side by side.
inline constexpr int kProductLanes = 16;

/// Many products at once with the widest vectors this processor has (chosen at run time: AVX-512, AVX2, SSE).
/// Blocks of 16 pairs: coefficient i of pair p of block q lies at [(q n^2 + i) 16 + p]. Same bits on every
/// processor, and the same as multiply() gives for each pair.
/// @param bands  1 … 6 straight-line, up to kMaxProductBands by table
/// @throws InputError when the spans are not equal in size or no whole number of blocks
void multiply_blocks(int bands, std::span<const float> a, std::span<const float> b, std::span<float> out);
/// multiply_blocks(bands, a, a, out) for less.
void square_blocks(int bands, std::span<const float> a, std::span<float> out);

}  // namespace plumbline::sh
