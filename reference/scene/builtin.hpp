// reference/scene/builtin.hpp: scenes made in code.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "reference/scene/scene.hpp"

namespace plumbline::scene {

struct BuiltinInfo {
  std::string name;
  std::string description;  // one line
};

/// What there is, in a fixed order.
[[nodiscard]] std::vector<BuiltinInfo> builtin_scenes();

/// @throws InputError listing the names there are.
[[nodiscard]] Scene make_builtin_scene(std::string_view name);

}  // namespace plumbline::scene
