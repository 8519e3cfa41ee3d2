// prt/sh/functions.hpp: projection of functions on the sphere, by exact quadrature and by Monte Carlo.
// Conventions: CONVENTIONS.md#spherical-harmonics.
// [1] Green, "Spherical Harmonic Lighting: The Gritty Details", GDC 2003. [2] Owen, "Scrambled net variance for
// integrals of smooth functions", Annals of Statistics 25(4), 1997.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "reference/base/vector.hpp"

namespace plumbline::sh {

/// Real function of a unit direction.
using SphereFunction = std::function<double(const Vec3d& direction)>;

/// c_lm = integral over the sphere of f(w) y_lm(w) dw, by Gauss-Legendre in z times uniform nodes in azimuth: exact but
/// for rounding (1e-14 of f's size) when f has at most `function_bands` bands. Others alias: what f has of degree l' >=
/// function_bands enters the coefficients of degree l when l + l' is at least twice the rule's bands, and as a lower one.
/// @param function_bands at least `bands`; 0 stands for `bands`
/// Cost: ((bands + function_bands) / 2)^2 evaluations of f, twice.
/// @throws InputError for bands out of range, or a value that is not finite
[[nodiscard]] std::vector<double> project_function(const SphereFunction& f, int bands,
                                                   int function_bands = 0);

/// Points in the unit square from which directions are made.
enum class PointSet {
  independent,  // standard error falls as N^-1/2
  stratified,   // one point in each cell of a grid: N^-1 where f is smooth
  quasi_random  // Owen-scrambled (0, 2)-sequence: N^-3/2 where f is smooth [2]
};
/// How directions are distributed: over the sphere, or about +z as cos(theta)/pi. The latter is for functions that hold
/// the factor max(0, z): it must be 0 for z <= 0, where no point ever falls.
enum class DirectionDensity { uniform, cosine };

/// A source of uniform numbers in [0, 1): the one numbered `index`.
using UniformSource = std::function<double(std::uint64_t index)>;
/// The one used where none is given: a 64-bit mix (SplitMix64) of seed and index.
[[nodiscard]] UniformSource uniform_source(std::uint64_t seed);

struct MonteCarloSettings {
  PointSet points = PointSet::quasi_random;
  DirectionDensity density = DirectionDensity::uniform;
  std::size_t samples = 1024;  // of each replicate; stratified takes the largest rows x columns grid it holds
  int replicates = 16;  // independent randomisations of the point set, at least 2: their spread is the error
  UniformSource uniform = uniform_source(1);
  int threads = 1;  // 0 = all; same bits for any number
};

struct MonteCarloProjection {
  std::vector<double> coefficients;     // mean over the replicates
  std::vector<double> standard_errors;  // of that mean, from the replicates' spread
  std::size_t evaluations = 0;          // of f
};
/// Estimates c_lm without bias: the mean of f(w) y_lm(w) / p(w) [1].
/// @throws InputError for bands, samples (1 … 2^32) or replicates out of range, or a value of f that is not finite
[[nodiscard]] MonteCarloProjection estimate_projection(const SphereFunction& f, int bands,
                                                       const MonteCarloSettings& settings);

}  // namespace plumbline::sh
