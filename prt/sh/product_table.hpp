// prt/sh/product_table.hpp: products by the table of tripling coefficients, for any number of bands.
// Inside the library only: product.hpp is the interface.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "prt/sh/tripling.hpp"

namespace plumbline::sh::detail {

/// tripling_coefficients(bands), computed once and kept.
[[nodiscard]] const std::vector<Tripling>& tripling_table(int bands);

/// One product, or kLanes side by side: coefficient i of lane p lies at [i kLanes + p]. Each lane sees the same
/// operations in the same order, whatever kLanes is.
template <class Real, int kLanes>
void multiply_table(int bands, const Real* a, const Real* b, Real* c) {
  const std::vector<Tripling>& table = tripling_table(bands);
  std::fill_n(c, bands * bands * kLanes, Real(0));
  for (const Tripling& t : table) {
    const auto value = static_cast<Real>(t.value);
    const Real* a_i = a + t.i * kLanes;
    const Real* a_j = a + t.j * kLanes;
    const Real* a_k = a + t.k * kLanes;
    const Real* b_i = b + t.i * kLanes;
    const Real* b_j = b + t.j * kLanes;
    const Real* b_k = b + t.k * kLanes;
    Real* c_i = c + t.i * kLanes;
    Real* c_j = c + t.j * kLanes;
    Real* c_k = c + t.k * kLanes;
    for (int p = 0; p < kLanes; ++p) {
      if (t.i == t.j) {
        c_k[p] += value * (a_i[p] * b_i[p]);
      } else {
        c_k[p] += value * (a_i[p] * b_j[p] + a_j[p] * b_i[p]);
      }
      if (t.j == t.k && t.i != t.j) {
        c_i[p] += value * (a_j[p] * b_j[p]);
      } else if (t.j != t.k) {
        c_i[p] += value * (a_j[p] * b_k[p] + a_k[p] * b_j[p]);
      }
      if (t.i != t.j && t.j != t.k) c_j[p] += value * (a_i[p] * b_k[p] + a_k[p] * b_i[p]);
    }
  }
}

}  // namespace plumbline::sh::detail
