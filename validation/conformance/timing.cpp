#include "validation/conformance/timing.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <map>
#include <vector>

#include "validation/conformance/truths.hpp"

namespace plumbline::conformance {
namespace {

using Implementation = plumbline_implementation;

/// Arguments and room for results that every operation can use.
struct Arguments {
  int bands;
  std::vector<double> a;
  std::vector<double> b;
  std::vector<double> out;
  std::vector<float> pixels;
  std::array<double, 3> direction{2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0};
  std::array<double, 9> matrix{};
};

using Call = std::function<int(const Implementation&, Arguments&)>;

const std::map<std::string, Call>& calls() {
  using I = Implementation;
  using A = Arguments;
  static const std::map<std::string, Call> kCalls{
      {"evaluate basis",
       [](const I& i, A& x) { return i.evaluate_basis(x.bands, 1, x.direction.data(), x.out.data()); }},
      {"hemisphere basis",
       [](const I& i, A& x) {
         return i.evaluate_hemisphere_basis(x.bands, 1, x.direction.data(), x.out.data());
       }},
      {"project lat-long",
       [](const I& i, A& x) { return i.project_lat_long(x.bands, 32, 16, x.pixels.data(), x.out.data()); }},
      {"project cube",
       [](const I& i, A& x) { return i.project_cube(x.bands, 8, x.pixels.data(), x.out.data()); }},
      {"lookup lat-long",
       [](const I& i, A& x) {
         return i.lookup_lat_long(32, 16, x.pixels.data(), x.direction.data(), x.out.data());
       }},
      {"rotate",
       [](const I& i, A& x) { return i.rotate(x.bands, x.matrix.data(), x.a.data(), x.out.data()); }},
      {"multiply",
       [](const I& i, A& x) { return i.multiply(x.bands, x.a.data(), x.b.data(), x.out.data()); }},
      {"exponential", [](const I& i, A& x) { return i.exponential(x.bands, x.a.data(), x.out.data()); }},
      {"logarithm", [](const I& i, A& x) { return i.logarithm(x.bands, x.b.data(), x.out.data()); }},
      {"rotate zonal",
       [](const I& i, A& x) {
         return i.rotate_zonal(x.bands, x.a.data(), x.direction.data(), x.out.data());
       }},
      {"irradiance",
       [](const I& i, A& x) { return i.irradiance(x.bands, x.a.data(), x.direction.data(), x.out.data()); }},
      {"light directional",
       [](const I& i, A& x) { return i.light_directional(x.bands, x.direction.data(), x.out.data()); }},
      {"light cone",
       [](const I& i, A& x) { return i.light_cone(x.bands, x.direction.data(), 0.5, x.out.data()); }},
      {"light sphere",
       [](const I& i, A& x) { return i.light_sphere(x.bands, x.direction.data(), 0.5, x.out.data()); }},
      {"light hemisphere",
       [](const I& i, A& x) {
         return i.light_hemisphere(x.bands, x.direction.data(), 1.0, 0.5, x.out.data());
       }},
      {"transfer unshadowed",
       [](const I& i, A& x) { return i.transfer_unshadowed(x.bands, x.direction.data(), x.out.data()); }},
      {"relight", [](const I& i, A& x) { return i.relight(x.bands, x.a.data(), x.b.data(), x.out.data()); }},
      {"window", [](const I& i, A& x) { return i.window(x.bands, x.a.data(), x.out.data()); }},
      {"dominant direction",
       [](const I& i, A& x) { return i.dominant_direction(x.bands, x.a.data(), x.out.data()); }},
      {"sample directions",
       [](const I& i, A& x) { return i.sample_directions(0, 1, 0, 1, x.out.data(), x.out.data() + 3); }},
      {"mean and error",
       [](const I& i, A& x) { return i.mean_and_error(x.a.size(), x.a.data(), x.out.data()); }},
      {"rmse", [](const I& i, A& x) { return i.rmse(x.a.size(), x.a.data(), x.b.data(), x.out.data()); }},
  };
  return kCalls;
}

Arguments arguments(int bands) {
  const auto count = static_cast<std::size_t>(std::max(2, bands * bands));
  Arguments result{bands, truths::some_values(count, 1), truths::some_values(count, 2),
                   std::vector<double>(3 * count + 8), std::vector<float>(3 * 32 * 16, 1.0F)};
  for (double& v : result.a) v *= 0.2;
  for (double& v : result.b) v *= 0.1;
  result.b[0] = 4.0;
  const glm::dmat3 r = truths::rotations()[0];
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      result.matrix.at(static_cast<std::size_t>(3 * row + column)) = r[column][row];
  return result;
}

double seconds_of(const std::function<void()>& work, int repeats) {
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < repeats; ++i) work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

std::optional<double> nanoseconds(const plumbline_implementation& implementation,
                                  const std::string& operation, int bands) {
  constexpr double kShortest = 1e-3;
  const auto call = calls().find(operation);
  if (call == calls().end()) return std::nullopt;
  Arguments x = arguments(bands);
  if (call->second(implementation, x) != 0) return std::nullopt;
  const auto work = [&] { (void)call->second(implementation, x); };
  int repeats = 1;
  while (seconds_of(work, repeats) < kShortest && repeats < (1 << 24)) repeats *= 2;
  std::array<double, 5> times{};
  for (double& time : times) time = seconds_of(work, repeats) / repeats;
  std::nth_element(times.begin(), times.begin() + 2, times.end());
  return times[2] * 1e9;
}

}  // namespace plumbline::conformance
