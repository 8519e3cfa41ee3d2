#include <fmt/format.h>

#include <array>
#include <cmath>

#include "validation/conformance/check.hpp"
#include "validation/conformance/diagnosis.hpp"
#include "validation/conformance/truths.hpp"

namespace plumbline::conformance {
namespace {

constexpr const char* kProduct = "multiply";
constexpr const char* kExp = "exponential";
constexpr const char* kLog = "logarithm";
constexpr double kWhite = 3.5449077018110318;  // sqrt(4 pi): coefficient of the constant 1

std::size_t size_of(int bands) {
  return static_cast<std::size_t>(bands) * static_cast<std::size_t>(bands);
}

std::string place_of(std::size_t index) {
  const int l = static_cast<int>(std::sqrt(static_cast<double>(index) + 0.5));
  return fmt::format("({}, {})", l, static_cast<int>(index) - l * (l + 1));
}

Values unit(int bands, std::size_t index) {
  Values result(size_of(bands), 0.0);
  result[index] = 1.0;
  return result;
}

double norm(const Values& v) {
  double sum = 0.0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

double distance(const Values& a, const Values& b) {
  Values difference(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) difference[i] = a[i] - b[i];
  return norm(difference);
}

/// Which products of two functions are wrong, as "(l, m) (l, m) -> (l, m)".
std::string entry_cause(const Pairs& pairs, const std::vector<std::array<std::size_t, 2>>& which,
                        double bound) {
  std::string text;
  int count = 0;
  for (std::size_t k = 0; k < which.size(); ++k) {
    for (std::size_t i = 0; i < pairs.expected[k].size(); ++i) {
      if (std::abs(pairs.expected[k][i] - pairs.measured[k][i]) <= bound) continue;
      if (++count > 3) continue;
      text += fmt::format("{}{} {} -> {} is {:.4g}, should be {:.4g}", text.empty() ? "" : "; ",
                          place_of(which[k][0]), place_of(which[k][1]), place_of(i), pairs.measured[k][i],
                          pairs.expected[k][i]);
    }
  }
  return fmt::format("{} wrong terms: {}", count, text);
}

std::vector<Judged> tensor(const Context& context) {
  const int bands = context.bands;
  const std::size_t few = size_of(std::min(3, bands));
  Pairs pairs;
  std::vector<std::array<std::size_t, 2>> which;
  for (std::size_t i = 0; i < few; ++i) {
    for (std::size_t j = 0; j < few; ++j) {
      pairs.add(truths::product(bands, unit(bands, i), unit(bands, j)),
                must(context.subject.multiply(bands, unit(bands, i), unit(bands, j)), "a product"));
      which.push_back({i, j});
    }
  }
  const double bound = 8.0 * rounding(context, bands);
  const double error = pairs.error(context.ruler);
  std::string cause;
  if (!context.ruler.accepts(error, bound)) {
    cause = diagnose({bands, pairs.expected, pairs.measured, 1e-5});
    if (cause.starts_with("largest") || cause.starts_with("band") || cause.starts_with("axes") ||
        cause.starts_with("no two"))
      cause = entry_cause(pairs, which, std::max(bound, 1e-5));
  }
  return {judged(context, {kProduct, "each pair of functions", "Exact quadrature of y y y; rounding", bands},
                 error, bound, cause)};
}

std::vector<Judged> products(const Context& context) {
  const int bands = context.bands;
  Pairs pairs;
  for (unsigned k = 0; k < 4; ++k) {
    const Values a = truths::some_values(size_of(bands), 2 * k);
    const Values b = truths::some_values(size_of(bands), 2 * k + 1);
    pairs.add(truths::product(bands, a, b), must(context.subject.multiply(bands, a, b), "a product"));
  }
  return {judged_coefficients(context,
                              {kProduct, "against quadrature", "Exact quadrature; n^4 rounded terms", bands},
                              pairs, 8.0 * bands * bands * rounding(context, bands), 1e-5)};
}

/// (a + b z)^2 in closed form: needs no quadrature.
std::vector<Judged> closed_square(const Context& context) {
  const int bands = context.bands;
  Values f(size_of(bands), 0.0);
  f[0] = kWhite;
  if (bands > 1) f[2] = std::sqrt(4.0 * kPi / 3.0);
  Values expected(size_of(bands), 0.0);
  expected[0] = kWhite * (bands > 1 ? 4.0 / 3.0 : 1.0);
  if (bands > 1) expected[2] = 2.0 * std::sqrt(4.0 * kPi / 3.0);
  if (bands > 2) expected[6] = 2.0 / 3.0 * std::sqrt(4.0 * kPi / 5.0);
  Pairs pairs;
  pairs.add(expected, must(context.subject.multiply(bands, f, f), "a square"));
  return {judged_coefficients(context, {kProduct, "(1 + z)^2", "Closed form; rounding", bands}, pairs,
                              8.0 * pairs.scale() * rounding(context, bands), 1e-5)};
}

// ---------------------------------------------------------------- exponential and logarithm
Values constant(int bands, double value) {
  Values result(size_of(bands), 0.0);
  result[0] = value * kWhite;
  return result;
}

/// A function without a mean, of this norm.
Values shape(int bands, double size, unsigned seed) {
  Values result = truths::some_values(size_of(bands), seed);
  result[0] = 0.0;
  if (bands == 1) return result;
  const double scale = size / norm(result);
  for (double& v : result) v *= scale;
  return result;
}

Values sum(Values a, const Values& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
  return a;
}

std::vector<Judged> exp_constants(const Context& context) {
  Pairs pairs;
  for (const double a : {0.0, 1.0, -1.0, 2.0, -3.0}) {
    Values expected = constant(context.bands, 1.0);  // relative to e^a
    Values measured =
        must(context.subject.exponential(context.bands, constant(context.bands, a)), "a constant");
    for (double& v : measured) v /= std::exp(a);
    pairs.add(expected, measured);
  }
  const double error = pairs.error(context.ruler);
  const double bound = 16.0 * kWhite * rounding(context, context.bands);
  std::string cause = diagnose({context.bands, pairs.expected, pairs.measured, 1e-6});
  // exp(s a) for exp(a): from the answers for a = 1 and -1.
  const double growth = std::log(pairs.measured[1][0] / pairs.measured[2][0]) / 2.0 + 1.0;
  if (std::isfinite(growth) && std::abs(growth - 1.0) > 1e-3)
    cause = fmt::format(
        "the constant part is exp({:.4g} a) for exp(a): c_00 is scaled by {:.4g} instead of 1/sqrt(4 pi)",
        growth, growth / kWhite);
  return {judged(context, {kExp, "constants", "exp(a) sqrt(4 pi); rounding", context.bands}, error, bound,
                 cause)};
}

/// exp(a + f), f small: the answer is known to first order whatever the method.
std::vector<Judged> exp_small(const Context& context) {
  Pairs pairs;
  const double size = 0.1;
  for (unsigned seed = 0; seed < 3; ++seed) {
    const Values f = shape(context.bands, size, seed);
    pairs.add(truths::composed(context.bands, f, [](double v) { return std::exp(v); }),
              must(context.subject.exponential(context.bands, f), "a small function"));
  }
  // The second order: half of the square, whose norm is at most |f|^2 max|y| n.
  return {judged_coefficients(
      context, {kExp, "small functions", "First order is exact: error <= |f|^2", context.bands}, pairs,
      size * size, 0.002)};
}

/// Error norm of an answer over the error norm of the first-order one.
double against_first_order(const Context& context, const Values& oracle, const Values& first_order,
                           const Values& answer) {
  double worst = 0.0;
  for (const double v : answer) worst = context.ruler.worse(worst, std::abs(v));
  if (!context.ruler.accepts(worst, HUGE_VAL)) return worst;
  return distance(answer, oracle) / distance(first_order, oracle);
}

std::vector<Judged> exp_shapes(const Context& context) {
  const int bands = context.bands;
  if (bands == 1) return {};  // nothing but a constant
  double worst = 0.0;
  std::string detail;
  for (const double size : {1.0, 2.0, 4.0}) {
    const Values f = shape(bands, size, 9);
    const Values in = sum(constant(bands, -1.0), f);
    const Values oracle = truths::composed(bands, in, [](double v) { return std::exp(v); });
    Values first = sum(constant(bands, 1.0), f);
    for (double& v : first) v *= std::exp(-1.0);
    const double ratio = against_first_order(context, oracle, first,
                                             must(context.subject.exponential(bands, in), "a function"));
    worst = context.ruler.worse(worst, ratio);
    detail += fmt::format(" {:.3g} at |f| = {:g};", ratio, size);
  }
  Judged result = judged(
      context, {kExp, "beats the first order", "Error over that of exp(a)(1 + f), |f| = 1, 2, 4", bands},
      worst, 0.9, "no better than exp(a)(1 + f): terms beyond the first are missing or wrong:" + detail);
  if (result.cause.empty()) result.finding.detail = "Error over that of exp(a)(1 + f):" + detail;
  return {result};
}

/// What exp does near its limit: finite, or a refusal.
std::vector<Judged> exp_large(const Context& context) {
  double unbounded = 0.0;
  for (const double size : {10.0, 50.0, 500.0}) {
    const Answer answer = context.subject.exponential(context.bands, shape(context.bands, size, 4));
    if (!answer) continue;
    for (const double v : *answer)
      if (std::isnan(v)) unbounded += 1.0;
  }
  return {judged(context, {kExp, "large functions", "Finite, infinite or refused, never NaN", context.bands},
                 unbounded, 0.0, "NaN for a large function")};
}

std::vector<Judged> log_constants(const Context& context) {
  Pairs pairs;
  for (const double a : {1.0, 2.0, 0.05}) {
    pairs.add(
        constant(context.bands, std::log(a)),
        must(context.subject.logarithm(context.bands, constant(context.bands, a)), "a positive constant"));
  }
  return {judged_coefficients(context, {kLog, "constants", "log(a) sqrt(4 pi); rounding", context.bands},
                              pairs, 16.0 * pairs.scale() * rounding(context, context.bands), 1e-6)};
}

std::vector<Judged> log_small(const Context& context) {
  Pairs pairs;
  const double size = 0.1;
  for (unsigned seed = 0; seed < 3; ++seed) {
    const Values f = sum(constant(context.bands, 1.0), shape(context.bands, size, seed));
    pairs.add(truths::composed(context.bands, f, [](double v) { return std::log(v); }),
              must(context.subject.logarithm(context.bands, f), "a positive function"));
  }
  return {judged_coefficients(
      context, {kLog, "nearly constant", "First order is exact: error <= |f|^2", context.bands}, pairs,
      size * size, 0.02)};
}

std::vector<Judged> log_shapes(const Context& context) {
  const int bands = context.bands;
  if (bands == 1) return {};
  double worst = 0.0;
  for (unsigned seed = 0; seed < 3; ++seed) {
    // Band-limited functions of norm 0.8 stay above 1 - 0.8 n / sqrt(4 pi): positive with a mean of 2.
    Values in = sum(constant(bands, 2.0), shape(bands, std::min(2.0, 4.5 / bands), seed));
    const Values oracle = truths::composed(bands, in, [](double v) { return std::log(v); });
    Values first = in;
    first[0] = std::log(2.0) * kWhite;
    for (std::size_t i = 1; i < first.size(); ++i) first[i] = in[i] / 2.0;
    worst = context.ruler.worse(
        worst, against_first_order(context, oracle, first,
                                   must(context.subject.logarithm(bands, in), "a positive function")));
  }
  return {judged(context, {kLog, "beats the first order", "Error over that of log(a) + f/a", bands}, worst,
                 0.9, fmt::format("no better than log(a) + f/a: {:.3g} of its error", worst))};
}

std::vector<Judged> log_negative(const Context& context) {
  const Values in = sum(constant(context.bands, 0.2), shape(context.bands, 3.0, 8));
  const Answer answer = context.subject.logarithm(context.bands, in);
  double bad = 0.0;
  for (const double v : answer.value_or(Values{})) bad += std::isnan(v) ? 1.0 : 0.0;
  return {judged(context,
                 {kLog, "functions that are not positive", "Clipped or refused, never NaN", context.bands},
                 bad, 0.0, "NaN for a function with values below 0")};
}

bool has_product(const Implementation& i) {
  return i.multiply != nullptr;
}
bool has_exp(const Implementation& i) {
  return i.exponential != nullptr;
}
bool has_log(const Implementation& i) {
  return i.logarithm != nullptr;
}

}  // namespace

std::vector<Check> product_checks() {
  return {{kProduct, "each pair of functions", has_product, true, tensor},
          {kProduct, "against quadrature", has_product, true, products},
          {kProduct, "(1 + z)^2", has_product, true, closed_square},
          {kExp, "constants", has_exp, true, exp_constants},
          {kExp, "small functions", has_exp, true, exp_small},
          {kExp, "beats the first order", has_exp, true, exp_shapes},
          {kExp, "large functions", has_exp, true, exp_large},
          {kLog, "constants", has_log, true, log_constants},
          {kLog, "nearly constant", has_log, true, log_small},
          {kLog, "beats the first order", has_log, true, log_shapes},
          {kLog, "functions that are not positive", has_log, true, log_negative}};
}

}  // namespace plumbline::conformance
