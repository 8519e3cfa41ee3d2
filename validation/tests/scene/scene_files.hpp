// validation/tests/scene/scene_files.hpp: small files for the loaders' tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/scene/load.hpp"

namespace plumbline::scene {

/// A fresh file in a folder of the running test's own.
inline std::filesystem::path write_scene_file(const std::string& name, std::string_view bytes) {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "plumbline_scene" /
                                       (std::string(test->test_suite_name()) + "_" + test->name());
  std::filesystem::create_directories(folder);
  write_text_atomically(folder / name, bytes);
  return folder / name;
}

/// The message of the InputError that `body` throws; a note that fails the checks when it throws none.
inline std::string refusal(const std::function<void()>& body) {
  try {
    body();
  } catch (const InputError& error) {
    return error.what();
  }
  return "(nothing was\nrefused)";
}

/// Loading `path` is refused in one line that names the file and contains `reason`.
inline void expect_refused(const std::filesystem::path& path, const std::string& reason,
                           const LoadOptions& options = {}) {
  const std::string message = refusal([&] { (void)load_scene(path.string(), options); });
  EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 0) << message;
  EXPECT_NE(message.find(path.filename().string()), std::string::npos) << message;
  EXPECT_NE(message.find(reason), std::string::npos) << message << "\nexpected to contain: " << reason;
}

/// Unit vectors that agree to float rounding of a short computation (some 8 roundings of 6e-8).
inline void expect_same_vector(const Vec3& a, const Vec3& b, float tolerance = 5e-7F) {
  EXPECT_LE(glm::length(a - b), tolerance)
      << "(" << a.x << ", " << a.y << ", " << a.z << ") and (" << b.x << ", " << b.y << ", " << b.z << ")";
}

/// Six times the volume that a closed mesh encloses, positive when the triangles face outwards.
inline double six_volumes(const Scene& scene) {
  double sum = 0.0;
  for (const glm::uvec3& t : scene.triangles) {
    const Vec3d a(scene.positions[t.x]);
    sum += glm::dot(a, glm::cross(Vec3d(scene.positions[t.y]), Vec3d(scene.positions[t.z])));
  }
  return sum;
}

/// Every edge has as many triangles in one direction as in the other.
inline bool is_closed(const Scene& scene) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const glm::uvec3& t : scene.triangles) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k];
      const std::uint32_t b = t[(k + 1) % 3];
      balance[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  return std::all_of(balance.begin(), balance.end(), [](const auto& edge) { return edge.second == 0; });
}

}  // namespace plumbline::scene
