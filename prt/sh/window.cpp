#include "prt/sh/window.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <string>

#include "prt/sh/rotation_methods.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

constexpr std::size_t kMostTriangles = 500'000;

double norm_of_degree(const std::vector<double>& f, int l) {
  double square = 0.0;
  for (int m = -l; m <= l; ++m) {
    const double c = f[static_cast<std::size_t>(index(l, m))];
    square += c * c;
  }
  return std::sqrt(square);
}

/// Value, gradient and bounds of a function.
///
/// With t the arc along a great circle, a function of degree l and L2 norm 1 has |f''| <= sqrt(k''''(0)), where by the
/// addition theorem k(t) = (2l + 1)/(4 pi) P_l(cos t). From P_l'(1) = l(l + 1)/2 and P_l''(1) = (l - 1) l (l + 1)(l + 2)/8,
///
///   d^4/dt^4 P_l(cos t) at 0 = l(l + 1)/2 + 3 (l - 1) l (l + 1)(l + 2)/8.
class Bounded {
 public:
  explicit Bounded(const std::vector<double>& f)
      : basis_(bands_of(f.size(), "minimum_on_sphere")), values_(f.size()), functions_{f, {}, {}, {}} {
    for (const double c : f) {
      if (!std::isfinite(c)) throw InputError("minimum_on_sphere: a coefficient is not finite");
    }
    // The derivatives by turns about x, y, z: together the gradient, turned by 90 degrees.
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d unit(0.0);
      unit[axis] = 1.0;
      functions_[static_cast<std::size_t>(axis) + 1] = rotation_derivative(f, unit);
    }
    double largest = 0.0;
    for (int l = 0; l < basis_.bands(); ++l) {
      const double fourth = 0.5 * l * (l + 1.0) + 0.375 * (l - 1.0) * l * (l + 1.0) * (l + 2.0);
      const double scale = norm_of_degree(f, l) * std::sqrt((2.0 * l + 1.0) / (4.0 * kPi));
      largest += scale;
      second_derivative_ += scale * std::sqrt(fourth);
    }
    // Rounding of a sum of bands^2 products, generously: each term and the basis carry a few units.
    rounding_ = 4.0 * static_cast<double>(f.size()) * 0x1p-52 * largest;
  }

  /// Whether it is the same in every direction.
  [[nodiscard]] bool is_constant() const { return second_derivative_ == 0.0; }
  [[nodiscard]] double rounding() const { return rounding_; }

  struct Value {
    double value = 0.0;
    double slope = 0.0;  // norm of the gradient
  };
  [[nodiscard]] Value at(const Vec3d& direction) {
    basis_.evaluate(direction.x, direction.y, direction.z, values_);
    std::array<double, 4> sums{};
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t i = 0; i < values_.size(); ++i) sums[k] += values_[i] * functions_[k][i];
    }
    return {sums[0], std::sqrt(sums[1] * sums[1] + sums[2] * sums[2] + sums[3] * sums[3])};
  }
  /// Of the function within `radius` of where it has `value`.
  [[nodiscard]] double lower_bound(const Value& value, double radius) const {
    const double bands = basis_.bands();
    return value.value - value.slope * radius - 0.5 * second_derivative_ * radius * radius -
           rounding_ * (1.0 + bands * radius);
  }

 private:
  Basis<double> basis_;
  std::vector<double> values_;
  std::array<std::vector<double>, 4> functions_;
  double second_derivative_ = 0.0;
  double rounding_ = 0.0;
};

struct Triangle {
  std::array<Vec3d, 3> corners;
  double lower_bound = 0.0;
};
struct HigherBound {
  bool operator()(const Triangle& a, const Triangle& b) const { return a.lower_bound > b.lower_bound; }
};

/// Best-first search. Ends when `is_done(minimum)`.
class Search {
 public:
  explicit Search(const std::vector<double>& f) : function_(f) {
    minimum_.value = std::numeric_limits<double>::infinity();
    for (const double x : {-1.0, 1.0}) {
      for (const double y : {-1.0, 1.0}) {
        for (const double z : {-1.0, 1.0}) {
          add({Vec3d(x, 0.0, 0.0), Vec3d(0.0, y, 0.0), Vec3d(0.0, 0.0, z)});
        }
      }
    }
    minimum_.lower_bound = queue_.top().lower_bound;
  }

  template <class IsDone>
  SphereMinimum run(const IsDone& is_done) {
    if (function_.is_constant()) {
      minimum_.lower_bound = minimum_.value - function_.rounding();
      return minimum_;
    }
    while (!is_done(minimum_) && count_ < kMostTriangles) {
      const std::array<Vec3d, 3> c = queue_.top().corners;
      queue_.pop();
      const std::array<Vec3d, 3> middle{glm::normalize(c[1] + c[2]), glm::normalize(c[2] + c[0]),
                                        glm::normalize(c[0] + c[1])};
      add(middle);
      add({c[0], middle[1], middle[2]});
      add({middle[0], c[1], middle[2]});
      add({middle[0], middle[1], c[2]});
      minimum_.lower_bound = queue_.top().lower_bound;
    }
    return minimum_;
  }

 private:
  /// The farthest point of a small spherical triangle from one inside is a corner, since caps below 90 degrees are convex.
  void add(const std::array<Vec3d, 3>& corners) {
    const Vec3d centre = glm::normalize(corners[0] + corners[1] + corners[2]);
    double radius = 0.0;
    for (const Vec3d& corner : corners) {
      radius = std::max(radius, 2.0 * std::asin(std::min(1.0, 0.5 * glm::length(corner - centre))));
    }
    const Bounded::Value value = function_.at(centre);
    if (value.value < minimum_.value) {
      minimum_.value = value.value;
      minimum_.direction = centre;
    }
    queue_.push({corners, function_.lower_bound(value, radius * (1.0 + 1e-12))});
    ++count_;
  }

  Bounded function_;
  SphereMinimum minimum_;
  std::priority_queue<Triangle, std::vector<Triangle>, HigherBound> queue_;
  std::size_t count_ = 0;
};

std::vector<double> channel_of(const ShRgb& function, int channel) {
  std::vector<double> result;
  for (const RgbD& c : function.coefficients) result.push_back(c[channel]);
  return result;
}

bool is_above(const ShRgb& function, double floor) {
  for (int channel = 0; channel < 3; ++channel) {
    if (!is_certainly_at_least(channel_of(function, channel), floor)) return false;
  }
  return true;
}

/// No window changes the mean.
void require_mean_above(const ShRgb& function, double floor) {
  for (int channel = 0; channel < 3; ++channel) {
    const std::vector<double> f = channel_of(function, channel);
    const double mean = f[0] / std::sqrt(4.0 * kPi);
    const bool is_flat = std::all_of(f.begin() + 1, f.end(), [](double c) { return c == 0.0; });
    if (!(mean > floor || (is_flat && mean >= floor))) {
      throw InputError("automatic_window: channel " + std::to_string(channel) + ": expected a mean above " +
                       std::to_string(floor) + ", got " + std::to_string(mean));
    }
  }
}

/// The least lambda to a thousandth by bisection, between one that fails and one that does not.
double least_lambda(const ShRgb& function, double floor) {
  const auto is_enough = [&](double lambda) {
    return is_above(windowed(function, Window::laplacian, lambda), floor);
  };
  if (is_enough(0.0)) return 0.0;
  double low = 0.0;
  double high = 1e-6;
  while (!is_enough(high)) {
    if (high > 1e12)
      throw InputError("automatic_window: no lambda up to 1e12 lifts the function above the floor");
    low = high;
    high *= 8.0;
  }
  if (low == 0.0) return high;  // 1e-6 changes nothing that could be seen
  while (high > 1.001 * low) {
    const double middle = std::sqrt(low * high);
    (is_enough(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace

SphereMinimum minimum_on_sphere(const std::vector<double>& coefficients, double tolerance) {
  if (!(tolerance > 0.0)) {
    throw InputError("minimum_on_sphere: expected a tolerance > 0, got " + std::to_string(tolerance));
  }
  return Search(coefficients).run([&](const SphereMinimum& m) {
    return m.value - m.lower_bound <= tolerance;
  });
}

bool is_certainly_at_least(const std::vector<double>& coefficients, double threshold) {
  // A constant is what its one coefficient says: 0 is at least 0 without any rounding taken off.
  const bool is_flat =
      std::all_of(coefficients.begin() + 1, coefficients.end(), [](double c) { return c == 0.0; });
  if (is_flat) return coefficients[0] / std::sqrt(4.0 * kPi) >= threshold;
  const SphereMinimum minimum = Search(coefficients).run([&](const SphereMinimum& m) {
    return m.lower_bound >= threshold || m.value < threshold;
  });
  return minimum.lower_bound >= threshold;
}

AutomaticWindow automatic_window(const ShRgb& function, double floor) {
  if (bands_of(function.coefficients.size(), "automatic_window") != function.bands) {
    throw InputError("automatic_window: expected " + std::to_string(function.bands) + " bands, got " +
                     std::to_string(function.coefficients.size()) + " coefficients");
  }
  require_mean_above(function, floor);
  AutomaticWindow result;
  result.lambda = least_lambda(function, floor);
  result.function = windowed(function, Window::laplacian, result.lambda);
  double change = 0.0;
  double norm = 0.0;
  for (std::size_t i = 0; i < function.coefficients.size(); ++i) {
    const RgbD d = result.function.coefficients[i] - function.coefficients[i];
    change += glm::dot(d, d);
    norm += glm::dot(function.coefficients[i], function.coefficients[i]);
  }
  result.relative_change = norm > 0.0 ? std::sqrt(change / norm) : 0.0;
  result.lower_bound = std::numeric_limits<double>::infinity();
  for (int channel = 0; channel < 3; ++channel) {
    const std::vector<double> f = channel_of(result.function, channel);
    const double tolerance = 1e-6 * std::abs(f[0]) + 1e-300;
    result.lower_bound = std::min(result.lower_bound, minimum_on_sphere(f, tolerance).lower_bound);
  }
  return result;
}

}  // namespace plumbline::sh
