// prt/sh/quadrature.hpp: nodes and weights that integrate exactly.
#pragma once

#include <vector>

#include "reference/base/vector.hpp"

namespace plumbline::sh {

struct GaussLegendre {
  std::vector<double> nodes;    // in (-1, 1), ascending
  std::vector<double> weights;  // sum 2
};
/// Exact for polynomials of degree 2 count - 1. Nodes and weights are correct to about 1e-16.
/// @throws InputError unless count >= 1
[[nodiscard]] GaussLegendre gauss_legendre(int count);

struct SphereNode {
  Vec3d direction{0.0};
  double weight = 0.0;  // [sr], all sum to 4 pi
};
/// Gauss-Legendre in z times uniform in azimuth, 2 bands^2 nodes: exact for products of two functions of
/// `bands` bands. @throws InputError unless 1 <= bands <= kMaxBands
[[nodiscard]] std::vector<SphereNode> sphere_quadrature(int bands);

}  // namespace plumbline::sh
