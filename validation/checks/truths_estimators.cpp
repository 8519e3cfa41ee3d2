#include "validation/checks/truths_estimators.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <random>

#include "reference/integrate/gather.hpp"
#include "reference/integrate/render.hpp"
#include "validation/metrics/statistics.hpp"

namespace plumbline::checks {
namespace {

using integrate::GatherSettings;
using integrate::RgbEstimate;

/// Independent replicates of one run.
constexpr int kReplicates = integrate::kRandomisations;
constexpr double kRunFreedom = kReplicates - 1.0;

GatherSettings settings_of(const Effort& effort, int bounces, std::uint64_t seed) {
  GatherSettings settings;
  settings.samples = effort.samples;
  settings.max_bounces = bounces;
  settings.seed = seed;
  settings.threads = effort.threads;
  return settings;
}

/// Runs of one thing, of equal size: mean of the means, their variances pooled.
Measurement pooled(std::span<const RgbEstimate> runs) {
  Measurement result;
  double variance = 0.0;
  for (const RgbEstimate& run : runs) {
    result.mean += run.mean.y;
    variance += run.standard_error.y * run.standard_error.y;
  }
  const auto count = static_cast<double>(runs.size());
  result.mean /= count;
  result.standard_error = std::sqrt(variance) / count;
  result.degrees_of_freedom = kRunFreedom * count;
  return result;
}

Measurement from_replicates(std::span<const double> replicates) {
  const metrics::Estimate e = metrics::estimate(replicates);
  return {e.mean, e.standard_error, static_cast<double>(replicates.size() - 1)};
}

double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11U) * 0x1p-53;
}

trace::SurfacePoint point_at(const Vec3d& position, const Vec3d& normal) {
  return trace::free_point(Vec3(position), glm::normalize(Vec3(normal)));
}

/// Side of the grid of jittered points that a replicate gets.
int strata(const Effort& effort) {
  const double each = static_cast<double>(effort.samples) / kReplicates;
  return std::max(1, static_cast<int>(std::lround(std::sqrt(each))));
}

template <class Function>
void for_jittered(int side, std::mt19937_64& random, const Function& f) {
  for (int i = 0; i < side * side; ++i) {
    const double u = (i % side + uniform(random)) / side;
    const double v = (static_cast<double>(i / side) + uniform(random)) / side;
    f(u, v);
  }
}

}  // namespace

TruthCase named(std::string name, std::string formula, double truth, std::function<Estimator()> prepare) {
  TruthCase one;
  one.name = std::move(name);
  one.formula = std::move(formula);
  one.truth = truth;
  one.prepare = std::move(prepare);
  return one;
}

SharedWorld make_world(scene::Scene scene, light::Environment environment) {
  return std::make_shared<const integrate::World>(std::move(scene), std::move(environment));
}

// nu = (sum v)^2 / sum (v^2 / nu_i) with v the terms' squared standard errors.
Estimator irradiance_sum(std::vector<IrradianceTerm> terms, double offset) {
  return [terms = std::move(terms), offset](const Effort& effort) {
    Measurement result{offset, 0.0, kRunFreedom * effort.copies};
    double variance = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < terms.size(); ++i) {
      const IrradianceTerm& term = terms[i];
      const std::vector<trace::SurfacePoint> points(static_cast<std::size_t>(effort.copies), term.point);
      const GatherSettings settings = settings_of(effort, term.bounces, truth_seed(effort.seed, "term", i));
      const Measurement m = pooled(integrate::gather_irradiance(*term.world, points, settings));
      result.mean += term.factor * m.mean;
      const double v = term.factor * term.factor * m.standard_error * m.standard_error;
      variance += v;
      squares += v * v / m.degrees_of_freedom;
    }
    result.standard_error = std::sqrt(variance);
    if (squares > 0.0) result.degrees_of_freedom = variance * variance / squares;
    return result;
  };
}

Estimator irradiance_at(SharedWorld world, const Vec3d& position, const Vec3d& normal, int bounces) {
  return irradiance_sum({{std::move(world), point_at(position, normal), 1.0, bounces}});
}

// The sum of several bounces of one path has no standard error of its own from gather: short runs are the replicates.
Estimator bounces_at(SharedWorld world, const Vec3d& position, const Vec3d& normal, int first, int last) {
  return [world = std::move(world), point = point_at(position, normal), first, last](const Effort& effort) {
    const std::vector<trace::SurfacePoint> points(static_cast<std::size_t>(kReplicates * effort.copies),
                                                  point);
    GatherSettings settings = settings_of(effort, last, effort.seed);
    settings.samples = std::max(1, effort.samples / kReplicates);
    std::vector<double> replicates;
    for (const integrate::BouncesEstimate& e : integrate::gather_bounces(*world, points, settings)) {
      double sum = 0.0;
      for (int k = first; k <= last; ++k) sum += e.bounces[static_cast<std::size_t>(k)].mean.y;
      replicates.push_back(sum);
    }
    return from_replicates(replicates);
  };
}

std::vector<Node> unit_interval_nodes() {
  using Rule =
      boost::math::quadrature::gauss<double, 8>;  // the half of the nodes that is positive, on [-1, 1]
  std::vector<Node> nodes;
  for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
    for (const double sign : {-1.0, 1.0})
      nodes.push_back({0.5 + 0.5 * sign * Rule::abscissa()[i], 0.5 * Rule::weights()[i]});
  }
  return nodes;
}

Estimator irradiance_over(SharedWorld world, std::function<WeightedPoint(double u, double v)> place,
                          int bounces) {
  return [world = std::move(world), place = std::move(place), bounces](const Effort& effort) {
    std::mt19937_64 random(effort.seed);
    const int side = strata(effort);
    const int count = kReplicates * effort.copies;
    std::vector<trace::SurfacePoint> points;
    std::vector<double> weights;
    for (int r = 0; r < count; ++r) {
      for_jittered(side, random, [&](double u, double v) {
        const WeightedPoint one = place(u, v);
        points.push_back(one.point);
        weights.push_back(one.weight);
      });
    }
    GatherSettings settings = settings_of(effort, bounces, effort.seed);
    settings.samples = 1;
    const std::vector<RgbEstimate> irradiances = integrate::gather_irradiance(*world, points, settings);
    const auto each = static_cast<std::size_t>(side * side);
    std::vector<double> replicates(static_cast<std::size_t>(count), 0.0);
    for (std::size_t i = 0; i < points.size(); ++i)
      replicates[i / each] += weights[i] * irradiances[i].mean.y / static_cast<double>(each);
    return from_replicates(replicates);
  };
}

Estimator plain_mean(std::function<double(double u, double v)> f) {
  return [f = std::move(f)](const Effort& effort) {
    std::mt19937_64 random(effort.seed);
    const int side = strata(effort);
    std::vector<double> replicates;
    for (int r = 0; r < kReplicates * effort.copies; ++r) {
      double sum = 0.0;
      for_jittered(side, random, [&](double u, double v) { sum += f(u, v); });
      replicates.push_back(sum / (static_cast<double>(side) * side));
    }
    return from_replicates(replicates);
  };
}

Estimator image_mean(SharedWorld world, const scene::Camera& camera, int bounces) {
  return [world = std::move(world), camera, bounces](const Effort& effort) {
    constexpr int kSide = 32;
    integrate::RenderSettings settings;
    settings.width = settings.height = kSide;
    settings.samples_per_pixel = std::max(1, effort.samples / (kReplicates * kSide * kSide));
    settings.max_bounces = bounces;
    settings.threads = effort.threads;
    std::vector<double> replicates;
    for (int r = 0; r < kReplicates * effort.copies; ++r) {
      settings.seed = truth_seed(effort.seed, "image", static_cast<std::uint64_t>(r));
      double sum = 0.0;
      const integrate::RenderResult result = integrate::render(*world, camera, settings);
      for (const float value : result.image.channels.at("G")) sum += static_cast<double>(value);
      replicates.push_back(sum / (kSide * kSide));
    }
    return from_replicates(replicates);
  };
}

}  // namespace plumbline::checks
