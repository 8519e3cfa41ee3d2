#include "reference/integrate/light_cluster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace plumbline::integrate {
namespace {

constexpr int kBins = 12;

Vec3d centre_of(const LightBounds& light) {
  return 0.5 * (light.low + light.high);
}

struct Cone {
  Vec3d axis{0.0, 1.0, 0.0};
  double cos_spread = -1.0;
};

// The wider cone if it holds the other; else from the far side of one to the far side of the other: half-angle
// (spread a + spread b + angle between)/2, the axis turned from a's towards b's by half-angle - spread a.
Cone unite(const Cone& a, const Cone& b) {
  const double cosine = std::clamp(glm::dot(a.axis, b.axis), -1.0, 1.0);
  if (a.cos_spread <= -1.0 || (b.cos_spread >= 1.0 && cosine >= a.cos_spread)) return a;
  if (b.cos_spread <= -1.0) return b;
  const double spread_a = std::acos(a.cos_spread);
  const double spread_b = std::acos(b.cos_spread);
  const double between = std::acos(cosine);
  if (between + spread_b <= spread_a) return a;
  if (between + spread_a <= spread_b) return b;
  const double spread = 0.5 * (spread_a + spread_b + between);
  const Vec3d across = b.axis - cosine * a.axis;
  const double length = glm::length(across);
  if (spread >= kPi || !(length > 1e-9)) return {};
  const double turn = spread - spread_a;
  return {glm::normalize(std::cos(turn) * a.axis + std::sin(turn) / length * across), std::cos(spread)};
}

/// Where a light lies along an axis.
struct Extent {
  Vec3d low{std::numeric_limits<double>::infinity()};
  Vec3d high{-std::numeric_limits<double>::infinity()};
};
Extent extent_of_centres(std::span<const LightBounds> lights, std::span<const std::uint32_t> members) {
  Extent extent;
  for (const std::uint32_t m : members) {
    extent.low = glm::min(extent.low, centre_of(lights[m]));
    extent.high = glm::max(extent.high, centre_of(lights[m]));
  }
  return extent;
}

// Integral over all directions of the largest cosine with a normal of the cone [Conty Estevez & Kulla, eq. 1], for
// surfaces that shine into a hemisphere (theta_e = pi/2).
double measure_of_directions(const LightBounds& bounds) {
  const double cosine = std::clamp(bounds.cos_spread, -1.0, 1.0);
  const double spread = std::acos(cosine);
  const double sine = std::sin(spread);
  const double limit = std::min(spread + 0.5 * kPi, kPi);
  const double one_side =
      2.0 * kPi * (1.0 - cosine) +
      0.5 * kPi * (2.0 * limit * sine - std::cos(spread - 2.0 * limit) - 2.0 * spread * sine + cosine);
  return bounds.is_two_sided ? 2.0 * one_side : one_side;
}

double cost(const LightBounds& bounds) {
  const Vec3d diagonal = bounds.high - bounds.low;
  return bounds.strength * measure_of_directions(bounds) * glm::dot(diagonal, diagonal);
}

int bin_of(const LightBounds& light, const Extent& extent, int axis) {
  const double place = (centre_of(light)[axis] - extent.low[axis]) / (extent.high[axis] - extent.low[axis]);
  return std::clamp(static_cast<int>(kBins * place), 0, kBins - 1);
}

using Bins = std::array<std::optional<LightBounds>, kBins>;

void add(std::optional<LightBounds>& sum, const std::optional<LightBounds>& other) {
  if (other) sum = sum ? unite(*sum, *other) : other;
}

/// The cheapest place to cut along one axis: lights of the bins before it on one side.
struct Cut {
  double cost = std::numeric_limits<double>::infinity();
  int axis = -1;
  int bin = 0;
};
Cut best_cut(const Bins& bins, int axis, double penalty) {
  std::array<std::optional<LightBounds>, kBins> above;  // above[b]: bins b and up
  std::optional<LightBounds> sum;
  for (int b = kBins - 1; b > 0; --b) {
    add(sum, bins[static_cast<std::size_t>(b)]);
    above[static_cast<std::size_t>(b)] = sum;
  }
  Cut best;
  std::optional<LightBounds> below;
  for (int b = 1; b < kBins; ++b) {
    add(below, bins[static_cast<std::size_t>(b - 1)]);
    const std::optional<LightBounds>& rest = above[static_cast<std::size_t>(b)];
    if (!below || !rest) continue;
    const double total = penalty * (cost(*below) + cost(*rest));
    if (total < best.cost) best = {total, axis, b};
  }
  return best;
}

}  // namespace

LightBounds unite(const LightBounds& a, const LightBounds& b) {
  const bool is_turned = (a.is_two_sided || b.is_two_sided) && glm::dot(a.axis, b.axis) < 0.0;
  const Cone cone = unite(Cone{a.axis, a.cos_spread}, Cone{is_turned ? -b.axis : b.axis, b.cos_spread});
  return {glm::min(a.low, b.low), glm::max(a.high, b.high),         cone.axis,
          cone.cos_spread,        a.is_two_sided || b.is_two_sided, a.strength + b.strength};
}

LightBounds unite(std::span<const LightBounds> lights, std::span<const std::uint32_t> members) {
  if (members.size() == 1) return lights[members[0]];
  const std::size_t half = members.size() / 2;
  return unite(unite(lights, members.first(half)), unite(lights, members.subspan(half)));
}

// The centre is rounded to float, which the sphere must not notice; the axis too, which the spread makes good for.
LightTree::Cluster make_cluster(const LightBounds& bounds) {
  constexpr double kEpsilon = std::numeric_limits<float>::epsilon();
  LightTree::Cluster cluster;
  const Vec3d centre = centre_of(bounds);
  cluster.centre = Vec3(centre);
  const double largest = std::max({std::abs(centre.x), std::abs(centre.y), std::abs(centre.z)});
  const double radius = 0.5 * glm::length(bounds.high - bounds.low);
  cluster.radius = static_cast<float>(radius * (1.0 + 2.0 * kEpsilon) + 2.0 * kEpsilon * largest) +
                   std::numeric_limits<float>::min();
  cluster.axis = Vec3(bounds.axis);
  const double cosine = std::max(-1.0, bounds.cos_spread < 1.0 ? bounds.cos_spread - 4.0 * kEpsilon : 1.0);
  cluster.cos_spread = static_cast<float>(cosine);
  cluster.sin_spread = static_cast<float>(std::sqrt(std::max(0.0, 1.0 - cosine * cosine)));
  cluster.is_two_sided = bounds.is_two_sided;
  cluster.strength = bounds.strength;
  return cluster;
}

std::size_t split_by_number(std::span<const LightBounds> lights, std::span<std::uint32_t> members) {
  const Extent extent = extent_of_centres(lights, members);
  const Vec3d size = extent.high - extent.low;
  int axis = size.x >= size.y ? 0 : 1;
  if (size.z > size[axis]) axis = 2;
  const std::size_t half = members.size() / 2;
  const auto is_before = [&](std::uint32_t a, std::uint32_t b) {
    const double at_a = centre_of(lights[a])[axis];
    const double at_b = centre_of(lights[b])[axis];
    return at_a != at_b ? at_a < at_b : a < b;
  };
  std::nth_element(members.begin(), members.begin() + static_cast<std::ptrdiff_t>(half), members.end(),
                   is_before);
  return half;
}

std::size_t split_by_cost(std::span<const LightBounds> lights, std::span<std::uint32_t> members) {
  const Extent extent = extent_of_centres(lights, members);
  const Vec3d size = extent.high - extent.low;
  const double longest = std::max({size.x, size.y, size.z});
  Cut best;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(size[axis] > 0.0)) continue;
    Bins bins;
    for (const std::uint32_t m : members) {
      add(bins[static_cast<std::size_t>(bin_of(lights[m], extent, axis))], lights[m]);
    }
    const Cut cut = best_cut(bins, axis, longest / size[axis]);  // against thin slices
    if (cut.cost < best.cost) best = cut;
  }
  if (best.axis < 0) return split_by_number(lights, members);
  const auto middle = std::partition(members.begin(), members.end(), [&](std::uint32_t m) {
    return bin_of(lights[m], extent, best.axis) < best.bin;
  });
  return static_cast<std::size_t>(middle - members.begin());
}

}  // namespace plumbline::integrate
