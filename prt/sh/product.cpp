#include "prt/sh/product.hpp"

#include <array>
#include <cmath>
#include <mutex>
#include <string>

#include "prt/sh/basis.hpp"
#include "prt/sh/plain_numbers.hpp"
#define PLUMBLINE_SH_PLAIN_NUMBERS
#include "prt/sh/product_kernel-inl.hpp"
#include "prt/sh/product_table.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

/// The bands of a vector of n^2 coefficients.
int bands_of(std::size_t size, const char* where) {
  int bands = 0;
  while (bands <= kMaxProductBands && static_cast<std::size_t>(bands * bands) < size) ++bands;
  if (size == 0 || bands > kMaxProductBands || static_cast<std::size_t>(bands * bands) != size) {
    throw InputError(std::string(where) + ": expected n^2 coefficients, 1 <= n <= " +
                     std::to_string(kMaxProductBands) + ", got " + std::to_string(size));
  }
  return bands;
}

void require_equal(std::size_t a, std::size_t b, const char* where) {
  if (a != b) {
    throw InputError(std::string(where) + ": expected vectors of one size, got " + std::to_string(a) +
                     " and " + std::to_string(b));
  }
}

void require_product_bands(int bands, const char* where) {
  if (bands < 1 || bands > kMaxProductBands) {
    throw InputError(std::string(where) + ": expected 1 to " + std::to_string(kMaxProductBands) +
                     " bands, got " + std::to_string(bands));
  }
}

template <bool kIsSquare, class Real>
void multiply_any(int bands, const Real* a, const Real* b, Real* c) {
  const plain::Number<Real> one;
  switch (bands) {
    case 2:
      return plain::multiply_lanes<2, 1, kIsSquare>(one, a, b, c);
    case 3:
      return plain::multiply_lanes<3, 1, kIsSquare>(one, a, b, c);
    case 4:
      return plain::multiply_lanes<4, 1, kIsSquare>(one, a, b, c);
    case 5:
      return plain::multiply_lanes<5, 1, kIsSquare>(one, a, b, c);
    case 6:
      return plain::multiply_lanes<6, 1, kIsSquare>(one, a, b, c);
    default:
      return detail::multiply_table<Real, 1>(bands, a, b, c);
  }
}

template <class Real>
void multiply_checked(std::span<const Real> a, std::span<const Real> b, std::span<Real> out) {
  require_equal(a.size(), b.size(), "sh::multiply");
  require_equal(a.size(), out.size(), "sh::multiply");
  multiply_any<false>(bands_of(a.size(), "sh::multiply"), a.data(), b.data(), out.data());
}

template <class Real>
void square_checked(std::span<const Real> a, std::span<Real> out) {
  require_equal(a.size(), out.size(), "sh::square");
  multiply_any<true>(bands_of(a.size(), "sh::square"), a.data(), a.data(), out.data());
}

/// Calls visit(i, j, k, value) for all i < n^2, j >= i and k < m^2 whose coefficient is not 0.
template <class Visit>
void for_each_tripling(int bands, int result_bands, const Visit& visit) {
  for (int i = 0; i < bands * bands; ++i) {
    const detail::DegreeAndM a = detail::degree_and_m(i);
    for (int j = i; j < bands * bands; ++j) {
      const detail::DegreeAndM b = detail::degree_and_m(j);
      const int sum = std::abs(a.m) + std::abs(b.m);
      const int difference = std::abs(std::abs(a.m) - std::abs(b.m));
      const std::array<int, 4> orders{-sum, -difference, difference, sum};
      for (int l = b.degree - a.degree; l < result_bands && l <= a.degree + b.degree; l += 2) {
        for (std::size_t n = 0; n < orders.size(); ++n) {
          if (std::abs(orders[n]) > l || (n > 0 && orders[n] == orders[n - 1])) continue;
          const double value = detail::real_tripling(a, b, {l, orders[n]});
          if (value != 0.0) visit(i, j, index(l, orders[n]), value);
        }
      }
    }
  }
}

}  // namespace

double tripling_coefficient(int i, int j, int k) {
  for (const int c : {i, j, k}) {
    if (c < 0 || c >= kMaxProductBands * kMaxProductBands) {
      throw InputError("tripling_coefficient: expected indices from 0 to " +
                       std::to_string(kMaxProductBands * kMaxProductBands - 1) + ", got " +
                       std::to_string(c));
    }
  }
  return detail::real_tripling(detail::degree_and_m(i), detail::degree_and_m(j), detail::degree_and_m(k));
}

std::vector<Tripling> tripling_coefficients(int bands) {
  require_product_bands(bands, "tripling_coefficients");
  std::vector<Tripling> result;
  for_each_tripling(bands, bands, [&](int i, int j, int k, double value) {
    if (k >= j) result.push_back({i, j, k, value});
  });
  return result;
}

namespace detail {

const std::vector<Tripling>& tripling_table(int bands) {
  static std::array<std::once_flag, kMaxProductBands + 1> flags;
  static std::array<std::vector<Tripling>, kMaxProductBands + 1> tables;
  const auto n = static_cast<std::size_t>(bands);
  std::call_once(flags[n], [bands, n] { tables[n] = tripling_coefficients(bands); });
  return tables[n];
}

}  // namespace detail

void multiply(std::span<const double> a, std::span<const double> b, std::span<double> out) {
  multiply_checked(a, b, out);
}

void multiply(std::span<const float> a, std::span<const float> b, std::span<float> out) {
  multiply_checked(a, b, out);
}

void square(std::span<const double> a, std::span<double> out) {
  square_checked(a, out);
}

void square(std::span<const float> a, std::span<float> out) {
  square_checked(a, out);
}

std::vector<double> product(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> out(a.size());
  multiply(std::span(a), std::span(b), std::span(out));
  return out;
}

std::vector<float> product(const std::vector<float>& a, const std::vector<float>& b) {
  std::vector<float> out(a.size());
  multiply(std::span(a), std::span(b), std::span(out));
  return out;
}

std::vector<double> square(const std::vector<double>& a) {
  std::vector<double> out(a.size());
  square(std::span(a), std::span(out));
  return out;
}

std::vector<float> square(const std::vector<float>& a) {
  std::vector<float> out(a.size());
  square(std::span(a), std::span(out));
  return out;
}

std::vector<double> full_product(const std::vector<double>& a, const std::vector<double>& b) {
  require_equal(a.size(), b.size(), "full_product");
  const int bands = bands_of(a.size(), "full_product");
  const int result_bands = 2 * bands - 1;
  require_product_bands(result_bands, "full_product (of the result)");
  std::vector<double> out(static_cast<std::size_t>(coefficient_count(result_bands)), 0.0);
  for_each_tripling(bands, result_bands, [&](int i, int j, int k, double value) {
    const auto p = static_cast<std::size_t>(i);
    const auto q = static_cast<std::size_t>(j);
    const double pair = i == j ? a[p] * b[p] : a[p] * b[q] + a[q] * b[p];
    out[static_cast<std::size_t>(k)] += value * pair;
  });
  return out;
}

std::vector<double> product_matrix(const std::vector<double>& f) {
  const std::vector<Tripling>& table = detail::tripling_table(bands_of(f.size(), "product_matrix"));
  const std::size_t n = f.size();
  std::vector<double> matrix(n * n, 0.0);
  const auto add = [&](std::size_t row, std::size_t column, double value) {
    matrix[row * n + column] += value;
    if (row != column) matrix[column * n + row] += value;
  };
  for (const Tripling& t : table) {
    const auto i = static_cast<std::size_t>(t.i);
    const auto j = static_cast<std::size_t>(t.j);
    const auto k = static_cast<std::size_t>(t.k);
    add(i, j, t.value * f[k]);
    if (k != j) add(i, k, t.value * f[j]);
    if (i != j) add(j, k, t.value * f[i]);
  }
  return matrix;
}

// A function about +z multiplies each m by itself: y_l0 y_l'm holds y_l''m only. m and -m share their
// coefficients.
std::vector<double> zonal_product(const std::vector<double>& zonal, const std::vector<double>& f) {
  const int bands = bands_of(f.size(), "zonal_product");
  require_equal(zonal.size(), static_cast<std::size_t>(bands), "zonal_product");
  std::vector<double> out(f.size(), 0.0);
  const auto at = [](int l, int m) { return static_cast<std::size_t>(index(l, m)); };
  for (int m = 0; m < bands; ++m) {
    for (int from = m; from < bands; ++from) {
      for (int to = m; to < bands; ++to) {
        double factor = 0.0;
        for (int l = std::abs(from - to); l < bands && l <= from + to; l += 2) {
          factor += zonal[static_cast<std::size_t>(l)] * detail::real_tripling({l, 0}, {from, m}, {to, m});
        }
        out[at(to, m)] += factor * f[at(from, m)];
        if (m > 0) out[at(to, -m)] += factor * f[at(from, -m)];
      }
    }
  }
  return out;
}

}  // namespace plumbline::sh
