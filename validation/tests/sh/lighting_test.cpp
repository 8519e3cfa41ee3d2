#include "prt/sh/lighting.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "prt/sh/zonal.hpp"
#include "reference/base/error.hpp"
#include "validation/tests/sh/oracle.hpp"

namespace plumbline::sh {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

ShRgb random_function(int bands, unsigned seed) {
  std::mt19937 bits(seed);
  const auto uniform = [&bits] { return static_cast<double>(bits()) / 2147483648.0 - 1.0; };
  ShRgb result{bands, {}};
  for (int i = 0; i < coefficient_count(bands); ++i) {
    const double r = uniform();
    const double g = uniform();
    result.coefficients.emplace_back(r, g, uniform());
  }
  return result;
}

double largest(const RgbD& c) {
  return std::max({std::abs(c.r), std::abs(c.g), std::abs(c.b)});
}

// ---------------------------------------------------------------- evaluation

TEST(ShLighting, EvaluatesTheSumOfItsFunctions) {
  const ShRgb function = random_function(25, 1);  // more than fits on the evaluator's stack
  for (const Vec3d& d : sh_test::directions(5, 2)) {
    const std::vector<double> y = evaluate_basis(25, d);
    RgbD expected(0.0);
    for (std::size_t i = 0; i < y.size(); ++i) expected += y[i] * function.coefficients[i];
    EXPECT_LE(largest(evaluate(function, d) - expected), 1e-13);
  }
}

TEST(ShLighting, RefusesCoefficientsThatDoNotFitTheBands) {
  const ShRgb short_one{3, std::vector<RgbD>(8, RgbD(0.0))};
  const Vec3d up(0.0, 0.0, 1.0);
  EXPECT_THROW(static_cast<void>(evaluate(short_one, up)), InputError);
  EXPECT_THROW(static_cast<void>(windowed(short_one, Window::hann)), InputError);
  EXPECT_THROW(static_cast<void>(band_limited_environment(short_one, "x")), InputError);
  EXPECT_THROW(static_cast<void>(to_json(short_one)), InputError);
}

// ---------------------------------------------------------------- windows

constexpr std::array kWindows{Window::none, Window::hann, Window::lanczos, Window::gauss, Window::laplacian};

TEST(ShWindow, LeavesTheMeanAlone) {
  for (const Window window : kWindows) {
    for (const int bands : {1, 3, 10}) EXPECT_EQ(window_factor(window, 0, bands, 0.01), 1.0);
  }
}

TEST(ShWindow, FallsWithTheDegree) {
  for (const Window window : {Window::hann, Window::lanczos, Window::gauss, Window::laplacian}) {
    for (int l = 1; l < 6; ++l) {
      EXPECT_LT(window_factor(window, l, 6, 0.01), window_factor(window, l - 1, 6, 0.01)) << l;
      EXPECT_GT(window_factor(window, l, 6, 0.01), 0.0) << l;
    }
  }
}

TEST(ShWindow, HasTheStatedFormulas) {
  EXPECT_EQ(window_factor(Window::none, 2, 4, 0.0), 1.0);
  EXPECT_LE(std::abs(window_factor(Window::hann, 2, 4, 0.0) - 0.5), 1e-16);
  EXPECT_LE(std::abs(window_factor(Window::lanczos, 2, 4, 0.0) - 2.0 / kPi), 2e-16);
  EXPECT_LE(std::abs(window_factor(Window::gauss, 2, 4, 0.0) - std::exp(-kPi * kPi / 8.0)), 1e-16);
  EXPECT_LE(std::abs(window_factor(Window::laplacian, 2, 4, 0.25) - 0.1), 1e-16);
  for (int l = 0; l < 5; ++l) EXPECT_EQ(window_factor(Window::laplacian, l, 5, 0.0), 1.0);
}

TEST(ShWindow, ScalesEachDegreeAndLowersTheEnergy) {
  const ShRgb function = random_function(5, 4);
  for (const Window window : kWindows) {
    const ShRgb result = windowed(function, window, 0.02);
    for (int l = 0; l < 5; ++l) {
      for (int m = -l; m <= l; ++m) {
        const auto i = static_cast<std::size_t>(index(l, m));
        const double factor = window_factor(window, l, 5, 0.02);
        EXPECT_EQ(result.coefficients[i], factor * function.coefficients[i]) << "l=" << l << " m=" << m;
      }
    }
  }
}

TEST(ShWindow, RefusesWhatIsOutOfRange) {
  EXPECT_THROW(static_cast<void>(window_factor(Window::hann, 3, 3, 0.0)), InputError);
  EXPECT_THROW(static_cast<void>(window_factor(Window::hann, -1, 3, 0.0)), InputError);
  EXPECT_THROW(static_cast<void>(window_factor(Window::hann, 0, 0, 0.0)), InputError);
  for (const double lambda : {-1.0, kInfinity, std::nan("")}) {
    EXPECT_THROW(static_cast<void>(window_factor(Window::laplacian, 1, 3, lambda)), InputError) << lambda;
  }
}

// ---------------------------------------------------------------- band-limited environments

TEST(BandLimitedEnvironment, HasTheFunctionsRadiance) {
  for (const int bands : {1, 3, 6, 21}) {
    const ShRgb function = random_function(bands, 5);
    const light::Environment environment = band_limited_environment(function, "test");
    EXPECT_EQ(environment.name, "test");
    for (const Vec3d& d : sh_test::directions(20, 6)) {
      const Vec3 direction(d);
      const RgbD expected = evaluate(function, glm::normalize(Vec3d(direction)));
      // The answer is rounded to float, and so is the direction on its way: its gradient is of size bands^2.
      const double tolerance = 6e-8 * (largest(expected) + bands * bands);
      EXPECT_LE(largest(RgbD(light::radiance(environment, direction)) - expected), tolerance) << bands;
    }
  }
}

TEST(BandLimitedEnvironment, KeepsNegativeRadiance) {
  const ShRgb function{2, {RgbD(0.0), RgbD(0.0), RgbD(1.0), RgbD(0.0)}};
  const light::Environment environment = band_limited_environment(function, "z");
  EXPECT_LT(light::radiance(environment, Vec3(0.0F, 0.0F, -1.0F)).r, -0.4F);
}

// Sky L(w) as coefficients written by hand, with our signs; E(n) = sum A_l L_lm y_lm(n) against the closed
// form.
double irradiance(const std::vector<double>& lighting, const Vec3d& n) {
  const std::vector<double> y = evaluate_basis(3, n);
  double sum = 0.0;
  for (int l = 0; l < 3; ++l) {
    for (int m = -l; m <= l; ++m) {
      const auto i = static_cast<std::size_t>(index(l, m));
      sum += clamped_cosine_factor(l) * lighting[i] * y[i];
    }
  }
  return sum;
}

TEST(ShIrradiance, IsExactForLinearSkies) {
  const double a = 2.0;
  const Vec3d b(0.5, -0.25, 0.75);
  const double k0 = std::sqrt(4.0 * kPi);
  const double k1 = std::sqrt(4.0 * kPi / 3.0);
  const std::vector<double> lighting{k0 * a, -k1 * b.y, k1 * b.z, -k1 * b.x, 0, 0, 0, 0, 0};
  for (const Vec3d& n : sh_test::directions(20, 8)) {
    EXPECT_LE(std::abs(irradiance(lighting, n) - (kPi * a + 2.0 * kPi / 3.0 * glm::dot(b, n))), 1e-14);
  }
}

TEST(ShIrradiance, IsExactForSquaresOfEachCoordinate) {
  const double c0 = std::sqrt(4.0 * kPi) / 3.0;
  const double c2 = 2.0 / 3.0 * std::sqrt(4.0 * kPi / 5.0);
  const double half = 0.5 * c2;
  const double root = 0.5 * std::sqrt(3.0) * c2;
  const std::vector<double> xx{c0, 0, 0, 0, 0, 0, -half, 0, root};
  const std::vector<double> yy{c0, 0, 0, 0, 0, 0, -half, 0, -root};
  const std::vector<double> zz{c0, 0, 0, 0, 0, 0, c2, 0, 0};
  for (const Vec3d& n : sh_test::directions(20, 9)) {
    EXPECT_LE(std::abs(irradiance(xx, n) - kPi / 4.0 * (1.0 + n.x * n.x)), 1e-14);
    EXPECT_LE(std::abs(irradiance(yy, n) - kPi / 4.0 * (1.0 + n.y * n.y)), 1e-14);
    EXPECT_LE(std::abs(irradiance(zz, n) - kPi / 4.0 * (1.0 + n.z * n.z)), 1e-14);
  }
  const Vec3d at_60_degrees(std::sqrt(0.75), 0.0, 0.5);
  EXPECT_LE(std::abs(irradiance(zz, at_60_degrees) - 0.981747704247), 5e-13);
}

// ---------------------------------------------------------------- coefficient files

class CoefficientFile : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("plumbline_coefficients_") + info->name() + "_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::filesystem::path write(const std::string& text) const {
    const std::filesystem::path path = folder_ / "c.json";
    std::ofstream(path) << text;
    return path;
  }
  /// The one-line message with which `text` is refused, or "" when it is read.
  [[nodiscard]] std::string refusal(const std::string& text) const {
    const std::filesystem::path path = write(text);
    try {
      static_cast<void>(read_coefficients(path));
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.rfind(path.string() + ": ", 0), 0U) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      return message;
    }
    return "";
  }
  /// Replaces the first `from` of a good two-band file by `to`.
  [[nodiscard]] std::string broken(const std::string& from, const std::string& to) const {
    std::string text = to_json({2, std::vector<RgbD>(4, RgbD(0.5, 0.25, 0.125))});
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  }

  std::filesystem::path folder_;
};

TEST_F(CoefficientFile, GivesBackTheSameBits) {
  ShRgb function = random_function(6, 3);
  function.coefficients[3] = RgbD(1.0 / 3.0, -1e-300, 1e300);
  const ShRgb read = read_coefficients(write(to_json(function)));
  EXPECT_EQ(read.bands, function.bands);
  EXPECT_EQ(read.coefficients, function.coefficients);
}

TEST_F(CoefficientFile, HasTheStatedFields) {
  const auto json = nlohmann::json::parse(to_json(random_function(3, 1)));
  EXPECT_EQ(json.size(), 3U);
  EXPECT_EQ(json["bands"], 3);
  EXPECT_EQ(json["convention"], "orthonormal, Condon-Shortley, index l(l+1)+m, z-polar");
  EXPECT_EQ(json["coefficients"].size(), 9U);
  EXPECT_EQ(json["coefficients"][8].size(), 3U);
}

TEST_F(CoefficientFile, RefusesWhatItCannotUse) {
  EXPECT_EQ(refusal(broken("0.5", "0.75")), "");
  EXPECT_NE(refusal(""), "");
  EXPECT_NE(refusal("{\"bands\": 2,\n\n oops"), "");
  EXPECT_NE(refusal("[1, 2]"), "");
  for (const char* bands : {"3", "0", "-1", "1001", "2.5", "\"2\"", "null", "1e30", "99999999999999999999"}) {
    EXPECT_NE(refusal(broken("\"bands\": 2", std::string("\"bands\": ") + bands)), "") << bands;
  }
  EXPECT_NE(refusal(broken("\"bands\"", "\"band\"")), "");
  EXPECT_NE(refusal(broken("Condon-Shortley", "no Condon-Shortley")), "");
  EXPECT_NE(refusal(broken("\"convention\"", "\"conventions\"")), "");
  EXPECT_NE(refusal(broken("\"coefficients\"", "\"values\"")), "");
  for (const char* row : {"[0.5, 0.25]", "[0.5, 0.25, null]", "[0.5, 0.25, 1e999]", "[0.5, 0.25, 1, 2]",
                          "[0.5, 0.25, NaN]", "0.5", "[0.5, 0.25, \"1\"]"}) {
    EXPECT_NE(refusal(broken("[0.5, 0.25, 0.125]", row)), "") << row;
  }
}

TEST_F(CoefficientFile, RefusesAMissingFileByName) {
  const std::filesystem::path path = folder_ / "missing.json";
  try {
    static_cast<void>(read_coefficients(path));
    FAIL() << "read a missing file";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos);
  }
}

TEST_F(CoefficientFile, IsNeverWrittenWithNonFiniteNumbers) {
  ShRgb function = random_function(2, 1);
  function.coefficients[1].g = std::nan("");
  EXPECT_THROW(static_cast<void>(to_json(function)), InputError);
}

}  // namespace
}  // namespace plumbline::sh
