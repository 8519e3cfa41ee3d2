// How directions and points are drawn: Q1 … Q3 of the closed forms.
#include <cmath>
#include <random>

#include "reference/integrate/emitters.hpp"
#include "reference/integrate/hemisphere.hpp"
#include "reference/light/environment_sampler.hpp"
#include "validation/checks/truths_estimators.hpp"
#include "validation/checks/truths_scenes.hpp"
#include "validation/truth/distant.hpp"
#include "validation/truth/irradiance.hpp"

namespace plumbline::checks {
namespace {

const Vec3d kNormal = glm::normalize(Vec3d(-2.0, 3.0, 6.0));
const Vec3d kTangent = glm::normalize(Vec3d(3.0, 2.0, 0.0));  // at right angles to it

Vec2 pair(double u, double v) {  // below 1 in float too
  return Vec2(std::min(static_cast<float>(u), 0x1.fffffep-1F),
              std::min(static_cast<float>(v), 0x1.fffffep-1F));
}

// ---------------------------------------------------------------- Q1: moments
template <class Function>
std::function<Estimator()> cosine_moment(const Function& f) {
  return [f] {
    return plain_mean([f](double u, double v) {
      return f(Vec3d(integrate::sample_cosine_hemisphere(Vec3(kNormal), pair(u, v))));
    });
  };
}

/// A sampler with the environment that it looks into.
struct Sky {
  explicit Sky(light::Environment value) : environment(std::move(value)), sampler(environment) {}
  light::Environment environment;
  light::EnvironmentSampler sampler;
};

template <class Function>
std::function<Estimator()> uniform_moment(const Function& f) {
  return [f] {
    const auto sky = std::make_shared<const Sky>(constant_sky(1.0));
    return plain_mean([sky, f](double u, double v) {
      const auto sample = sky->sampler.sample(pair(u, v));
      return sample ? f(Vec3d(sample->direction)) : std::nan("");
    });
  };
}

void add_moment_cases(std::vector<TruthCase>& cases) {
  const char* const cosine = "density cos/pi: E[c] = 2/3, E[c^2] = 1/2, E[x^2] = 1/4";
  const auto height = [](const Vec3d& w) { return glm::dot(w, kNormal); };
  cases.push_back(named("Q1_CosineMean", cosine, truth::kCosineMeanCosine, cosine_moment(height)));
  cases.push_back(named("Q1_CosineSquare", cosine, truth::kCosineMeanSquaredCosine,
                        cosine_moment([=](const Vec3d& w) { return height(w) * height(w); })));
  cases.push_back(named("Q1_CosineTangentSquare", cosine, truth::kCosineMeanSquaredTangent,
                        cosine_moment([](const Vec3d& w) { return std::pow(glm::dot(w, kTangent), 2.0); })));
  const char* const uniform = "uniform: E|c| = 1/2, E[c^2] = 1/3, E[x^2 y^2] = 1/15";
  cases.push_back(named("Q1_UniformMean", uniform, truth::kUniformMeanCosine,
                        uniform_moment([=](const Vec3d& w) { return std::abs(height(w)); })));
  cases.push_back(named("Q1_UniformSquare", uniform, truth::kUniformMeanSquaredCosine,
                        uniform_moment([=](const Vec3d& w) { return height(w) * height(w); })));
  cases.push_back(named("Q1_UniformProduct", uniform, truth::kUniformMeanProduct,
                        uniform_moment([](const Vec3d& w) { return w.x * w.x * w.y * w.y; })));
}

// ---------------------------------------------------------------- Q2: densities integrate to 1
std::function<Estimator()> total_density(const std::function<light::Environment()>& environment) {
  return [environment] {
    const auto sky = std::make_shared<const Sky>(environment());
    return plain_mean([sky](double u, double v) {
      return 4.0 * kPi * sky->sampler.pdf(glm::normalize(Vec3(uniform_direction(u, v))));
    });
  };
}

light::Environment small_image(light::Lookup lookup) {
  std::mt19937 random(22);
  std::vector<double> texels;
  for (int i = 0; i < 32; ++i) texels.push_back(static_cast<double>(random() % 1000U) / 1000.0);
  return lat_long_sky(texels, 8, 4, lookup);
}

// ---------------------------------------------------------------- Q3: three densities, one answer
constexpr double kCapHalfAngle = kPi / 6.0;
constexpr double kCapAngle = kPi / 4.0;
light::Environment sky_with_cap() {
  light::Environment environment = constant_sky(0.5);
  environment.suns.push_back(sun(tilted(kCapAngle), kCapHalfAngle, 1.0));
  return environment;
}

double radiance_at(const Sky& sky, const Vec3d& direction) {
  return static_cast<double>(light::radiance(sky.environment, glm::normalize(Vec3(direction))).y);
}

/// Uniform over the upper hemisphere, density 1/(2 pi).
double by_uniform(const Sky& sky, double u, double v) {
  const Vec3d w = uniform_direction(0.5 * u, v);
  return 2.0 * kPi * w.y * radiance_at(sky, w);
}
double by_cosine(const Sky& sky, double u, double v) {
  return kPi * radiance_at(sky, Vec3d(integrate::sample_cosine_hemisphere({0.0F, 1.0F, 0.0F}, pair(u, v))));
}
double by_light(const Sky& sky, double u, double v) {
  const auto sample = sky.sampler.sample(pair(u, v));
  if (!sample) return std::nan("");
  return std::max(0.0, static_cast<double>(sample->direction.y)) * static_cast<double>(sample->radiance.y) /
         sample->pdf;
}

std::function<Estimator()> drawn_by(double (*one)(const Sky&, double, double)) {
  return [one] {
    const auto sky = std::make_shared<const Sky>(sky_with_cap());
    return plain_mean([sky, one](double u, double v) { return one(*sky, u, v); });
  };
}

void add_density_cases(std::vector<TruthCase>& cases) {
  const char* const one = "the integral of the density is 1";
  cases.push_back(named("Q2_DensityOfOvercast", one, 1.0,
                        total_density([] { return light::make_builtin_environment("overcast"); })));
  cases.push_back(named("Q2_DensityOfTexels", one, 1.0,
                        total_density([] { return small_image(light::Lookup::nearest); })));
  cases.push_back(named("Q2_DensityOfBilinearTexels", one, 1.0,
                        total_density([] { return small_image(light::Lookup::bilinear); })));
  cases.push_back(named("Q2_DensityOfSkyAndCap", one, 1.0, total_density(sky_with_cap)));
  const char* const same = "E = pi/2 + pi sin^2 a cos t, whatever the density drawn from";
  const double truth = kPi / 2.0 + truth::cap_irradiance(kCapHalfAngle, kCapAngle, 1.0);
  cases.push_back(named("Q3_UniformDensity", same, truth, drawn_by(by_uniform)));
  cases.push_back(named("Q3_CosineDensity", same, truth, drawn_by(by_cosine)));
  cases.push_back(named("Q3_LightDensity", same, truth, drawn_by(by_light)));
  cases.push_back(named("Q3_PathTracer", same, truth, [] {
    return irradiance_at(make_world(nothing_in_the_way(), sky_with_cap()), Vec3d(0.0), {0.0, 1.0, 0.0});
  }));
}

}  // namespace

std::vector<TruthCase> sampling_cases() {
  std::vector<TruthCase> cases;
  add_moment_cases(cases);
  add_density_cases(cases);
  return cases;
}

}  // namespace plumbline::checks
