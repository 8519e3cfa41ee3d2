// validation/checks/case.hpp: what is judged, with what effort.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "reference/light/environment.hpp"
#include "reference/scene/scene.hpp"

namespace plumbline::checks {

/// How fine biases must be resolved: seconds on every change, or minutes every night.
enum class Tier { quick, nightly };

/// How much work a run may do, and how often it may cry wolf.
struct Budget {
  Tier tier = Tier::quick;
  std::uint64_t seed = 0;
  int threads = 0;
  double significance = 1e-4;  // family-wise: chance that a run without any defect reports one
  int width = 384;
  int height = 288;
  int image_samples = 64;    // paths a pixel of each reference image
  int bake_samples = 1024;   // directions a vertex, in two independent halves
  int gather_samples = 128;  // paths a vertex of the path-traced vertex values, in two independent halves
  int projection_samples = 1 << 19;
};

struct NamedScene {
  std::string name;
  scene::Scene scene;
  std::string camera;
};

struct Suite {
  std::vector<NamedScene> scenes;
  std::vector<light::Environment> environments;
  std::vector<int> bands;
  Budget budget;
  std::function<void(const std::string& what)> announce;  // what is being done, for a person who waits
};

/// "bunny.obj" for "/usr/share/.../bunny.obj".
[[nodiscard]] std::string short_name(const std::string& path);

}  // namespace plumbline::checks
