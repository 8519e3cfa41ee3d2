#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>

#include "validation/checks/sh_checks.hpp"
#include "validation/conformance/check.hpp"
#include "validation/conformance/diagnosis.hpp"
#include "validation/conformance/truths.hpp"

namespace plumbline::conformance {
namespace {

constexpr const char* kRotate = "rotate";
constexpr const char* kZonal = "rotate zonal";

std::size_t size_of(int bands) {
  return static_cast<std::size_t>(bands) * static_cast<std::size_t>(bands);
}

Values other_sign(Values v) {
  for (std::size_t i = 0; i < v.size(); ++i) {
    const int l = static_cast<int>(std::sqrt(static_cast<double>(i) + 0.5));
    if ((static_cast<int>(i) - l * (l + 1)) % 2 != 0) v[i] = -v[i];
  }
  return v;
}

glm::dmat3 about_z(double angle) {
  return glm::dmat3(glm::rotate(glm::dmat4(1.0), angle, Vec3d(0, 0, 1)));
}

/// R = Rz(a) Ry(b) Rz(c) with the factors in the other order.
glm::dmat3 reversed_euler(const glm::dmat3& r) {
  const double beta = std::acos(glm::clamp(r[2][2], -1.0, 1.0));
  const double alpha = std::atan2(r[2][1], r[2][0]);
  const double gamma = std::atan2(r[1][2], -r[0][2]);
  const glm::dmat3 about_y(glm::rotate(glm::dmat4(1.0), beta, Vec3d(0, 1, 0)));
  return about_z(gamma) * about_y * about_z(alpha);
}

struct Hypothesis {
  const char* cause;
  std::function<Values(int, const Values&, const glm::dmat3&)> rotate;
};

std::vector<Hypothesis> hypotheses() {
  using truths::rotated;
  return {
      {"does not rotate", [](int, const Values& c, const glm::dmat3&) { return c; }},
      {"rotation is transposed: turns the other way",
       [](int n, const Values& c, const glm::dmat3& r) { return rotated(n, c, glm::transpose(r)); }},
      {"rotation is right for the other sign convention (Condon-Shortley phase)",
       [](int n, const Values& c, const glm::dmat3& r) { return other_sign(rotated(n, other_sign(c), r)); }},
      {"rotation is transposed and for the other sign convention",
       [](int n, const Values& c, const glm::dmat3& r) {
         return other_sign(rotated(n, other_sign(c), glm::transpose(r)));
       }},
      {"order of composition: Rz(alpha) Ry(beta) Rz(gamma) applied in the reverse order",
       [](int n, const Values& c, const glm::dmat3& r) { return rotated(n, c, reversed_euler(r)); }},
  };
}

/// The hypothesis that explains all answers; else what diagnose() says.
std::string rotation_cause(int bands, const std::vector<Values>& in, const std::vector<glm::dmat3>& rotations,
                           const Pairs& pairs) {
  for (const Hypothesis& hypothesis : hypotheses()) {
    bool fits = true;
    for (std::size_t k = 0; k < in.size() && fits; ++k) {
      Pairs one;
      one.add(hypothesis.rotate(bands, in[k], rotations[k]), pairs.measured[k]);
      fits = one.error(right_ruler()) <= 1e-4 * std::max(1.0, one.scale());
    }
    if (fits) return hypothesis.cause;
  }
  return diagnose({bands, pairs.expected, pairs.measured, 1e-4});
}

std::vector<Judged> matrices(const Context& context) {
  const int bands = context.bands;
  Pairs pairs;
  std::vector<Values> inputs;
  const std::vector<glm::dmat3> rotations = truths::rotations();
  for (std::size_t k = 0; k < rotations.size(); ++k) {
    inputs.push_back(truths::some_values(size_of(bands), static_cast<unsigned>(k)));
    pairs.add(truths::rotated(bands, inputs.back(), rotations[k]),
              must(context.subject.rotate(bands, rotations[k], inputs.back()), "a rotation"));
  }
  const double bound = 4.0 * pairs.scale() * rounding(context, bands);
  const double error = pairs.error(context.ruler);
  const std::string cause =
      context.ruler.accepts(error, bound) ? "" : rotation_cause(bands, inputs, rotations, pairs);
  return {judged(context,
                 {kRotate, "13 rotations, the bad ones too", "Projected anew by exact quadrature", bands},
                 error, bound, cause)};
}

std::vector<Judged> composition(const Context& context) {
  const int bands = context.bands;
  Pairs pairs;
  Pairs reversed;
  const std::vector<glm::dmat3> rotations = truths::rotations();
  const Values in = truths::some_values(size_of(bands), 77);
  for (std::size_t k = 1; k < rotations.size(); ++k) {
    const glm::dmat3& a = rotations[k - 1];
    const glm::dmat3& b = rotations[k];
    const Values once = must(context.subject.rotate(bands, a, in), "a rotation");
    const Values twice = must(context.subject.rotate(bands, b, once), "a rotation");
    pairs.add(must(context.subject.rotate(bands, b * a, in), "a product of rotations"), twice);
    reversed.add(must(context.subject.rotate(bands, a * b, in), "a product of rotations"), twice);
  }
  const double bound = 8.0 * pairs.scale() * rounding(context, bands);
  const bool is_reversed = reversed.error(right_ruler()) <= bound;
  return {judged(context,
                 {kRotate, "R(b) R(a) = R(b a)", "Group property; rounding of three rotations", bands},
                 pairs.error(context.ruler), bound,
                 is_reversed ? "order of composition is reversed: R(b) R(a) gives R(a b)"
                             : "two rotations in a row are not the rotation by the product")};
}

/// Needs no convention: the implementation's own basis is turned by the implementation's own rotation.
std::vector<Judged> own_basis(const Context& context) {
  const int bands = context.bands;
  Pairs pairs;
  const Values in = truths::some_values(size_of(bands), 5);
  const auto value = [&](const Values& c, const Vec3d& d) {
    const Values y = must(context.subject.basis(bands, {d}), "a direction");
    double sum = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) sum += y[i] * c[i];
    return sum;
  };
  for (const glm::dmat3& r : truths::rotations()) {
    const Values turned = must(context.subject.rotate(bands, r, in), "a rotation");
    Values right;
    Values answer;
    for (const Vec3d& d : checks::probe_directions()) {
      right.push_back(value(in, glm::transpose(r) * d));
      answer.push_back(value(turned, d));
    }
    pairs.add(right, answer);
  }
  const double bound = 8.0 * bands * bands * rounding(context, bands);
  return {judged(
      context,
      {kRotate, "fits its own basis", "f(R^-1 w) with the implementation's functions; rounding", bands},
      pairs.error(context.ruler), bound,
      "rotation and basis do not belong together (signs, axes, or direction of turning)")};
}

std::vector<Judged> energy(const Context& context) {
  const int bands = context.bands;
  Pairs pairs;
  const Values in = truths::some_values(size_of(bands), 11);
  const auto energies = [&](const Values& c) {
    Values result(static_cast<std::size_t>(bands), 0.0);
    for (std::size_t l = 0; l < result.size(); ++l)
      for (std::size_t i = l * l; i < (l + 1) * (l + 1); ++i) result[l] += c[i] * c[i];
    return result;
  };
  for (const glm::dmat3& r : truths::rotations())
    pairs.add(energies(in), energies(must(context.subject.rotate(bands, r, in), "a rotation")));
  const double bound = 8.0 * pairs.scale() * rounding(context, bands);
  return {judged_values(context, {kRotate, "energy of each band", "Orthogonality; rounding", bands}, pairs,
                        bound, 1e-4)};
}

std::vector<Judged> zonal(const Context& context) {
  const int bands = context.bands;
  Pairs pairs;
  const Values z = truths::some_values(static_cast<std::size_t>(bands), 2);
  const std::vector<Vec3d> directions = checks::probe_directions();
  for (const Vec3d& d : directions)
    pairs.add(truths::about_axis(z, d), must(context.subject.rotate_zonal(bands, z, d), "a unit axis"));
  return {judged_directions(
      context, {kZonal, "random lobes about every axis", "sqrt(4 pi/(2l + 1)) z_l y_lm; rounding", bands},
      directions, pairs, 8.0 * rounding(context, bands), 1e-5)};
}

bool has_rotate(const Implementation& i) {
  return i.rotate != nullptr;
}
bool has_rotate_and_basis(const Implementation& i) {
  return i.rotate != nullptr && i.evaluate_basis != nullptr;
}
bool has_zonal(const Implementation& i) {
  return i.rotate_zonal != nullptr;
}

}  // namespace

std::vector<Check> rotation_checks() {
  return {{kRotate, "13 rotations, the bad ones too", has_rotate, true, matrices},
          {kRotate, "R(b) R(a) = R(b a)", has_rotate, false, composition},
          {kRotate, "fits its own basis", has_rotate_and_basis, false, own_basis},
          {kRotate, "energy of each band", has_rotate, false, energy},
          {kZonal, "random lobes about every axis", has_zonal, true, zonal}};
}

}  // namespace plumbline::conformance
