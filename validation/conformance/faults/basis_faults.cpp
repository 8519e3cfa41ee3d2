#include <array>
#include <cmath>

#include "validation/conformance/faults/build.hpp"

namespace plumbline::conformance {
namespace {

/// k-th factorial in 32 bits: wraps from 13! on.
double wrapped_factorial(int k) {
  std::uint32_t product = 1;
  for (int i = 2; i <= k; ++i) product *= static_cast<std::uint32_t>(i);
  return static_cast<double>(static_cast<std::int32_t>(product));
}
double factorial(int k) {
  return std::tgamma(k + 1.0);
}

/// Our values with another ratio (l - m)!/(l + m)! under the root.
template <class Ratio>
void other_norm(int bands, double* y, const Ratio& ratio) {
  for (int l = 0; l < bands; ++l)
    for (int m = 1; m <= l; ++m) {
      const double factor = std::sqrt(ratio(l, m) * factorial(l + m) / factorial(l - m));
      y[at(l, m)] *= factor;
      y[at(l, -m)] *= factor;
    }
}

}  // namespace

std::vector<Fault> basis_faults() {
  using Y = double*;
  return {
      {"M4", "cmft evalSHBasis5[11], copied into Probulator",
       "l = 3, m = -1: sqrt(21/16 pi) for sqrt(21/32 pi)", "evaluate basis: Gram matrix",
       "band 3, m = -1 is sqrt(2) times too large", basis_then<[](int n, Y y, Vec3d) {
         if (3 < n) y[at(3, -1)] *= std::sqrt(2.0);
       }>()},
      {"M5", "FlaxEngine SH.hlsl SHBasisFunction3", "3z - 1 and x - y for 3z^2 - 1 and x^2 - y^2",
       "evaluate basis: Gram matrix", "not orthogonal", basis_then<[](int n, Y y, Vec3d d) {
         if (n < 3) return;
         y[6] = std::sqrt(5.0 / (16.0 * kPi)) * (3.0 * d.z - 1.0);
         y[8] = std::sqrt(15.0 / (16.0 * kPi)) * (d.x - d.y);
       }>()},
      {"M6", "Falcor SphericalHarmonics.slang (#483)", "divides by 1/sqrt(pi) where sqrt(pi) is meant",
       "evaluate basis: Gram matrix", "all functions are pi times too large",
       basis_then<[](int n, Y y, Vec3d) {
         for (std::size_t i = 0; i < count_of(n); ++i) y[i] *= kPi;
       }>()},
      {"M7a", "nerfstudio #2081", "l = 4, m = -1 lacks z", "evaluate basis: Gram matrix", "band 4, m = -1",
       basis_then<[](int n, Y y, Vec3d d) {
         if (4 < n) y[at(4, -1)] /= d.z == 0.0 ? 1.0 : d.z;
       }>()},
      {"M7b", "nerfstudio #2081", "l = 4, m = 4 with the constant of the complex functions",
       "evaluate basis: Gram matrix", "band 4, m = 4 is sqrt(2) times too small",
       basis_then<[](int n, Y y, Vec3d) {
         if (4 < n) y[at(4, 4)] /= std::sqrt(2.0);
       }>()},
      {"M10", "Probulator HBasis.h", "H-basis DC 1/(2 sqrt(pi)): half the norm over a hemisphere",
       "hemisphere basis: Gram matrix", "function 0 is sqrt(2) times too small",
       ours_with(
           &plumbline_implementation::evaluate_hemisphere_basis,
           +[](std::int32_t n, std::size_t count, const double* d, double* values) {
             const int status = plumbline_sh().evaluate_hemisphere_basis(n, count, d, values);
             for (std::size_t k = 0; k < count; ++k) values[k * count_of(n)] /= std::sqrt(2.0);
             return status;
           })},
      {"L2", "gentle introduction, Legendre", "pow(1 - x*x, m/2) with integer m/2",
       "evaluate basis: Gram matrix", "times too large", basis_then<[](int n, Y y, Vec3d d) {
         const double sine = std::max(1e-12, std::hypot(d.x, d.y));
         for (int l = 1; l < n; ++l)
           for (int m = 1; m <= l; m += 2) {
             y[at(l, m)] /= sine;
             y[at(l, -m)] /= sine;
           }
       }>()},
      {"T4", "joeyan/gaussian_splatting #25", "band 1 in the order x, y, z",
       "evaluate basis: values and signs", "order x, y, z", basis_then<[](int n, Y y, Vec3d) {
         if (1 < n) std::rotate(y + 1, y + 3, y + 4);
       }>()},
      {"T5", "sparkjsdev/spark #64", "two signs of band 2 flipped", "evaluate basis: values and signs",
       "band 2, m = -1 is of the wrong sign; band 2, m = 1 is of the wrong sign",
       basis_then<[](int n, Y y, Vec3d) {
         if (n < 3) return;
         y[5] = -y[5];
         y[7] = -y[7];
       }>()},
      {"T6a", "librascal 346, spharpy 281", "Condon-Shortley declared, functions without it",
       "evaluate basis: values and signs", "Condon-Shortley phase", basis_then<[](int n, Y y, Vec3d) {
         for (int l = 1; l < n; ++l)
           for (int m = -l; m <= l; ++m)
             if (m % 2 != 0) y[at(l, m)] = -y[at(l, m)];
       }>()},
      {"T7", "sphrs #9", "K(l, m) with |l - m| where |m| is meant", "evaluate basis: Gram matrix",
       "band 2, m = -", basis_then<[](int n, Y y, Vec3d) {
         other_norm(n, y, [](int l, int m) {
           return factorial(l - std::abs(l - m)) / factorial(l + std::abs(l - m));
         });
       }>()},
      {"T8", "kratt PRT Src/Misc.cpp", "factorials in int: wrong from 13! on", "evaluate basis: Gram matrix",
       "band 7, m = -6", basis_then<[](int n, Y y, Vec3d) {
         other_norm(n, y, [](int l, int m) {
           return std::abs(wrapped_factorial(l - m) / std::max(1.0, std::abs(wrapped_factorial(l + m))));
         });
       }>()},
      {"POLE", "recurrences in cos theta alone (GSL)",
       "sin theta from 1 - z^2: digits of m > 0 lost near the poles", "evaluate basis: digits near the poles",
       "digits of m > 0 are lost near the poles", basis_then<[](int n, Y y, Vec3d d) {
         const double sine = std::hypot(d.x, d.y);
         if (sine == 0.0) return;
         const double lossy = std::sqrt(1.0 - d.z * d.z) / sine;
         for (int l = 1; l < n; ++l)
           for (int m = 1; m <= l; ++m) {
             y[at(l, m)] *= std::pow(lossy, m);
             y[at(l, -m)] *= std::pow(lossy, m);
           }
       }>()},
      {"NAN", "atan2-free azimuth x / hypot(x, y)", "NaN at the poles", "evaluate basis: values and signs",
       "not finite", basis_then<[](int n, Y y, Vec3d d) {
         if (1 < n && d.x == 0.0 && d.y == 0.0) y[1] = y[3] = std::nan("");
       }>()},
  };
}

}  // namespace plumbline::conformance
