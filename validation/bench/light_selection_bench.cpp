// validation/bench/light_selection_bench.cpp: one of many lights: chosen by power alone with points uniform by area, against
// the light tree with points by solid angle. Irradiance from the lights alone, nothing in the way, over 64 receivers.
// `variance` is relative, the mean over the receivers of that of one sample; what counts is `variance_x_ns`.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <random>
#include <vector>

#include "reference/integrate/emitters.hpp"
#include "reference/scene/cornell.hpp"

namespace plumbline {
namespace {

using integrate::EmitterSample;
using integrate::Receiver;

constexpr std::size_t kReceivers = 64;

/// What the light tree is measured against.
class PowerTable {
 public:
  explicit PowerTable(const scene::Scene& scene) {
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
      const integrate::EmissiveTriangle triangle = integrate::make_emissive_triangle(scene, t);
      const double power = integrate::light_bounds(triangle).strength;
      if (!(power > 0.0)) continue;
      triangles_.push_back(triangle);
      triangles_.back().near_squared = 0.0;  // always by area
      cumulative_.push_back(power + (cumulative_.empty() ? 0.0 : cumulative_.back()));
    }
  }
  [[nodiscard]] std::optional<EmitterSample> sample(const Receiver& receiver, const Vec2& pick,
                                                    const Vec2& u) const {
    const double total = cumulative_.back();
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, pick.x * total);
    const auto slot = static_cast<std::size_t>(found - cumulative_.begin());
    std::optional<EmitterSample> sample = integrate::sample_triangle(triangles_[slot], receiver.position, u);
    if (sample) sample->pdf *= (cumulative_[slot] - (slot > 0 ? cumulative_[slot - 1] : 0.0)) / total;
    return sample;
  }

 private:
  std::vector<integrate::EmissiveTriangle> triangles_;
  std::vector<double> cumulative_;
};

/// 10,000 triangles in a hall, brightness over three orders.
scene::Scene many_lights() {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
  scene::Scene scene;
  for (int i = 0; i < 10000; ++i) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    const Vec3 corner(20.0F * uniform(random), 0.1F + 5.0F * uniform(random), 20.0F * uniform(random));
    scene.positions.push_back(corner);
    for (int k = 0; k < 2; ++k) {
      const Vec3 edge(uniform(random) - 0.5F, uniform(random) - 0.5F, uniform(random) - 0.5F);
      scene.positions.push_back(corner + 0.1F * edge);
    }
    scene.triangles.emplace_back(first, first + 1, first + 2);
    scene.triangle_materials.push_back(static_cast<std::uint32_t>(scene.materials.size()));
    scene.materials.push_back(
        {"", Rgb(0.0F), Rgb(std::pow(10.0F, 3.0F * uniform(random) - 2.0F)), -1, false});
  }
  scene.normals.resize(scene.positions.size(), Vec3(0, 1, 0));
  return scene;
}

/// On a floor of this size.
std::array<Receiver, kReceivers> receivers_on_floor(float size) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform(0.0F, size);
  std::array<Receiver, kReceivers> receivers;
  for (Receiver& receiver : receivers) {
    const float x = uniform(random);
    receiver = {{x, 0.0F, uniform(random)}, Vec3(0, 1, 0)};
  }
  return receivers;
}

double term(const std::optional<EmitterSample>& sample) {
  if (!sample) return 0.0;
  return static_cast<double>(max_component(sample->radiance) * std::max(0.0F, sample->direction.y)) /
         sample->pdf;
}

std::vector<std::array<Vec2, 2>> random_numbers() {
  std::mt19937 random(3);
  std::vector<std::array<Vec2, 2>> numbers(1 << 14);
  const auto next = [&] { return static_cast<float>(random() >> 8U) * 0x1p-24F; };
  for (auto& pairs : numbers) {
    for (Vec2& pair : pairs) {
      pair.x = next();
      pair.y = next();
    }
  }
  return numbers;
}

template <class Table>
double relative_variance(const Table& table, const std::array<Receiver, kReceivers>& receivers) {
  const std::vector<std::array<Vec2, 2>> numbers = random_numbers();
  double result = 0.0;
  for (const Receiver& receiver : receivers) {
    double sum = 0.0;
    double squares = 0.0;
    for (const auto& [pick, u] : numbers) {
      const double value = term(table.sample(receiver, pick, u));
      sum += value;
      squares += value * value;
    }
    const auto count = static_cast<double>(numbers.size());
    result += (squares * count / (sum * sum) - 1.0) / static_cast<double>(kReceivers);
  }
  return result;
}

template <class Table>
void measure(benchmark::State& state, const scene::Scene& scene, float floor) {
  const Table table(scene);
  const std::array<Receiver, kReceivers> receivers = receivers_on_floor(floor);
  const std::vector<std::array<Vec2, 2>> numbers = random_numbers();
  std::size_t i = 0;
  const auto start = std::chrono::steady_clock::now();
  for (auto _ : state) {
    const auto& [pick, u] = numbers[i % numbers.size()];
    benchmark::DoNotOptimize(term(table.sample(receivers[i % kReceivers], pick, u)));
    ++i;
  }
  const std::chrono::duration<double, std::nano> elapsed = std::chrono::steady_clock::now() - start;
  const double variance = relative_variance(table, receivers);
  state.counters["variance"] = variance;
  state.counters["variance_x_ns"] = variance * elapsed.count() / static_cast<double>(state.iterations());
}

void light_selection_power_10000(benchmark::State& state) {
  measure<PowerTable>(state, many_lights(), 20.0F);
}
void light_selection_tree_10000(benchmark::State& state) {
  measure<integrate::EmitterTable>(state, many_lights(), 20.0F);
}
void light_selection_power_cornell(benchmark::State& state) {
  const scene::Scene scene = scene::make_cornell();
  measure<PowerTable>(state, scene, scene::bounds(scene).high.x);
}
void light_selection_tree_cornell(benchmark::State& state) {
  const scene::Scene scene = scene::make_cornell();
  measure<integrate::EmitterTable>(state, scene, scene::bounds(scene).high.x);
}
void light_tree_build_10000(benchmark::State& state) {
  const scene::Scene scene = many_lights();
  for (auto _ : state) {
    const integrate::EmitterTable table(scene);
    benchmark::DoNotOptimize(table.is_empty());
  }
}
BENCHMARK(light_selection_power_10000);
BENCHMARK(light_selection_tree_10000);
BENCHMARK(light_selection_power_cornell);
BENCHMARK(light_selection_tree_cornell);
BENCHMARK(light_tree_build_10000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace plumbline
