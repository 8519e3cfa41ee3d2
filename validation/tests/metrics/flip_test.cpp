#include "validation/metrics/flip.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "reference/base/error.hpp"

namespace plumbline::metrics {
namespace {

using image::Image;
using image::make_image;

constexpr double kPixelsPerDegree = 67.0206;

// ---------------------------------------------------------------- FLIP once more, slow and from the
// definitions

struct Colour {
  double x, y, z;
};

Colour relative_xyz(const Rgb& c) {
  const double r = c.x;
  const double g = c.y;
  const double b = c.z;
  return {(10135552 * r + 8788810 * g + 4435075 * b) / (10135552 + 8788810 + 4435075),
          (2613072 * r + 8788810 * g + 887015 * b) / (2613072 + 8788810 + 887015),
          (1425312 * r + 8788810 * g + 70074185 * b) / (1425312 + 8788810 + 70074185)};
}

Colour hunt_lab(const Colour& xyz) {
  const auto f = [](double t) {
    return t > 216.0 / 24389.0 ? std::pow(t, 1.0 / 3.0) : (24389.0 / 27.0 * t + 16.0) / 116.0;
  };
  const double lightness = 116.0 * f(xyz.y) - 16.0;
  return {lightness, 5.0 * lightness * (f(xyz.x) - f(xyz.y)), 2.0 * lightness * (f(xyz.y) - f(xyz.z))};
}

double distance(const Colour& a, const Colour& b) {
  return std::abs(a.x - b.x) + std::sqrt((a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z));
}

double redistributed(double hyab) {
  const double maximum = std::pow(
      distance(hunt_lab(relative_xyz({0.0F, 1.0F, 0.0F})), hunt_lab(relative_xyz({0.0F, 0.0F, 1.0F}))), 0.7);
  const double value = std::pow(hyab, 0.7);
  return value < 0.4 * maximum ? 0.95 / 0.4 * value / maximum : 0.95 + 0.05 * (value / maximum - 0.4) / 0.6;
}

double constant_pair(const Rgb& a, const Rgb& b) {
  return redistributed(distance(hunt_lab(relative_xyz(a)), hunt_lab(relative_xyz(b))));
}

using Grid = std::function<double(int x, int y)>;

// Direct two-dimensional sum; the grid clamps to its own border. Positive and negative weights are normalised
// apart.
double filtered(const Grid& grid, int cx, int cy, int radius, const Grid& weight) {
  double positive = 0.0;
  double negative = 0.0;
  double positive_sum = 0.0;
  double negative_sum = 0.0;
  for (int y = -radius; y <= radius; ++y) {
    for (int x = -radius; x <= radius; ++x) {
      const double w = weight(x, y);
      (w > 0.0 ? positive : negative) += std::abs(w);
      (w > 0.0 ? positive_sum : negative_sum) += w * grid(cx + x, cy + y);
    }
  }
  return positive_sum / positive + (negative > 0.0 ? negative_sum / negative : 0.0);
}

struct Slow {
  const Image& image;

  [[nodiscard]] Colour ycxcz(int x, int y) const {
    const Colour c =
        relative_xyz(image.at(std::clamp(x, 0, image.width - 1), std::clamp(y, 0, image.height - 1)));
    return {116.0 * c.y - 16.0, 500.0 * (c.x - c.y), 200.0 * (c.y - c.z)};
  }

  [[nodiscard]] double feature(int x, int y, bool is_edge) const {
    const double s = 0.5 * 0.082 * kPixelsPerDegree;
    const Grid gray = [this](int i, int j) { return (ycxcz(i, j).x + 16.0) / 116.0; };
    const Grid across = [s, is_edge](int i, int j) {
      const double g = std::exp(-(i * i + j * j) / (2.0 * s * s));
      return is_edge ? -i * g : (i * i / (s * s) - 1.0) * g;
    };
    const Grid down = [&across](int i, int j) { return across(j, i); };
    const int radius = static_cast<int>(std::ceil(3.0 * s));
    return std::hypot(filtered(gray, x, y, radius, across), filtered(gray, x, y, radius, down));
  }

  [[nodiscard]] Colour seen(int x, int y) const {
    const int radius =
        static_cast<int>(std::ceil(3.0 * std::sqrt(0.04 / (2.0 * kPi * kPi)) * kPixelsPerDegree));
    const auto channel = [&](double Colour::*member, double a1, double b1, double a2, double b2) {
      const Grid weight = [=](int i, int j) {
        const double r2 = (i * i + j * j) / (kPixelsPerDegree * kPixelsPerDegree);
        return a1 * std::sqrt(kPi / b1) * std::exp(-kPi * kPi * r2 / b1) +
               a2 * std::sqrt(kPi / b2) * std::exp(-kPi * kPi * r2 / b2);
      };
      return filtered([&](int i, int j) { return ycxcz(i, j).*member; }, x, y, radius, weight);
    };
    const double luma = (channel(&Colour::x, 1.0, 0.0047, 0.0, 1e-5) + 16.0) / 116.0;
    const double cx = channel(&Colour::y, 1.0, 0.0053, 0.0, 1e-5) / 500.0;
    const double cz = channel(&Colour::z, 34.1, 0.04, 13.5, 0.025) / 200.0;
    return hunt_lab(relative_xyz(in_gamut({luma + cx, luma, luma - cz})));
  }

  // Back to RGB by the published inverse matrix and white, clamped.
  static Rgb in_gamut(const Colour& relative) {
    const double x = 0.950428545 * relative.x;
    const double y = relative.y;
    const double z = 1.088900371 * relative.z;
    const auto unit = [](double v) { return static_cast<float>(std::clamp(v, 0.0, 1.0)); };
    return {unit(3.241003275 * x - 1.537398934 * y - 0.498615861 * z),
            unit(-0.969224334 * x + 1.875930071 * y + 0.041554224 * z),
            unit(0.055639423 * x - 0.204011202 * y + 1.057148933 * z)};
  }
};

double slow_flip(const Image& a, const Image& b, int x, int y) {
  const Slow first{a};
  const Slow second{b};
  const double colour = redistributed(distance(first.seen(x, y), second.seen(x, y)));
  const double edge = std::abs(first.feature(x, y, true) - second.feature(x, y, true));
  const double point = std::abs(first.feature(x, y, false) - second.feature(x, y, false));
  return std::pow(colour, 1.0 - std::sqrt(std::max(edge, point) / std::sqrt(2.0)));
}

// ---------------------------------------------------------------- images

Image random_image(int width, int height, unsigned seed) {
  std::mt19937 generator(seed);
  const auto next = [&] { return static_cast<float>(generator() >> 8U) * 0x1p-24F; };
  Image image = make_image(width, height);
  for (Rgb& pixel : image.pixels) {
    pixel.x = next();
    pixel.y = next();
    pixel.z = next();
  }
  return image;
}

Image step_image(int width, int height, const Rgb& left, const Rgb& right) {
  Image image = make_image(width, height, left);
  for (int y = 0; y < height; ++y) {
    for (int x = width / 2; x < width; ++x) image.at(x, y) = right;
  }
  return image;
}

// A square root of the feature difference (q_f) stands between float storage and the result: sqrt(2^-24)
// = 2.4e-4, times |ln colour| colour <= 1 / e.
constexpr double kFloatTolerance = 2e-4;

// ---------------------------------------------------------------- tests

TEST(Flip, IsZeroForEqualImages) {
  const Image image = random_image(31, 23, 1);
  for (const float value : flip(image, image)) EXPECT_EQ(value, 0.0F);
  EXPECT_TRUE(flip(Image{}, Image{}).empty());
}

TEST(Flip, OfConstantImagesIsTheRedistributedColourDistance) {
  const Rgb black(0.0F);
  const Rgb white(1.0F);
  const Rgb red(1.0F, 0.0F, 0.0F);
  const Rgb green(0.0F, 1.0F, 0.0F);
  const Rgb blue(0.0F, 0.0F, 1.0F);
  const std::pair<Rgb, Rgb> pairs[] = {{black, white},
                                       {red, green},
                                       {red, blue},
                                       {Rgb(0.2F), Rgb(0.3F)},
                                       {Rgb(0.001F), Rgb(0.002F)},
                                       {Rgb(0.9F, 0.5F, 0.1F), Rgb(0.8F, 0.5F, 0.1F)}};
  for (const auto& [a, b] : pairs) {
    for (const float value : flip(make_image(5, 4, a), make_image(5, 4, b))) {
      // Planes hold floats near 1; L* has slope 903 at black, and its power 0.7 at most 50 times the relative
      // error.
      EXPECT_LE(std::abs(value - constant_pair(a, b)), 1e-5) << a.x << a.y << a.z << " " << b.x << b.y << b.z;
    }
  }
}

TEST(Flip, OfBlackAndWhiteIsDoneByHand) {
  // HyAB is 100: L* is 0 and 100, no chroma. The largest distance is green's to blue's, whose L*a*b* under
  // D65 are (87.735, -86.183, 83.180) and (32.297, 79.188, -107.860), a* and b* still to be scaled by L* /
  // 100.
  const double largest =
      87.735 - 32.297 + std::hypot(0.87735 * 86.183 + 0.32297 * 79.188, 0.87735 * 83.180 + 0.32297 * 107.860);
  const double expected = 0.95 + 0.05 * (std::pow(100.0 / largest, 0.7) - 0.4) / 0.6;
  EXPECT_LE(std::abs(flip(make_image(1, 1), make_image(1, 1, Rgb(1.0F)))[0] - expected), 1e-5);
}

TEST(Flip, OfGreenAndBlueIsTheMaximum) {
  const Rgb green(0.0F, 1.0F, 0.0F);
  const Rgb blue(0.0F, 0.0F, 1.0F);
  EXPECT_LE(std::abs(flip(make_image(3, 3, green), make_image(3, 3, blue))[4] - 1.0F), 1e-6F);
}

TEST(Flip, NoTwoColoursAreFurtherApartThanGreenAndBlue) {
  // All pairs of colours on a 6 x 6 x 6 grid over the cube, its corners included.
  std::vector<Rgb> colours;
  for (int i = 0; i < 216; ++i) {
    colours.push_back(
        Rgb(static_cast<float>(i % 6), static_cast<float>(i / 6 % 6), static_cast<float>(i / 36)) / 5.0F);
  }
  double largest = 0.0;
  for (const Rgb& a : colours) {
    for (const Rgb& b : colours) largest = std::max(largest, constant_pair(a, b));
  }
  EXPECT_LE(std::abs(largest - 1.0), 1e-12);
}

TEST(Flip, AtAStepEdgeFollowsFromTheWeightsOnOneSide) {
  // Black left of the edge and white right of it, against black. At the last black column all weights at i >=
  // 1 see white: an edge response of exactly 1 (all weights of one sign), and a brightness that is the blur's
  // share there.
  const Image edge = step_image(64, 48, Rgb(0.0F), Rgb(1.0F));
  const std::vector<float> found = flip(make_image(64, 48), edge, kPixelsPerDegree);
  double above = 0.0;
  double all = 0.0;
  for (int i = -10; i <= 10; ++i) {
    const double w = std::exp(-kPi * kPi * i * i / (0.0047 * kPixelsPerDegree * kPixelsPerDegree));
    all += w;
    if (i >= 1) above += w;
  }
  const double lightness = 116.0 * std::cbrt(above / all) - 16.0;
  const double expected = std::pow(redistributed(lightness), 1.0 - std::sqrt(1.0 / std::sqrt(2.0)));
  EXPECT_LE(std::abs(found[24 * 64 + 31] - expected), kFloatTolerance);
  EXPECT_LE(found[24 * 64 + 0], 1e-6F);  // far from the edge: both black
}

TEST(Flip, MatchesDirectTwoDimensionalFilters) {
  const Image noise = random_image(26, 21, 3);
  Image smooth = make_image(26, 21);
  for (int y = 0; y < 21; ++y) {
    for (int x = 0; x < 26; ++x) {
      smooth.at(x, y) = {static_cast<float>(x) / 26.0F, static_cast<float>(y) / 21.0F,
                         0.5F + 0.5F * std::sin(0.4F * static_cast<float>(x + y))};
    }
  }
  const Image step = step_image(26, 21, {0.1F, 0.6F, 0.2F}, {0.9F, 0.3F, 0.7F});
  // Channels blur by different widths: next to this edge the blurred colours leave the RGB cube and are
  // clamped.
  const Image saturated = step_image(26, 21, {0.0F, 0.0F, 1.0F}, {1.0F, 1.0F, 0.0F});
  using Pair = std::pair<const Image*, const Image*>;
  for (const auto& [a, b] :
       {Pair{&noise, &smooth}, Pair{&step, &smooth}, Pair{&noise, &step}, Pair{&saturated, &smooth}}) {
    const std::vector<float> fast = flip(*a, *b, kPixelsPerDegree);
    for (const auto& [x, y] :
         {std::pair{0, 0}, {25, 20}, {12, 10}, {13, 10}, {1, 19}, {20, 3}, {7, 14}, {25, 0}}) {
      const double expected = slow_flip(*a, *b, x, y);
      EXPECT_GE(expected, 0.01);  // the comparison says something
      EXPECT_LE(std::abs(fast[static_cast<std::size_t>(y * 26 + x)] - expected), kFloatTolerance)
          << x << " " << y;
    }
  }
}

TEST(Flip, OfALargeImageIsThatOfItsParts) {
  // The threaded path, and locality: the widest filter reaches 10 pixels.
  const Image a = random_image(280, 250, 20);
  const Image b = random_image(280, 250, 21);
  const auto part = [](const Image& whole) {
    Image cut = make_image(40, 40);
    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 40; ++x) cut.at(x, y) = whole.at(x + 100, y + 90);
    }
    return cut;
  };
  const std::vector<float> whole = flip(a, b);
  const std::vector<float> cut = flip(part(a), part(b));
  for (std::size_t y = 10; y < 30; ++y) {
    for (std::size_t x = 10; x < 30; ++x) EXPECT_EQ(cut[y * 40 + x], whole[(y + 90) * 280 + x + 100]);
  }
}

TEST(Flip, StaysInUnitRangeAndIsSymmetric) {
  for (unsigned seed = 4; seed < 8; ++seed) {
    Image a = random_image(40, 30, seed);
    const Image b = random_image(40, 30, seed + 100);
    if (seed % 2 == 0) {  // extremes: only 0 and 1
      for (Rgb& pixel : a.pixels) pixel = glm::step(Rgb(0.5F), pixel);
    }
    const std::vector<float> forward = flip(a, b);
    EXPECT_EQ(forward, flip(b, a));  // every step is |a - b| or (a - b)^2
    for (const float value : forward) {
      EXPECT_GE(value, 0.0F);
      EXPECT_LE(value, 1.0F);
    }
  }
}

TEST(Flip, SeesLessFromFartherAway) {
  // A one-pixel checkerboard against its mean: at twice the pixels per degree it is blurred away further.
  Image checkers = make_image(48, 48, Rgb(0.4F));
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 48; ++x) {
      if ((x + y) % 2 == 0) checkers.at(x, y) = Rgb(0.6F);
    }
  }
  const Image gray = make_image(48, 48, Rgb(0.5F));
  const std::size_t centre = 24 * 48 + 24;
  const float near = flip(checkers, gray, 20.0)[centre];
  const float far = flip(checkers, gray, 80.0)[centre];
  EXPECT_GE(near, 0.05F);
  EXPECT_LE(far, 0.1F * near);
}

TEST(Flip, RefusesWhatIsNoDisplayableImage) {
  const Image gray = make_image(4, 4, Rgb(0.5F));
  for (const float bad : {-0.01F, 1.01F, std::numeric_limits<float>::quiet_NaN()}) {
    Image broken = gray;
    broken.at(2, 1).y = bad;
    EXPECT_THROW((void)flip(gray, broken), InputError) << bad;
    EXPECT_THROW((void)flip(broken, gray), InputError) << bad;
  }
  EXPECT_THROW((void)flip(gray, make_image(4, 5)), InputError);
  EXPECT_THROW((void)flip(gray, gray, 0.0), InputError);
}

}  // namespace
}  // namespace plumbline::metrics
