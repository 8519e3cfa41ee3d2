// Irradiance, transfer, relighting, windows and the dominant direction.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "validation/checks/sh_checks.hpp"
#include "validation/conformance/check.hpp"
#include "validation/conformance/diagnosis.hpp"
#include "validation/conformance/truths.hpp"

namespace plumbline::conformance {
namespace {

constexpr const char* kIrradiance = "irradiance";
constexpr const char* kTransfer = "transfer unshadowed";
constexpr const char* kRelight = "relight";
constexpr const char* kWindow = "window";
constexpr const char* kDominant = "dominant direction";
constexpr double kWhite = 3.5449077018110318;  // sqrt(4 pi)

std::size_t size_of(int bands) {
  return static_cast<std::size_t>(bands) * static_cast<std::size_t>(bands);
}

int degree_of(std::size_t index) {
  return static_cast<int>(std::sqrt(static_cast<double>(index) + 0.5));
}

Values convolved(Values v) {
  Values factors;
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (static_cast<std::size_t>(degree_of(i)) >= factors.size())
      factors.push_back(truths::cosine_factor(degree_of(i)));
    v[i] *= factors[static_cast<std::size_t>(degree_of(i))];
  }
  return v;
}

double dot(const Values& a, const Values& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

std::vector<Vec3d> normals() {
  return {{0, 1, 0}, {0, 0, 1}, {2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0}, {-0.6, 0.0, 0.8}, {0.48, -0.64, -0.6}};
}

double irradiance_of(const Context& context, const Values& coefficients, const Vec3d& normal) {
  return must(context.subject.irradiance(context.bands, coefficients, normal), "radiance coefficients")[0];
}

// ---------------------------------------------------------------- irradiance
/// Response to each coefficient alone: A_l y_lm(n). A uniform light beside it keeps irradiance positive.
std::vector<Judged> irradiance_kernel(const Context& context) {
  Pairs pairs;
  Pairs unconvolved;
  for (const Vec3d& n : normals()) {
    Values response;
    Values dark(size_of(context.bands), 0.0);
    dark[0] = 4.0 * kWhite;
    const double base = irradiance_of(context, dark, n);
    for (std::size_t i = 0; i < dark.size(); ++i) {
      Values c = dark;
      c[i] += 1.0;
      response.push_back(irradiance_of(context, c, n) - base);
    }
    pairs.add(convolved(truths::basis(context.bands, n)), response);
    unconvolved.add(truths::basis(context.bands, n), response);
  }
  Judged result = judged_coefficients(
      context, {kIrradiance, "response to each coefficient", "A_l y_lm(n); rounding", context.bands}, pairs,
      128.0 * rounding(context, context.bands), 1e-5);
  if (!result.cause.empty() && unconvolved.error(context.ruler) <= 1e-4)
    result.cause = result.finding.detail = "the clamped cosine's factors (pi, 2 pi/3, pi/4) are missing";
  return {result};
}

std::vector<Judged> irradiance_uniform(const Context& context) {
  Pairs pairs;
  for (const double radiance : {1.0, 3.0}) {
    Values c(size_of(context.bands), 0.0);
    c[0] = radiance * kWhite;
    for (const Vec3d& n : normals()) pairs.add({kPi * radiance}, {irradiance_of(context, c, n)});
  }
  return {judged_values(context, {kIrradiance, "uniform light", "E = pi L; rounding", context.bands}, pairs,
                        64.0 * rounding(context, context.bands), 1e-4)};
}

/// S3: a pulse of irradiance 1, seen through n bands, from the front to the back. Negative values are right.
std::vector<Judged> irradiance_pulse(const Context& context) {
  Pairs pairs;
  bool lost_negative = false;
  const Vec3d d(2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0);
  const Vec3d side = glm::normalize(glm::cross(d, Vec3d(0, 1, 0)));
  const Values light = truths::basis(context.bands, d);
  for (int k = 0; k <= 12; ++k) {
    const Vec3d n = std::cos(kPi * k / 12.0) * d + std::sin(kPi * k / 12.0) * side;
    const double expected = dot(convolved(truths::basis(context.bands, n)), light);
    const double answer = irradiance_of(context, light, n);
    lost_negative = lost_negative || (expected < -1e-4 && std::abs(answer) < 1e-12);
    pairs.add({expected}, {answer});
  }
  Judged result = judged_values(
      context, {kIrradiance, "a light without extent", "sum A_l (2l + 1)/4 pi P_l; rounding", context.bands},
      pairs, 64.0 * rounding(context, context.bands), 1e-4);
  if (lost_negative && !result.cause.empty())
    result.cause = result.finding.detail = "negative irradiance of band-limited light is set to 0";
  return {result};
}

/// Degree-2 sky without symmetry, in closed form: pi a + 2 pi/3 b.n + pi/4 (trace Q + n Q n).
std::vector<Judged> irradiance_polynomial(const Context& context) {
  if (context.bands < 3) return {};
  const Values c = truths::projected(context.bands, truths::polynomial_sky, 4);
  const Vec3d b(0.3, -0.5, 0.7);
  const glm::dmat3 q(0.4, 0.125, -0.175, 0.125, -0.3, 0.1, -0.175, 0.1, 0.0);
  Pairs pairs;
  for (const Vec3d& n : checks::probe_directions()) {
    const double expected =
        2.0 * kPi + 2.0 * kPi / 3.0 * glm::dot(b, n) + kPi / 4.0 * (0.1 + glm::dot(n, q * n));
    pairs.add({expected}, {irradiance_of(context, c, n)});
  }
  return {judged_values(
      context, {kIrradiance, "polynomial sky", "Closed form of a degree-2 sky; rounding", context.bands},
      pairs, 64.0 * rounding(context, context.bands), 1e-4)};
}

std::vector<Judged> irradiance_linear(const Context& context) {
  Pairs pairs;
  const Values a = truths::some_values(size_of(context.bands), 21);
  const Values b = truths::some_values(size_of(context.bands), 22);
  for (const Vec3d& n : normals()) {
    Values sum = a;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = 2.0 * a[i] - 3.0 * b[i];
    pairs.add({2.0 * irradiance_of(context, a, n) - 3.0 * irradiance_of(context, b, n)},
              {irradiance_of(context, sum, n)});
  }
  const double bound = 512.0 * rounding(context, context.bands);
  return {judged(context, {kIrradiance, "linear", "E(2a - 3b) = 2E(a) - 3E(b); rounding", context.bands},
                 pairs.error(context.ruler), bound,
                 "irradiance is not linear in the light (clamped, or a fitted lobe)")};
}

// ---------------------------------------------------------------- transfer and relighting
std::vector<Judged> transfer(const Context& context) {
  Pairs pairs;
  for (const Vec3d& n : checks::probe_directions()) {
    Values expected = convolved(truths::basis(context.bands, n));
    for (double& v : expected) v /= kPi;
    pairs.add(expected, must(context.subject.transfer_unshadowed(context.bands, n), "a unit normal"));
  }
  return {judged_coefficients(
      context, {kTransfer, "clamped cosine about each normal", "A_l y_lm(n)/pi; rounding", context.bands},
      pairs, 16.0 * rounding(context, context.bands), 1e-5)};
}

std::vector<Judged> relight_dot(const Context& context) {
  Pairs pairs;
  for (unsigned k = 0; k < 4; ++k) {
    const Values t = truths::some_values(size_of(context.bands), 30 + k);
    Values response;
    for (std::size_t i = 0; i < t.size(); ++i) {
      Values light(t.size(), 0.0);
      light[i] = 1.0;
      response.push_back(must(context.subject.relight(context.bands, t, light), "transfer and light")[0]);
    }
    pairs.add(t, response);
  }
  return {judged_coefficients(context,
                              {kRelight, "transfer . light", "A dot product; rounding", context.bands}, pairs,
                              16.0 * rounding(context, context.bands), 1e-5)};
}

/// The implementation's own transfer under its own light. The sum over m needs no convention.
std::vector<Judged> relight_whole(const Context& context) {
  const int bands = context.bands;
  Pairs pairs;
  Values mixed;
  Values reversed;
  const double facing = [&] {
    if (context.subject.raw().light_unit != PLUMBLINE_LIGHT_FACING_ONE) return 1.0;
    return kPi / dot(convolved(truths::basis(bands, {0, 0, 1})), truths::basis(bands, {0, 0, 1}));
  }();
  for (const Vec3d& n : normals()) {
    for (const Vec3d& d : normals()) {
      const Values t = must(context.subject.transfer_unshadowed(bands, n), "a unit normal");
      const Values light = must(context.subject.light_directional(bands, d), "a unit direction");
      const auto expected = [&](const Vec3d& from) {
        return facing * dot(convolved(truths::basis(bands, n)), truths::basis(bands, from)) / kPi;
      };
      pairs.add({expected(d)}, {must(context.subject.relight(bands, t, light), "transfer and light")[0]});
      mixed.push_back(expected({-d.x, -d.y, d.z}));
      reversed.push_back(expected(-d));
    }
  }
  const auto is_like = [&](const Values& v) {
    for (std::size_t k = 0; k < v.size(); ++k)
      if (!(std::abs(v[k] - pairs.measured[k][0]) <= 1e-4)) return false;
    return true;
  };
  Judged result = judged_values(
      context,
      {kRelight, "own transfer under own light", "sum A_l (2l + 1)/4 pi^2 P_l(n.d); rounding", bands}, pairs,
      64.0 * rounding(context, bands), 1e-4);
  if (result.cause.empty()) return {result};
  if (is_like(mixed))
    result.cause = "light and transfer use different signs for odd m (Condon-Shortley phase)";
  if (is_like(reversed)) result.cause = "light and transfer use opposite directions";
  result.finding.detail = result.cause;
  return {result};
}

// ---------------------------------------------------------------- window, dominant direction
/// A sharp light, for which a window must do something.
Values sharp_light(int bands, const Vec3d& d) {
  Values light = truths::basis(bands, d);
  const Values other = truths::basis(bands, glm::normalize(Vec3d(0.3, -0.9, 0.2)));
  for (std::size_t i = 0; i < light.size(); ++i) light[i] += 0.3 * other[i];
  return light;
}

std::vector<Judged> window_factors(const Context& context) {
  const int bands = context.bands;
  const Values in = sharp_light(bands, glm::normalize(Vec3d(1, 2, 3)));
  const Values out = must(context.subject.window(bands, in), "radiance coefficients");
  Pairs pairs;
  Values expected(in.size());
  double outside = 0.0;
  for (int l = 0; l < bands; ++l) {
    double num = 0.0;
    double den = 0.0;
    for (std::size_t i = size_of(l); i < size_of(l + 1); ++i) {
      num += in[i] * out[i];
      den += in[i] * in[i];
    }
    const double factor = l == 0 ? 1.0 : num / den;
    outside = std::max({outside, factor - 1.0, -factor});
    for (std::size_t i = size_of(l); i < size_of(l + 1); ++i) expected[i] = factor * in[i];
  }
  pairs.add(expected, out);
  const double bound = 16.0 * rounding(context, bands);
  std::vector<Judged> results{judged_coefficients(
      context, {kWindow, "one factor a band, band 0 kept", "Definition of a window; rounding", bands}, pairs,
      bound, 1e-5)};
  results.push_back(judged(context,
                           {kWindow, "factors in 0 ... 1", "A window never amplifies; rounding", bands},
                           outside, bound, "a factor is negative or above 1"));
  return results;
}

std::vector<Judged> window_rotation(const Context& context) {
  const int bands = context.bands;
  Pairs pairs;
  const Values in = sharp_light(bands, glm::normalize(Vec3d(1, 2, 3)));
  const Values windowed = must(context.subject.window(bands, in), "radiance coefficients");
  for (const glm::dmat3& r : truths::rotations())
    pairs.add(truths::rotated(bands, windowed, r),
              must(context.subject.window(bands, truths::rotated(bands, in, r)), "radiance coefficients"));
  // A window that searches for its strength may stop a little earlier or later in the turned function.
  const double bound = 1e-3 * pairs.scale();
  return {judged(
      context,
      {kWindow, "the same however the function is turned", "Rotation invariance, search to 1e-3", bands},
      pairs.error(context.ruler), bound,
      "the window depends on how the function is turned (a sum over m that leaves some out)")};
}

std::vector<Judged> dominant(const Context& context) {
  Pairs pairs;
  if (context.bands < 2) return {};
  for (const Vec3d& d : checks::probe_directions()) {
    Values c = truths::basis(context.bands, d);
    c[0] = 3.0;
    const Values answer =
        must(context.subject.dominant_direction(context.bands, c), "coefficients with a direction");
    pairs.add({d.x, d.y, d.z}, answer);
  }
  Judged result =
      judged_values(context, {kDominant, "known directions", "Band 1 points there; rounding", context.bands},
                    pairs, 16.0 * rounding(context, context.bands), 1e-4);
  const Answer none = context.subject.dominant_direction(context.bands, Values(size_of(context.bands), 0.0));
  const double answered = none ? 1.0 : 0.0;
  const bool is_nan = none && std::isnan((*none)[0]);
  return {result,
          judged(context, {kDominant, "no light, no direction", "Refused", context.bands}, answered, 0.0,
                 is_nan ? "NaN for zero coefficients (normalises a vector of length 0)"
                        : "answers where there is no direction")};
}

bool has_irradiance(const Implementation& i) {
  return i.irradiance != nullptr;
}
bool has_transfer(const Implementation& i) {
  return i.transfer_unshadowed != nullptr;
}
bool has_relight(const Implementation& i) {
  return i.relight != nullptr;
}
bool has_whole(const Implementation& i) {
  return i.relight != nullptr && i.transfer_unshadowed != nullptr && i.light_directional != nullptr;
}
bool has_window(const Implementation& i) {
  return i.window != nullptr;
}
bool has_dominant(const Implementation& i) {
  return i.dominant_direction != nullptr;
}

}  // namespace

std::vector<Check> lighting_checks() {
  return {{kIrradiance, "response to each coefficient", has_irradiance, true, irradiance_kernel},
          {kIrradiance, "uniform light", has_irradiance, true, irradiance_uniform},
          {kIrradiance, "a light without extent", has_irradiance, true, irradiance_pulse},
          {kIrradiance, "polynomial sky", has_irradiance, true, irradiance_polynomial},
          {kIrradiance, "linear", has_irradiance, false, irradiance_linear},
          {kTransfer, "clamped cosine about each normal", has_transfer, true, transfer},
          {kRelight, "transfer . light", has_relight, true, relight_dot},
          {kRelight, "own transfer under own light", has_whole, false, relight_whole},
          {kWindow, "factors", has_window, true, window_factors},
          {kWindow, "the same however the function is turned", has_window, true, window_rotation},
          {kDominant, "directions", has_dominant, true, dominant}};
}

}  // namespace plumbline::conformance
