// validation/checks/suite.hpp: the check families of `plumbline validate`. Each adds its findings, charts, tables and pictures to a report.
#pragma once

#include <string>
#include <vector>

#include "validation/checks/case.hpp"
#include "validation/report/report.hpp"

namespace plumbline::checks {

/// The basis itself: orthonormality (Gram matrix), signs and order, the addition theorem, the clamped cosine.
void check_basis(const Suite& suite, report::Report& report);

/// Products, exponentials and logarithms of coefficients: against quadrature and closed forms, and which exponential to use for the
/// log visibility of spheres.
void check_exponential(const Suite& suite, report::Report& report);

/// Each environment's coefficients: against Monte Carlo with the reference's light sampling, Bessel's inequality, convergence with bands.
void check_projection(const Suite& suite, report::Report& report);

/// Transfer against closed forms: convex body, infinite corner, sphere on a plane.
void check_transfer(const Suite& suite, report::Report& report);

/// Path tracer and transfer in a white furnace, on each scene.
void check_furnace(const Suite& suite, report::Report& report);

/// Interreflected transfer against path-traced irradiance, bounce by bounce, and against an infinite corner's closed form.
void check_bounces(const Suite& suite, report::Report& report);

/// The path tracer against every closed form of light transport, and the judge itself: are its standard errors right,
/// does it find biases as often as it says, does it cry wolf?
void check_truths(const Suite& suite, report::Report& report);

/// Images of shadowed and interreflected PRT against path tracing of the same bounces, under the band-limited and under the full light.
void check_images(const Suite& suite, report::Report& report);

/// Normal-mapped PRT in seven forms against path tracing with the same map: the given scenes that have one, else builtin:normal-mapped.
void check_normal_maps(const Suite& suite, report::Report& report);

/// Size against error of the ways to compress transfer, and whether one sees it.
void check_compression(const Suite& suite, report::Report& report);

struct Family {
  std::string name;
  std::string description;
  void (*run)(const Suite&, report::Report&);
  bool is_only_when_named = false;  // minutes of work that have nothing to do with the scenes given
};
/// All, in the order they run.
[[nodiscard]] const std::vector<Family>& families();

}  // namespace plumbline::checks
