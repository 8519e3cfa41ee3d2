#include <chrono>
#include <functional>
#include <memory>
#include <numbers>

#include "prt/relight/cpu.hpp"
#include "prt/sh/batch.hpp"
#include "prt/sh/product.hpp"
#include "prt/sh/rotator.hpp"
#include "prt/transfer/bake.hpp"
#include "reference/integrate/render.hpp"
#include "reference/scene/builtin.hpp"
#include "validation/regression/quantities.hpp"

namespace plumbline::regression {
namespace {

constexpr int kRepetitions = 15;
constexpr double kLeastSeconds = 5e-3;

struct Kernel {
  std::string name;
  std::function<void()> run;
  int calls = 1;  // a measurement
};

double seconds_of(const Kernel& kernel) {
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < kernel.calls; ++i) kernel.run();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Some numbers of order 1, always the same ones.
template <class Real>
std::vector<Real> numbers(std::size_t count) {
  std::vector<Real> result(count);
  for (std::size_t i = 0; i < count; ++i)
    result[i] = static_cast<Real>(std::fmod(static_cast<double>(i + 1) * std::numbers::phi, 1.0) - 0.5);
  return result;
}

Kernel evaluate_kernel() {
  constexpr std::size_t kDirections = 4096;
  const auto x = std::make_shared<std::vector<float>>(kDirections, 0.6F);
  const auto z = std::make_shared<std::vector<float>>(kDirections, 0.8F);
  const auto y = std::make_shared<std::vector<float>>(kDirections, 0.0F);
  const auto values = std::make_shared<std::vector<float>>(sh::blocked_size(5, kDirections));
  const auto basis = std::make_shared<sh::BatchBasis<float>>(5);
  return {"evaluate, 5 bands, 4096 directions", [=] { basis->evaluate_blocked({*x, *y, *z}, *values); }};
}

Kernel rotate_kernel() {
  const auto in = std::make_shared<std::vector<float>>(numbers<float>(36));
  const auto out = std::make_shared<std::vector<float>>(36);
  const auto rotator = std::make_shared<sh::Rotator<float>>(6);
  const glm::dmat3 turn(0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0);
  return {"rotate, 6 bands", [=] { rotator->apply(turn, *in, *out); }};
}

Kernel product_kernel() {
  const auto a = std::make_shared<std::vector<float>>(numbers<float>(36));
  const auto out = std::make_shared<std::vector<float>>(36);
  return {"product, 6 bands", [=] { sh::multiply(*a, *a, *out); }};
}

Kernel relight_kernel() {
  constexpr std::size_t kVertices = 10000;
  const auto transfer = std::make_shared<transfer::Transfer>();
  transfer->bands = 5;
  transfer->vertices = kVertices;
  transfer->coefficients = numbers<float>(kVertices * 25);
  const sh::ShRgb lighting{5, std::vector<RgbD>(25, RgbD(0.5, 1.0, 1.5))};
  return {"relight, 5 bands, 10,000 vertices",
          [=] { (void)relight::unit_albedo_exit_radiance(*transfer, lighting); }};
}

Kernel bake_kernel() {
  const auto scene = std::make_shared<scene::Scene>(scene::make_builtin_scene("convex"));
  transfer::BakeSettings settings;
  settings.bands = 5;
  settings.samples = 256;
  settings.threads = 1;
  return {"bake, convex, 5 bands, 256 directions", [=] { (void)transfer::bake(*scene, settings); }};
}

Kernel render_kernel() {
  const auto world = std::make_shared<integrate::World>(scene::make_builtin_scene("cornell"),
                                                        light::make_builtin_environment("black"));
  integrate::RenderSettings settings;
  settings.width = settings.height = 32;
  settings.samples_per_pixel = 4;
  settings.threads = 1;
  return {"path trace, cornell, 32x32, 4 paths a pixel",
          [=] { (void)integrate::render(*world, world->scene.cameras.front(), settings); }};
}

}  // namespace

// In turn, so that what the machine does meanwhile falls on all alike; the first round warms up and sets the calls.
std::vector<KernelTimes> measure_kernels() {
  std::vector<Kernel> kernels = {evaluate_kernel(), rotate_kernel(), product_kernel(),
                                 relight_kernel(),  bake_kernel(),   render_kernel()};
  std::vector<KernelTimes> times;
  for (Kernel& kernel : kernels) {
    while (seconds_of(kernel) < kLeastSeconds) kernel.calls *= 2;
    times.push_back({kernel.name, {}});
  }
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    for (std::size_t i = 0; i < kernels.size(); ++i)
      times[i].seconds.push_back(seconds_of(kernels[i]) / kernels[i].calls);
  }
  return times;
}

}  // namespace plumbline::regression
