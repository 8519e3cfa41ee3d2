#include "validation/conformance/diagnosis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "prt/sh/zonal.hpp"
#include "validation/conformance/truths.hpp"

namespace plumbline::conformance {
namespace {

using Vector = std::vector<double>;

/// The cause given when `change` is done to vectors of 4 bands without structure.
std::string cause_of(const std::function<void(Vector&)>& change) {
  Evidence e{4, {}, {}};
  for (unsigned seed = 0; seed < 4; ++seed) {
    e.expected.push_back(truths::some_values(16, seed));
    e.measured.push_back(e.expected.back());
    change(e.measured.back());
  }
  return diagnose(e);
}

template <class Factor>
std::string cause_of_bands(const Factor& factor) {
  return cause_of([&](Vector& v) {
    for (int l = 0; l < 4; ++l)
      for (int i = l * l; i < (l + 1) * (l + 1); ++i) v[static_cast<std::size_t>(i)] *= factor(l);
  });
}

TEST(Diagnosis, NamesOneFactorOnEverything) {
  EXPECT_EQ(cause_of_bands([](int) { return kPi; }),
            "all values are pi times too large (1/pi is missing, or E where E/pi is asked)");
  EXPECT_EQ(cause_of_bands([](int) { return 1.0 / (4.0 * kPi); }),
            "all values are 4 pi times too small (a sum divided by the number of samples without 4 pi)");
  EXPECT_EQ(cause_of_bands([](int) { return 1.27; }), "all values are 1.27 times too large");
}

TEST(Diagnosis, NamesOneCoefficient) {
  EXPECT_EQ(cause_of([](Vector& v) { v[11] *= std::sqrt(2.0); }),
            "band 3, m = -1 is sqrt(2) times too large");
  EXPECT_EQ(cause_of([](Vector& v) { v[6] = 0.0; }), "band 2, m = 0 is missing");
  EXPECT_EQ(cause_of([](Vector& v) { std::swap(v[4], v[5]); }),
            "band 2, m = -2 holds band 2, m = -1; band 2, m = -1 holds band 2, m = -2");
}

TEST(Diagnosis, NamesSignsAndOrder) {
  EXPECT_NE(cause_of([](Vector& v) {
              for (const std::size_t i : {1U, 3U, 5U, 7U, 9U, 11U, 13U, 15U}) v[i] = -v[i];
            }).find("Condon-Shortley"),
            std::string::npos);
  EXPECT_EQ(cause_of_bands([](int l) { return l % 2 == 0 ? 1.0 : -1.0; }),
            "odd bands are negated: the direction is reversed");
  EXPECT_NE(cause_of([](Vector& v) {
              std::rotate(v.begin() + 1, v.begin() + 3, v.begin() + 4);
            }).find("order x, y, z"),
            std::string::npos);
}

TEST(Diagnosis, NamesPremultiplicationAndWindows) {
  EXPECT_NE(cause_of_bands([](int l) {
              return sh::clamped_cosine_factor(l) / kPi;
            }).find("those of irradiance / pi"),
            std::string::npos);
  EXPECT_NE(cause_of_bands([](int l) { return sh::clamped_cosine_factor(l); }).find("those of irradiance:"),
            std::string::npos);
  EXPECT_EQ(cause_of_bands([](int l) { return 1.0 / (1.0 + 0.005 * l * l * (l + 1.0) * (l + 1.0)); }),
            "windowed: factors 1/(1 + 0.005 l^2 (l + 1)^2)");
  EXPECT_EQ(cause_of_bands([](int l) { return 0.5 * (1.0 + std::cos(kPi * l / 4.0)); }),
            "windowed: Hann factors");
}

TEST(Diagnosis, NamesSwappedAxes) {
  const std::string cause = cause_of([](Vector& v) {
    const Vector f = v;
    v = truths::projected(
        4,
        [&](const Vec3d& w) {
          return truths::value(f, {w.x, w.z, w.y});
        },
        4);
  });
  EXPECT_NE(cause.find("axes are swapped"), std::string::npos) << cause;
}

TEST(Diagnosis, SaysWhereTheNumbersAreNone) {
  const std::string cause = cause_of([](Vector& v) { v[7] = std::nan(""); });
  EXPECT_NE(cause.find("not finite"), std::string::npos);
  EXPECT_NE(cause.find("band 2, m = 1"), std::string::npos);
  EXPECT_EQ(cause_of([](Vector& v) { std::fill(v.begin(), v.end(), 0.0); }), "everything is 0");
}

TEST(Diagnosis, CallsASmallErrorSmall) {
  EXPECT_TRUE(
      cause_of([](Vector& v) { v[3] += 1e-9; }).starts_with("a small error, largest error at band 1, m = 1"));
}

TEST(Diagnosis, NeverClaimsACauseThatDoesNotExplainTheNumbers) {
  const std::string cause = cause_of([](Vector& v) {
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = std::sin(100.0 * v[i] + static_cast<double>(i));
  });
  EXPECT_TRUE(cause.starts_with("largest error at")) << cause;
}

}  // namespace
}  // namespace plumbline::conformance
