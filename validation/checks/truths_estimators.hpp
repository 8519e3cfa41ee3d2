// validation/checks/truths_estimators.hpp: ways to get a number out of the path tracer, each with an honest standard
// error. Scenes are grey: the green channel stands for all.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "reference/integrate/path.hpp"
#include "reference/integrate/world.hpp"
#include "reference/trace/surface_point.hpp"
#include "validation/checks/truths.hpp"

namespace plumbline::checks {

[[nodiscard]] TruthCase named(std::string name, std::string formula, double truth,
                              std::function<Estimator()> prepare);

using SharedWorld = std::shared_ptr<const integrate::World>;
[[nodiscard]] SharedWorld make_world(scene::Scene scene, light::Environment environment);

/// factor x irradiance at a point.
struct IrradianceTerm {
  SharedWorld world;
  trace::SurfacePoint point;
  double factor = 1.0;
  int bounces = integrate::kAllBounces;
};

/// offset + the sum of the terms, each from paths of its own; degrees of freedom by Welch and Satterthwaite.
[[nodiscard]] Estimator irradiance_sum(std::vector<IrradianceTerm> terms, double offset = 0.0);
/// Irradiance at one point.
[[nodiscard]] Estimator irradiance_at(SharedWorld world, const Vec3d& position, const Vec3d& normal,
                                      int bounces = integrate::kAllBounces);
/// Irradiance at one point from light that bounced first … last times.
[[nodiscard]] Estimator bounces_at(SharedWorld world, const Vec3d& position, const Vec3d& normal, int first,
                                   int last);

/// A point with its weight in an average.
struct WeightedPoint {
  trace::SurfacePoint point;
  double weight = 1.0;
};
/// Gauss-Legendre nodes on [0, 1], eight of them.
struct Node {
  double place = 0.0;
  double weight = 0.0;
};
[[nodiscard]] std::vector<Node> unit_interval_nodes();

/// Mean of weight x irradiance over the unit square mapped by `place`: jittered points on a grid, one path each; every
/// randomisation has points of its own.
[[nodiscard]] Estimator irradiance_over(SharedWorld world,
                                        std::function<WeightedPoint(double u, double v)> place,
                                        int bounces = integrate::kAllBounces);

/// Mean of f(u, v) over the unit square by jittered points: the plain Monte Carlo estimate.
[[nodiscard]] Estimator plain_mean(std::function<double(double u, double v)> f);

/// Mean radiance of a square image of 32 x 32 pixels, light seen directly included; a randomisation is an image.
[[nodiscard]] Estimator image_mean(SharedWorld world, const scene::Camera& camera,
                                   int bounces = integrate::kAllBounces);

}  // namespace plumbline::checks
