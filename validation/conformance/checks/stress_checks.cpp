// Extreme input of the operations that are linear in their coefficients: the contract says what may come.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "validation/conformance/check.hpp"
#include "validation/conformance/truths.hpp"

namespace plumbline::conformance {
namespace {

using Operation = std::function<Answer(const Values&)>;

std::size_t size_of(int bands) {
  return static_cast<std::size_t>(bands) * static_cast<std::size_t>(bands);
}

Values times(Values v, double factor) {
  for (double& x : v) x *= factor;
  return v;
}

/// Non-finite input: refused, or seen in the output.
Judged non_finite(const Context& context, const char* operation, const Operation& apply) {
  double hidden = 0.0;
  std::string which;
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    Values in = truths::some_values(size_of(context.bands), 40);
    in.back() = bad;
    const Answer answer = apply(in);
    if (!answer) continue;
    const bool is_seen =
        std::any_of(answer->begin(), answer->end(), [](double v) { return !std::isfinite(v); });
    if (is_seen) continue;
    hidden += 1.0;
    which += fmt::format(" {}", bad);
  }
  return judged(context, {operation, "non-finite input", "Refused or passed on, never hidden", context.bands},
                hidden, 0.0, "a finite answer to" + which);
}

/// Scales of 1e30 and 1e-30, and denormals: in proportion, where single precision can hold it.
Judged scales(const Context& context, const char* operation, const Operation& apply, double power) {
  Pairs pairs;
  const bool is_float = context.subject.epsilon() > 1e-10;
  const Values in = truths::some_values(size_of(context.bands), 41);
  const Values base = must(apply(in), "coefficients");
  const double extreme = power > 1.0 ? 1e15 : 1e30;
  for (const double scale : {extreme, 1.0 / extreme, -1.0}) {
    const double back = std::pow(scale, power);
    pairs.add(base, times(must(apply(times(in, scale)), "large and small coefficients"), 1.0 / back));
  }
  // Denormals may be flushed to 0, no more: an answer of their own size or none.
  const double tiny = is_float ? 1e-40 : 1e-310;
  for (const double v : must(apply(times(in, tiny)), "denormal coefficients"))
    pairs.add({0.0}, {std::abs(v) <= 1e4 * tiny ? 0.0 : v});
  pairs.add(Values(base.size(), 0.0), must(apply(Values(in.size(), 0.0)), "zero coefficients"));
  const double bound = 64.0 * std::max(1.0, pairs.scale()) * rounding(context, context.bands);
  return judged(
      context, {operation, "scales 1e+-30, denormals, zeros", "In proportion; rounding", context.bands},
      pairs.error(context.ruler), bound, "not in proportion at extreme scales (overflow or underflow)");
}

std::vector<Judged> stressed(const Context& context, const char* operation, const Operation& apply,
                             double power = 1.0) {
  return {non_finite(context, operation, apply), scales(context, operation, apply, power)};
}

std::vector<Judged> rotate(const Context& context) {
  const glm::dmat3 r = truths::rotations()[0];
  return stressed(context, "rotate",
                  [&](const Values& in) { return context.subject.rotate(context.bands, r, in); });
}
std::vector<Judged> irradiance(const Context& context) {
  // 3 bands: those above may have no part in irradiance, and then hide what is in them.
  const Context few{context.subject, std::min(3, context.bands), context.ruler};
  return stressed(few, "irradiance", [&](const Values& in) {
    return few.subject.irradiance(few.bands, in, glm::normalize(Vec3d(1, 2, 3)));
  });
}
std::vector<Judged> relight(const Context& context) {
  const Values t = truths::some_values(size_of(context.bands), 42);
  return stressed(context, "relight",
                  [&](const Values& in) { return context.subject.relight(context.bands, t, in); });
}
std::vector<Judged> multiply(const Context& context) {
  return stressed(
      context, "multiply", [&](const Values& in) { return context.subject.multiply(context.bands, in, in); },
      2.0);
}

std::vector<Judged> image(const Context& context) {
  double hidden = 0.0;
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    image::Image sky = image::make_image(8, 4, Rgb(1.0F));
    sky.at(3, 1) = Rgb(bad);
    const Answer answer = context.subject.project_lat_long(context.bands, sky);
    if (answer && std::all_of(answer->begin(), answer->end(), [](double v) { return std::isfinite(v); }))
      hidden += 1.0;
  }
  return {judged(
      context, {"project lat-long", "non-finite texels", "Refused or passed on, never hidden", context.bands},
      hidden, 0.0, "a finite answer to an image with a non-finite texel")};
}

}  // namespace

std::vector<Check> stress_checks() {
  return {
      {"rotate", "stress", [](const Implementation& i) { return i.rotate != nullptr; }, false, rotate},
      {"multiply", "stress", [](const Implementation& i) { return i.multiply != nullptr; }, false, multiply},
      {"irradiance", "stress", [](const Implementation& i) { return i.irradiance != nullptr; }, false,
       irradiance},
      {"relight", "stress", [](const Implementation& i) { return i.relight != nullptr; }, false, relight},
      {"project lat-long", "non-finite texels",
       [](const Implementation& i) { return i.project_lat_long != nullptr; }, false, image}};
}

}  // namespace plumbline::conformance
