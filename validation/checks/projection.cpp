#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "prt/sh/basis.hpp"
#include "prt/sh/lighting.hpp"
#include "reference/integrate/sampler.hpp"
#include "reference/light/environment_sampler.hpp"
#include "validation/checks/suite.hpp"
#include "validation/checks/verdicts.hpp"

namespace plumbline::checks {
namespace {

constexpr int kChartBands = 10;
constexpr int kGroups = 64;  // independent randomisations of the Monte Carlo estimate

/// Monte Carlo estimates with the reference's light sampling: coefficients and total energy (integral of L^2) in luminance.
struct SampledLight {
  std::vector<metrics::Estimate> coefficients;
  metrics::Estimate energy;
};

SampledLight sample_light(const light::Environment& environment, int bands, const Budget& budget) {
  const auto count = static_cast<std::size_t>(sh::coefficient_count(bands));
  const light::EnvironmentSampler sampler(environment);
  const sh::Basis<double> basis(bands);
  std::vector<double> y(count);
  std::vector<metrics::RunningMoments> moments(count + 1);
  std::vector<double> sums(count + 1);
  const int per_group = std::max(1, budget.projection_samples / kGroups);
  for (std::uint32_t group = 0; group < kGroups; ++group) {
    std::fill(sums.begin(), sums.end(), 0.0);
    for (int s = 0; s < per_group; ++s) {
      integrate::Sampler random(budget.seed, 0x5eed, group, static_cast<std::uint32_t>(s));
      const std::optional<light::DirectionSample> sample = sampler.sample(random.next_2d());
      if (!sample) continue;
      const Vec3d d(sample->direction);
      basis.evaluate(d.x, d.y, d.z, y);
      const double value = static_cast<double>(luminance(sample->radiance));
      for (std::size_t i = 0; i < count; ++i) sums[i] += y[i] * value / sample->pdf;
      sums[count] += value * value / sample->pdf;
    }
    for (std::size_t i = 0; i <= count; ++i) moments[i].add(sums[i] / per_group);
  }
  SampledLight result;
  for (std::size_t i = 0; i < count; ++i) result.coefficients.push_back(moments[i].estimate());
  result.energy = moments[count].estimate();
  return result;
}

double luminance_of(const RgbD& c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

/// Share of the light's energy in the first 1 … n bands.
std::vector<double> captured_energy(const sh::ShRgb& lighting) {
  std::vector<double> captured;
  double sum = 0.0;
  for (int l = 0; l < lighting.bands; ++l) {
    for (int m = -l; m <= l; ++m)
      sum += std::pow(luminance_of(lighting.coefficients[static_cast<std::size_t>(sh::index(l, m))]), 2);
    captured.push_back(sum);
  }
  return captured;
}

Finding coefficients_finding(const std::string& name, const sh::ShRgb& lighting, const SampledLight& sampled,
                             const Budget& budget) {
  double worst = 0.0;
  double scale = 0.0;
  for (const RgbD& c : lighting.coefficients) scale = std::max(scale, std::abs(luminance_of(c)));
  for (std::size_t i = 0; i < sampled.coefficients.size(); ++i) {
    const metrics::Estimate& e = sampled.coefficients[i];
    // Where the sampling is exact to rounding (a constant sky) the standard error says nothing.
    const double error = std::max(e.standard_error, 1e-6 * scale);
    const double z = std::abs(luminance_of(lighting.coefficients[i]) - e.mean) / error;
    worst = z <= worst ? worst : z;
  }
  return judge_largest_z(
      {"projection", name + " / coefficients", "Independent Monte Carlo over the light's own samples",
       fmt::format("{} coefficients; largest |z|.", sampled.coefficients.size())},
      worst, sampled.coefficients.size(), kGroups - 1, budget.significance);
}

}  // namespace

void check_projection(const Suite& suite, report::Report& report) {
  report::Chart chart;
  chart.title = "How much of the light n bands can hold";
  chart.caption =
      "Relative L2 error of the light rebuilt from n bands. Lower is better; a curve that stays high belongs "
      "to a light with a small, bright sun, which no "
      "small number of bands can hold.";
  chart.x_label = "bands";
  chart.y_label = "relative L2 error";
  chart.is_y_log = true;
  for (const light::Environment& environment : suite.environments) {
    const std::string name = short_name(environment.name);
    if (suite.announce) suite.announce("projecting " + name);
    const int bands = std::max(kChartBands, *std::max_element(suite.bands.begin(), suite.bands.end()));
    const sh::ShRgb lighting = sh::project_radiance(environment, bands, suite.budget.threads);
    const SampledLight sampled = sample_light(environment, bands, suite.budget);
    report.findings.push_back(coefficients_finding(name, lighting, sampled, suite.budget));
    const std::vector<double> captured = captured_energy(lighting);
    const double limit = metrics::two_sided_z(suite.budget.significance) * sampled.energy.standard_error;
    report.findings.push_back(judge_error(
        {"projection", name + " / Bessel's inequality", "Energy of the coefficients <= energy of the light",
         "Excess of the coefficients' energy over the light's, relative; 0 or less is right."},
        captured.back() / sampled.energy.mean - 1.0, limit / sampled.energy.mean + 1e-6));
    report::Series series{name, {}, {}, {}, {}, false};
    for (int n = 1; n <= kChartBands; ++n) {
      series.x.push_back(n);
      const double share = captured[static_cast<std::size_t>(n - 1)] / sampled.energy.mean;
      series.y.push_back(std::sqrt(std::max(1e-12, 1.0 - share)));
    }
    chart.series.push_back(series);
  }
  report.charts.push_back(chart);
}

}  // namespace plumbline::checks
