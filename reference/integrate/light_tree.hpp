// reference/integrate/light_tree.hpp: one of many lights, chosen nearly in proportion to what it sends to a receiver.
// [1] Conty Estevez & Kulla, "Importance sampling of many lights with adaptive tree splitting", HPG 2018.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "reference/base/vector.hpp"

namespace plumbline::integrate {

/// Where light is gathered.
struct Receiver {
  Vec3 position{0.0F};
  std::optional<Vec3> normal;  // unit: what arrives counts by its cosine; none: from everywhere alike
};

/// What is known of a light: where it is and whither it shines. A Lambertian surface whose normals lie in a cone.
struct LightBounds {
  Vec3d low{0.0};  // axis-aligned box that holds it
  Vec3d high{0.0};
  Vec3d axis{0.0, 1.0, 0.0};  // of the cone, unit
  double cos_spread = 1.0;    // of its half-angle; -1: all directions
  bool is_two_sided = false;  // shines from the other side too
  double strength = 0.0;      // > 0: area seen from the axis x radiance, in any unit
};

/// A light drawn. `rest` in [0, 1) is what is left of the random number: uniform again.
struct LightChoice {
  std::uint32_t light = 0;
  double probability = 0.0;
  double rest = 0.0;
};

/// A binary tree over lights. A light is found from the root by chance, in proportion to the *importance* of the
/// branches for the receiver [1, eq. 3]:
///   strength x cos(theta') x cos(theta_i')/d^2,   theta' = max(0, theta - spread - theta_u), theta_i' = max(0,
/// theta_i - theta_u), with d the distance to the centre of the branch, theta_u half the angle under which its bounding
/// sphere is seen, theta between its axis and the receiver, theta_i between the receiver's normal and the centre. Both
/// cosines are upper bounds: the importance is 0 only where nothing of the branch can send light. In the leaves up
/// to four lights are weighed one by one. Not of [1]: the tree is not split adaptively; one light is drawn.
class LightTree {
 public:
  LightTree() = default;
  explicit LightTree(std::span<const LightBounds> lights);

  [[nodiscard]] bool is_empty() const { return nodes_.empty(); }

  /// None where no light can send anything, and by chance where the bounds of a branch promised light that neither of its
  /// parts can send. u in [0, 1).
  [[nodiscard]] std::optional<LightChoice> sample(const Receiver& receiver, double u) const;
  /// Probability that sample() draws this light: to the bit the one that it returns.
  [[nodiscard]] double probability(const Receiver& receiver, std::uint32_t light) const;

  static constexpr std::size_t kLeafSize = 4;

  /// LightBounds in the form that is fast to weigh.
  struct Cluster {
    Vec3 centre{0.0F};
    float radius = 0.0F;  // of a sphere that holds it, rounding included
    Vec3 axis{0.0F};
    float cos_spread = 1.0F;
    float sin_spread = 0.0F;
    bool is_two_sided = false;
    double strength = 0.0;
  };

 private:
  struct Node {
    Cluster bounds;
    std::uint32_t first = 0;   // child, whose neighbour is the other one; of a leaf: the first light
    std::uint8_t count = 0;    // lights of a leaf; 0: no leaf
    bool is_parallel = false;  // all lights of a leaf shine the same way
  };
  using Weights = std::array<double, kLeafSize>;

  struct Range;
  void build(std::span<const LightBounds> lights);
  void make_leaf(std::span<const LightBounds> lights, const Range& range);
  [[nodiscard]] double weigh_leaf(const Node& leaf, const Receiver& receiver, Weights& weights) const;

  std::vector<Node> nodes_;
  std::vector<Cluster> clusters_;      // one per light, leaf after leaf
  std::vector<std::uint32_t> lights_;  // which light that is
  std::vector<std::uint32_t> places_;  // and where a light is
  std::vector<std::uint64_t>
      turns_;  // of each light: the way from the root, a bit a level, 1 for the second child
};

}  // namespace plumbline::integrate
