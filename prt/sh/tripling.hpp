// prt/sh/tripling.hpp: tripling coefficients, the integrals of products of three spherical harmonics.
// Conventions: CONVENTIONS.md#spherical-harmonics.
// [1] Ng, Ramamoorthi, Hanrahan, "Triple product wavelet integrals for all-frequency relighting", 2004.
// [2] Snyder, "Code generation and factoring for fast evaluation of low-order spherical harmonic products
//     and squares", Microsoft Research TR-2006-53.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

namespace plumbline::sh {

/// Largest number of bands of a product: up to here every integer below fits its type.
inline constexpr int kMaxProductBands = 32;

/// One value of the symmetric tensor, i <= j <= k.
struct Tripling {
  int i = 0;
  int j = 0;
  int k = 0;
  double value = 0.0;
};

namespace detail {

// The integral of three complex harmonics (Condon-Shortley sign inside), m1 + m2 + m3 = 0, is
//
//   sqrt((2a + 1)(2b + 1)(2c + 1) / 4 pi) (a b c; 0 0 0) (a b c; m1 m2 m3),
//
// and Racah's sum for the Wigner 3j symbol, with its denominators written as binomials, is an integer S:
//
//   (a b c; m1 m2 m3) = (-1)^(a - b - m3) S sqrt(prod (l +- m)! / (d1! d2! d3! (a + b + c + 1)!)),
//   S = sum_t (-1)^t C(d1, t) C(d2, a - m1 - t) C(d3, b + m2 - t),
//   d1 = a + b - c, d2 = a - b + c, d3 = b + c - a.
//
// So the integral is a rational times the root of the integer product (2l + 1)(l + m)!(l - m)!, over
// sqrt(4 pi). The cancelling part, S, is exact (62 rows of Pascal's triangle fit 64 bits, products of three of
// them 128); the rest is a product of about 20 long doubles: relative error below 1e-17, half an ulp of
// double after rounding.
inline constexpr int kFactorials = 3 * kMaxProductBands;
inline constexpr int kPascalRows = 2 * kMaxProductBands - 1;

[[nodiscard]] constexpr std::array<long double, kFactorials> make_factorials() {
  std::array<long double, kFactorials> result{};
  result[0] = 1.0L;
  for (std::size_t n = 1; n < result.size(); ++n) result[n] = result[n - 1] * static_cast<long double>(n);
  return result;
}
inline constexpr std::array<long double, kFactorials> kFactorial = make_factorials();

[[nodiscard]] constexpr std::array<std::int64_t, kPascalRows * kPascalRows> make_pascal() {
  std::array<std::int64_t, kPascalRows * kPascalRows> result{};
  for (std::size_t n = 0; n < kPascalRows; ++n) {
    result[n * kPascalRows] = 1;
    for (std::size_t k = 1; k <= n; ++k) {
      const std::size_t above = (n - 1) * kPascalRows + k;
      result[n * kPascalRows + k] = result[above - 1] + result[above];
    }
  }
  return result;
}
inline constexpr std::array<std::int64_t, kPascalRows* kPascalRows> kPascal = make_pascal();

[[nodiscard]] constexpr long double factorial(int n) {
  return kFactorial[static_cast<std::size_t>(n)];
}
[[nodiscard]] constexpr std::int64_t binomial(int n, int k) {
  return kPascal[static_cast<std::size_t>(n * kPascalRows + k)];
}
[[nodiscard]] constexpr int magnitude(int m) {
  return m < 0 ? -m : m;
}

/// Newton's method from above: monotone until the rounding is reached. value >= 1.
[[nodiscard]] constexpr long double square_root(long double value) {
  long double scale = 1.0L;
  while (value > 0x1p32L) {
    value *= 0x1p-32L;
    scale *= 0x1p16L;
  }
  long double root = value < 4.0L ? value : value * 0.5L;
  for (long double next = 0.5L * (root + value / root); next < root; next = 0.5L * (root + value / root))
    root = next;
  return root * scale;
}

[[nodiscard]] constexpr long double racah_sum(int a, int b, int c, int m1, int m2) {
  const int d1 = a + b - c;
  const int d2 = a - b + c;
  const int d3 = b + c - a;
  const int low = std::max({0, a - m1 - d2, b + m2 - d3});
  const int high = std::min({d1, a - m1, b + m2});
  __extension__ __int128 sum = 0;
  for (int t = low; t <= high; ++t) {
    __extension__ const __int128 term =
        static_cast<__int128>(binomial(d1, t)) * binomial(d2, a - m1 - t) * binomial(d3, b + m2 - t);
    sum += t % 2 == 0 ? term : -term;
  }
  return static_cast<long double>(sum);
}

/// Integral of Y_a^m1 Y_b^m2 Y_c^-(m1 + m2), m1, m2 >= 0; degrees obey the triangle rule, a + b + c even.
[[nodiscard]] constexpr long double complex_tripling(int a, int m1, int b, int m2, int c) {
  const int m3 = m1 + m2;
  const auto wide = [](int n) { return static_cast<long double>(n); };
  const long double rooted = wide(2 * a + 1) * wide(2 * b + 1) * wide(2 * c + 1) * factorial(a + m1) *
                             factorial(a - m1) * factorial(b + m2) * factorial(b - m2) * factorial(c + m3) *
                             factorial(c - m3);
  const long double ratio = factorial(a) * factorial(b) * factorial(c) /
                            (factorial(a + b - c) * factorial(a - b + c) * factorial(b + c - a)) /
                            factorial(a + b + c + 1);
  const long double sums = racah_sum(a, b, c, 0, 0) * racah_sum(a, b, c, m1, m2);
  // The signs of the two symbols, (-1)^(a - b) and (-1)^(a - b + m1 + m2), leave (-1)^m3.
  const long double sign = m3 % 2 == 0 ? 1.0L : -1.0L;
  constexpr long double kInverseRootFourPi = 0.282094791773878143474039725780386293L;
  // The root spans up to 1e200: multiplied in the middle, nothing leaves long double's range.
  return sign * sums * ratio * square_root(rooted) * kInverseRootFourPi;
}

struct DegreeAndM {
  int degree = 0;
  int m = 0;
};
[[nodiscard]] constexpr DegreeAndM degree_and_m(int coefficient) {
  int l = 0;
  while ((l + 1) * (l + 1) <= coefficient) ++l;
  return {l, coefficient - l * (l + 1)};
}

// Real harmonics are sqrt(2) Re Y_l^m (m > 0) and sqrt(2) Im Y_l^|m| (m < 0). A product of three cosines or
// sines of azimuth has a mean only if one frequency is the sum of the other two, M3 = M1 + M2, and if the
// number of sines is even. With all M > 0: Re a Re b Re c* and its like leave 1/4 Re(a b c*), and minus that
// when the two sines are the two lower frequencies. With an M = 0 the two others are equal, both cosines or
// both sines, and leave 1/2 Re(b c*). conj(Y_c^M) = (-1)^M Y_c^-M gives the last sign.
[[nodiscard]] constexpr double real_tripling(DegreeAndM a, DegreeAndM b, DegreeAndM c) {
  if ((a.degree + b.degree + c.degree) % 2 != 0) return 0.0;
  if (c.degree > a.degree + b.degree || a.degree > b.degree + c.degree || b.degree > a.degree + c.degree)
    return 0.0;
  if (((a.m < 0 ? 1 : 0) + (b.m < 0 ? 1 : 0) + (c.m < 0 ? 1 : 0)) % 2 != 0) return 0.0;
  if (magnitude(a.m) > magnitude(c.m)) std::swap(a, c);
  if (magnitude(b.m) > magnitude(c.m)) std::swap(b, c);
  if (magnitude(a.m) + magnitude(b.m) != magnitude(c.m)) return 0.0;
  const int top = magnitude(c.m);
  long double value = complex_tripling(a.degree, magnitude(a.m), b.degree, magnitude(b.m), c.degree) *
                      (top % 2 == 0 ? 1.0L : -1.0L);
  if (a.m != 0 && b.m != 0) {
    value *= std::numbers::sqrt2_v<long double> / 2.0L;
    if (a.m < 0 && b.m < 0) value = -value;
  }
  return static_cast<double>(value);
}

}  // namespace detail

/// Integral over the sphere of y_i y_j y_k (thesis eq. 3.20), i, j, k < kMaxProductBands^2. In closed form;
/// correct to half an ulp where long double has 64 bits. Exactly 0 where symmetry makes it so.
/// @throws InputError for an index out of range
[[nodiscard]] double tripling_coefficient(int i, int j, int k);

/// All that are not 0, i <= j <= k, in that order: 4, 25, 77, 238, 549 for 2 … 6 bands; grows with bands^5.
/// @throws InputError unless 1 <= bands <= kMaxProductBands
[[nodiscard]] std::vector<Tripling> tripling_coefficients(int bands);

}  // namespace plumbline::sh
