#include "reference/integrate/light_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "reference/integrate/light_cluster.hpp"

namespace plumbline::integrate {
namespace {

/// A leaf whose lights shine the same way is chosen from by strength where it is further away than this many of its radii:
/// cosines and distances then differ by less than weighing them costs (a lamp of two triangles across a room).
constexpr double kFar = 3.0;

/// Below this many levels lights are halved by number: a way has at most 30 + 32 turns, which 64 bits hold.
constexpr int kUnbalancedLevels = 30;

struct Angle {
  double cosine = 1.0;
  double sine = 0.0;
};

/// max(0, a - b), both in [0, pi].
Angle reduced(const Angle& a, const Angle& b) {
  if (a.cosine >= b.cosine) return {};
  return {a.cosine * b.cosine + a.sine * b.sine, a.sine * b.cosine - a.cosine * b.sine};
}

Angle angle_of(double cosine) {
  return {cosine, std::sqrt(std::max(0.0, 1.0 - cosine * cosine))};
}

// Axes and normals are unit to 1e-7 in float, so a cosine may be wrong by as much: what is behind the horizon by less
// than this counts as on it, and what is on it counts a little.
constexpr double kHorizon = 1e-6;

double importance(const LightTree::Cluster& cluster, const Receiver& receiver) {
  const Vec3d offset = Vec3d(cluster.centre) - Vec3d(receiver.position);
  const double squared = glm::dot(offset, offset);
  const double radius = cluster.radius;
  if (!(squared > radius * radius)) return cluster.strength / (radius * radius);  // anything is possible
  const double inverse = 1.0 / std::sqrt(squared);
  const double sine = radius * inverse;
  const Angle extent{std::sqrt(1.0 - sine * sine), sine};

  double cosine = -glm::dot(Vec3d(cluster.axis), offset) * inverse;
  if (cluster.is_two_sided) cosine = std::abs(cosine);
  const Angle from_cone = reduced(angle_of(cosine), {cluster.cos_spread, cluster.sin_spread});
  const double emitted = reduced(from_cone, extent).cosine;
  if (!(emitted > -kHorizon)) return 0.0;

  double received = 1.0;
  if (receiver.normal) {
    received = reduced(angle_of(glm::dot(Vec3d(*receiver.normal), offset) * inverse), extent).cosine;
    if (!(received > -kHorizon)) return 0.0;
  }
  return cluster.strength * std::max(emitted, kHorizon) * std::max(received, kHorizon) * inverse * inverse;
}

/// What is left of a random number after a choice of probability `share` that began at `begin`.
double remaining(double u, double begin, double share) {
  constexpr double kBelowOne = 1.0 - 0.5 * std::numeric_limits<double>::epsilon();
  return std::clamp((u - begin) / share, 0.0, kBelowOne);
}

}  // namespace

// ---------------------------------------------------------------- choosing
double LightTree::weigh_leaf(const Node& leaf, const Receiver& receiver, Weights& weights) const {
  if (leaf.count == 1) return weights[0] = 1.0;
  const Vec3d offset = Vec3d(leaf.bounds.centre) - Vec3d(receiver.position);
  const double radius = kFar * static_cast<double>(leaf.bounds.radius);
  const bool is_by_strength = leaf.is_parallel && glm::dot(offset, offset) > radius * radius;
  double total = 0.0;
  for (std::size_t i = 0; i < leaf.count; ++i) {
    const Cluster& cluster = clusters_[leaf.first + i];
    weights[i] = is_by_strength ? cluster.strength : importance(cluster, receiver);
    total += weights[i];
  }
  return total;
}

std::optional<LightChoice> LightTree::sample(const Receiver& receiver, double u) const {
  if (nodes_.empty()) return std::nullopt;
  double probability = 1.0;
  const Node* node = nodes_.data();
  while (node->count == 0) {
    const Node* children = nodes_.data() + node->first;
    const double first = importance(children[0].bounds, receiver);
    const double second = importance(children[1].bounds, receiver);
    const double total = first + second;
    if (!(total > 0.0)) return std::nullopt;
    const double share = first / total;
    const bool is_second = u >= share;
    const double own = is_second ? second / total : share;
    u = remaining(u, is_second ? share : 0.0, own);
    probability *= own;
    node = children + (is_second ? 1 : 0);
  }
  Weights weights;
  const double total = weigh_leaf(*node, receiver, weights);
  if (!(total > 0.0)) return std::nullopt;
  double target = u * total;
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < node->count;
       ++i) {  // the last of weight above 0 where rounding leaves something over
    if (!(weights[i] > 0.0)) continue;
    chosen = i;
    if (target < weights[i] || i + 1 == node->count) break;
    target -= weights[i];
  }
  return LightChoice{lights_[node->first + chosen], probability * (weights[chosen] / total),
                     remaining(target, 0.0, weights[chosen])};
}

double LightTree::probability(const Receiver& receiver, std::uint32_t light) const {
  double probability = 1.0;
  std::uint64_t turns = turns_[light];
  const Node* node = nodes_.data();
  for (; node->count == 0; turns >>= 1U) {
    const Node* children = nodes_.data() + node->first;
    const double first = importance(children[0].bounds, receiver);
    const double second = importance(children[1].bounds, receiver);
    const double total = first + second;
    if (!(total > 0.0)) return 0.0;
    const bool is_second = (turns & 1U) != 0;
    probability *= (is_second ? second : first) / total;
    if (!(probability > 0.0)) return 0.0;
    node = children + (is_second ? 1 : 0);
  }
  Weights weights;
  const double total = weigh_leaf(*node, receiver, weights);
  return total > 0.0 ? probability * (weights[places_[light] - node->first] / total) : 0.0;
}

// ---------------------------------------------------------------- building
/// Lights [begin, end) of the list below one node.
struct LightTree::Range {
  std::uint32_t node = 0;
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  std::uint64_t turns = 0;
  int level = 0;
};

LightTree::LightTree(std::span<const LightBounds> lights) {
  if (lights.empty()) return;
  double total = 0.0;
  for (const LightBounds& light : lights) total += light.strength;
  std::vector<LightBounds> scaled(lights.begin(), lights.end());
  for (LightBounds& light : scaled) light.strength /= total;
  lights_.resize(lights.size());
  std::iota(lights_.begin(), lights_.end(), 0U);
  places_.resize(lights.size());
  turns_.resize(lights.size());
  clusters_.resize(lights.size());
  build(scaled);
}

void LightTree::make_leaf(std::span<const LightBounds> lights, const Range& range) {
  Node& leaf = nodes_[range.node];
  leaf.first = range.begin;
  leaf.count = static_cast<std::uint8_t>(range.end - range.begin);
  bool is_alike = true;
  for (std::uint32_t place = range.begin; place < range.end; ++place) {
    const std::uint32_t light = lights_[place];
    places_[light] = place;
    turns_[light] = range.turns;
    clusters_[place] = make_cluster(lights[light]);
    is_alike = is_alike && clusters_[place].is_two_sided == leaf.bounds.is_two_sided;
  }
  constexpr float kParallel = 0.999F;
  leaf.is_parallel = is_alike && leaf.bounds.cos_spread > kParallel;
}

// Top down, without recursion: a node's bounds are the union of its lights'.
void LightTree::build(std::span<const LightBounds> lights) {
  nodes_.emplace_back();
  std::vector<Range> open{{0, 0, static_cast<std::uint32_t>(lights.size()), 0, 0}};
  while (!open.empty()) {
    const Range range = open.back();
    open.pop_back();
    const std::span<std::uint32_t> members(lights_.data() + range.begin, range.end - range.begin);
    nodes_[range.node].bounds = make_cluster(unite(lights, members));
    if (members.size() <= kLeafSize) {
      make_leaf(lights, range);
      continue;
    }
    const std::size_t half =
        range.level < kUnbalancedLevels ? split_by_cost(lights, members) : split_by_number(lights, members);
    const std::uint32_t middle = range.begin + static_cast<std::uint32_t>(half);
    const auto first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[range.node].first = first;
    nodes_.resize(nodes_.size() + 2);
    const std::uint64_t turn = std::uint64_t{1} << static_cast<unsigned>(range.level);
    open.push_back({first + 1, middle, range.end, range.turns | turn, range.level + 1});
    open.push_back({first, range.begin, middle, range.turns, range.level + 1});
  }
}

}  // namespace plumbline::integrate
