#include "prt/sh/half_functions.hpp"

#include <array>
#include <cmath>

#include "prt/sh/quadrature.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

constexpr std::size_t kMostFunctions = 6;

// Habel & Wimmer, "Efficient irradiance normal mapping" (2010): orthonormal over z >= 0. The lightmap's are the
// weights of a mean over cosine-distributed directions, z/pi, times 1, y, z, x.
std::array<double, kMostFunctions> evaluate_functions(Functions functions, const Vec3d& w) {
  if (functions == Functions::cosine_lightmap) {
    const double density = w.z / kPi;
    return {density, density * w.y, density * w.z, density * w.x, 0.0, 0.0};
  }
  const double first =
      functions == Functions::h_basis_4_half_dc ? 0.5 / std::sqrt(kPi) : 1.0 / std::sqrt(2.0 * kPi);
  const double linear = std::sqrt(1.5 / kPi);
  const double quadratic = std::sqrt(7.5 / kPi);
  return {first,        linear * w.y,          linear * (2.0 * w.z - 1.0),
          linear * w.x, quadratic * w.x * w.y, 0.5 * quadratic * (w.x * w.x - w.y * w.y)};
}

// Gauss-Legendre in z over [0, 1] times uniform in azimuth. What survives the azimuth is a polynomial of degree at
// most bands + 1 in z, and of frequency below bands + 2 around.
std::vector<SphereNode> half_quadrature(int bands) {
  const GaussLegendre rule = gauss_legendre(bands / 2 + 2);
  const int around = bands + 3;
  std::vector<SphereNode> nodes;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double z = 0.5 * (rule.nodes[i] + 1.0);
    const double radius = std::sqrt(1.0 - z * z);
    for (int j = 0; j < around; ++j) {
      const double phi = 2.0 * kPi * (j + 0.5) / around;
      nodes.push_back(
          {{radius * std::cos(phi), radius * std::sin(phi), z}, 0.5 * rule.weights[i] * 2.0 * kPi / around});
    }
  }
  return nodes;
}

// L0 = <L>/4, and the others relative to it.
void relate_to_first(std::vector<RgbD>& rows) {
  rows[0] *= 0.25;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    for (glm::length_t c = 0; c < 3; ++c) {
      if (rows[0][c] == 0.0) {
        throw InputError("sh::from_ours: a cosine lightmap divides by the mean radiance, which is 0");
      }
      rows[i][c] = rows[i][c] / (8.0 * rows[0][c]) + 0.5;
    }
  }
}

}  // namespace

std::size_t half_function_count(Functions functions) {
  if (functions == Functions::sphere) {
    throw InputError("sh::half_function_count: expected functions on a hemisphere, got the sphere's");
  }
  return functions == Functions::h_basis_6 ? kMostFunctions : 4;
}

std::vector<RgbD> half_function_values(const ShRgb& light, Functions functions, Sign sign) {
  std::vector<RgbD> rows(half_function_count(functions), RgbD(0.0));
  for (const SphereNode& node : half_quadrature(light.bands)) {
    const auto weights = evaluate_functions(functions, node.direction);
    const RgbD radiance = node.weight * evaluate(light, node.direction);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] += weights[i] * radiance;
  }
  if (sign == Sign::condon_shortley) {
    rows[1] *= -1.0;
    rows[3] *= -1.0;
  }
  if (functions == Functions::cosine_lightmap) relate_to_first(rows);
  return rows;
}

}  // namespace plumbline::sh
