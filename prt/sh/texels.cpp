#include "prt/sh/texels.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

constexpr int kMaxGaussCount = 2000;

void require_texel(int size, int x, int y) {
  if (size < 1 || x < 0 || y < 0 || x >= size || y >= size) {
    throw InputError("texel: expected 0 <= x, y < size, got (" + std::to_string(x) + ", " +
                     std::to_string(y) + ") of " + std::to_string(size));
  }
}

/// From OpenGL's (s, t) in [-1, 1], t downwards, to the (unnormalised) direction.
Vec3d cube_direction(int face, double s, double t) {
  switch (face) {
    case 0:
      return {1.0, -t, -s};
    case 1:
      return {-1.0, -t, s};
    case 2:
      return {s, 1.0, t};
    case 3:
      return {s, -1.0, -t};
    case 4:
      return {s, -t, 1.0};
    case 5:
      return {-s, -t, -1.0};
    default:
      throw InputError("cube face: expected 0 to 5, got " + std::to_string(face));
  }
}

/// Solid angle of the part of the plane z = 1 between (0, 0) and (u, v), signed.
double corner_solid_angle(double u, double v) {
  return std::atan2(u * v, std::sqrt(u * u + v * v + 1.0));
}

/// Left or top edge of texel i in [-1, 1].
double edge(int size, int i) {
  return 2.0 * i / size - 1.0;
}

double mapped(double low, double high, double node) {
  return 0.5 * (low + high) + 0.5 * (high - low) * node;
}

double solid_angle_of(const ImageRectangle& r) {
  return corner_solid_angle(r.s0, r.t0) - corner_solid_angle(r.s0, r.t1) - corner_solid_angle(r.s1, r.t0) +
         corner_solid_angle(r.s1, r.t1);
}

/// Right and up in [-1, 1]^2, inside the disc.
ImageNode angular_node(double s, double up, double area) {
  const double r = std::sqrt(s * s + up * up);
  const double theta = kPi * r;
  // d omega = sin(theta) d theta d phi with theta = pi r and dA = r dr d phi.
  const double sine_over_r = r > 0.0 ? std::sin(theta) / r : kPi;
  return {Vec3d(s * sine_over_r, up * sine_over_r, std::cos(theta)), kPi * sine_over_r * area, s, -up};
}

}  // namespace

// The k-point rule's error on a function of angular frequency w over a length h is, relative to h,
// (w h)^(2k) (k!)^4 / ((2k + 1) ((2k)!)^3).
int gauss_count(double phase, double tolerance) {
  for (int k = 2; k < kMaxGaussCount; ++k) {
    const double log_error = 2.0 * k * std::log(std::max(phase, 1e-300)) + 4.0 * std::lgamma(k + 1.0) -
                             3.0 * std::lgamma(2.0 * k + 1.0) - std::log(2.0 * k + 1.0);
    if (log_error < std::log(tolerance)) return k;
  }
  return kMaxGaussCount;
}

ImageRectangle texel_rectangle(int size, int x, int y) {
  require_texel(size, x, y);
  return {edge(size, x), edge(size, x + 1), edge(size, y), edge(size, y + 1)};
}

double cube_texel_solid_angle(int size, int x, int y) {
  return solid_angle_of(texel_rectangle(size, x, y));
}

void append_cube_nodes(int face, const ImageRectangle& rectangle, const GaussLegendre& rule,
                       std::vector<ImageNode>& nodes) {
  const double solid_angle = solid_angle_of(rectangle);
  const std::size_t first = nodes.size();
  double sum = 0.0;
  for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
    const double t = mapped(rectangle.t0, rectangle.t1, rule.nodes[j]);
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const double s = mapped(rectangle.s0, rectangle.s1, rule.nodes[i]);
      const double square = 1.0 + s * s + t * t;
      const double length = std::sqrt(square);
      const double weight = rule.weights[i] * rule.weights[j] / (square * length);
      sum += weight;
      nodes.push_back({cube_direction(face, s, t) / length, weight, s, t});
    }
  }
  for (std::size_t k = first; k < nodes.size(); ++k) nodes[k].weight *= solid_angle / sum;
}

void append_angular_nodes(const ImageRectangle& rectangle, const GaussLegendre& rule,
                          std::vector<ImageNode>& nodes) {
  static const GaussLegendre kRimRule = gauss_legendre(8);
  const double s0 = rectangle.s0;
  const double s1 = rectangle.s1;
  const double lower = -rectangle.t1;
  const double upper = -rectangle.t0;
  const double farthest = std::hypot(std::max(-s0, s1), std::max(-lower, upper));
  const bool is_cut = farthest > 1.0;
  const GaussLegendre& used = is_cut ? kRimRule : rule;
  for (std::size_t i = 0; i < used.nodes.size(); ++i) {
    const double s = mapped(s0, s1, used.nodes[i]);
    const double chord = is_cut ? std::sqrt(std::max(0.0, (1.0 - s) * (1.0 + s))) : 1.0;
    const double low = std::max(lower, -chord);
    const double high = std::min(upper, chord);
    if (low >= high) continue;
    for (std::size_t j = 0; j < used.nodes.size(); ++j) {
      const double area = 0.25 * (s1 - s0) * (high - low) * used.weights[i] * used.weights[j];
      nodes.push_back(angular_node(s, mapped(low, high, used.nodes[j]), area));
    }
  }
}

}  // namespace plumbline::sh
