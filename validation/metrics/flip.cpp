// FLIP in four steps; the names and constants are those of the paper [1].
//   1. Contrast sensitivity: what the eye cannot resolve is blurred away, per opponent channel.
//   2. Colour: HyAB distance in Hunt-adjusted L*a*b*, raised to q_c and mapped to [0, 1].
//   3. Features: differences of edges (first derivative) and points (second derivative) of the unblurred
//   image.
//   4. Together: colour^(1 - feature).
// The paper filters Y C_x C_z = (116 y - 16, 500 (x - y), 200 (y - z)) with x, y, z = XYZ over the white.
// Filters whose weights add up to 1 commute with those factors and the offset, so that we filter (y, x - y, y
// - z). [1] Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator
// for
//     Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020.
#include "validation/metrics/flip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"

namespace plumbline::metrics {
namespace {

constexpr double kColourExponent = 0.7;         // q_c
constexpr double kFeatureExponent = 0.5;        // q_f
constexpr double kKneeOfMaximum = 0.4;          // p_c: this share of the largest distance ...
constexpr double kKneeValue = 0.95;             // p_t: ... is mapped to this value
constexpr double kFeatureWidthDegrees = 0.082;  // w

// ---------------------------------------------------------------- planes and separable filters

struct Plane {
  int width = 0;
  int height = 0;
  std::vector<float> values;

  [[nodiscard]] std::size_t row(int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
  }
};

Plane make_plane(int width, int height) {
  return {width, height,
          std::vector<float>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height))};
}

// Calls body(y) for every row. Starting threads costs more than it saves on small images.
template <typename Body>
void for_each_row(const Plane& plane, const Body& body) {
  constexpr std::size_t kFewPixels = 1 << 16;
  const int threads = plane.values.size() < kFewPixels ? 1 : 0;
  parallel_for(static_cast<std::size_t>(plane.height), threads, body);
}

using Kernel = std::vector<double>;  // 2 radius + 1 weights, the centre in the middle

int radius_of(const Kernel& kernel) {
  return static_cast<int>(kernel.size() / 2);
}

template <typename Weight>
Kernel make_kernel(int radius, const Weight& weight) {
  Kernel kernel;
  for (int i = -radius; i <= radius; ++i) kernel.push_back(weight(i));
  return kernel;
}

double sum(const Kernel& kernel) {
  double total = 0.0;
  for (const double weight : kernel) total += weight;
  return total;
}

// Positive weights add up to 1, negative ones to -1.
Kernel normalised(Kernel kernel) {
  double positive = 0.0;
  double negative = 0.0;
  for (const double weight : kernel) (weight > 0.0 ? positive : negative) += weight;
  for (double& weight : kernel) weight /= weight > 0.0 ? positive : (negative < 0.0 ? -negative : 1.0);
  return kernel;
}

Plane filter_rows(const Plane& plane, const Kernel& kernel) {
  Plane result = make_plane(plane.width, plane.height);
  const int radius = radius_of(kernel);
  for_each_row(plane, [&](std::size_t y) {
    const std::size_t start = plane.row(static_cast<int>(y));
    std::vector<double> padded;
    for (int x = -radius; x < plane.width + radius; ++x) {
      padded.push_back(plane.values[start + static_cast<std::size_t>(std::clamp(x, 0, plane.width - 1))]);
    }
    for (std::size_t x = 0; x < static_cast<std::size_t>(plane.width); ++x) {
      double value = 0.0;
      for (std::size_t tap = 0; tap < kernel.size(); ++tap) value += kernel[tap] * padded[x + tap];
      result.values[start + x] = static_cast<float>(value);
    }
  });
  return result;
}

Plane filter_columns(const Plane& plane, const Kernel& kernel) {
  Plane result = make_plane(plane.width, plane.height);
  const int radius = radius_of(kernel);
  for_each_row(plane, [&](std::size_t y) {
    const auto width = static_cast<std::size_t>(plane.width);
    std::vector<double> row(width, 0.0);
    for (std::size_t tap = 0; tap < kernel.size(); ++tap) {
      const int from = static_cast<int>(y) + static_cast<int>(tap) - radius;
      const std::size_t start = plane.row(std::clamp(from, 0, plane.height - 1));
      for (std::size_t x = 0; x < width; ++x) row[x] += kernel[tap] * plane.values[start + x];
    }
    for (std::size_t x = 0; x < width; ++x) {
      result.values[plane.row(static_cast<int>(y)) + x] = static_cast<float>(row[x]);
    }
  });
  return result;
}

// ---------------------------------------------------------------- colour spaces

// Linear sRGB to CIE XYZ under D65, the rational form the authors use.
const glm::dmat3& xyz_from_rgb() {
  static const glm::dmat3 matrix =
      glm::transpose(glm::dmat3(10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0,  //
                                2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0,    //
                                1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0));
  return matrix;
}

const Vec3d& white() {
  static const Vec3d xyz = xyz_from_rgb() * Vec3d(1.0);
  return xyz;
}

// (y, x - y, y - z): achromatic, red-green, blue-yellow.
Vec3d opponent_from_rgb(const Vec3d& rgb) {
  const Vec3d xyz = (xyz_from_rgb() * rgb) / white();
  return {xyz.y, xyz.x - xyz.y, xyz.y - xyz.z};
}

Vec3d rgb_from_opponent(const Vec3d& opponent) {
  static const glm::dmat3 rgb_from_xyz = glm::inverse(xyz_from_rgb());
  const double y = opponent.x;
  return rgb_from_xyz * (Vec3d(y + opponent.y, y, y - opponent.z) * white());
}

double lab_curve(double t) {
  constexpr double kDelta = 6.0 / 29.0;
  return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
}

// L*, and a* and b* scaled by L* / 100: dark colours look less colourful (Hunt).
Vec3d hunt_lab_from_rgb(const Vec3d& rgb) {
  const Vec3d xyz = (xyz_from_rgb() * rgb) / white();
  const Vec3d f(lab_curve(xyz.x), lab_curve(xyz.y), lab_curve(xyz.z));
  const double lightness = 116.0 * f.y - 16.0;
  return {lightness, 0.01 * lightness * 500.0 * (f.x - f.y), 0.01 * lightness * 200.0 * (f.y - f.z)};
}

double hyab(const Vec3d& a, const Vec3d& b) {
  const Vec3d d = a - b;
  return std::abs(d.x) + std::hypot(d.y, d.z);
}

// ---------------------------------------------------------------- 1 and 2: colour

// One Gaussian a sqrt(pi / b) exp(-pi^2 r^2 / b) of a contrast sensitivity function, r in degrees.
struct Sensitivity {
  double a;
  double b;
};

// A sum of Gaussians is no product of a row and a column filter, but each of its terms is one; the terms are
// weighted by their share in the sum of all two-dimensional weights.
Plane contrast_filter(const Plane& plane, std::initializer_list<Sensitivity> terms,
                      double pixels_per_degree) {
  constexpr double kLargestB = 0.04;
  const int radius =
      static_cast<int>(std::ceil(3.0 * std::sqrt(kLargestB / (2.0 * kPi * kPi)) * pixels_per_degree));
  std::vector<Kernel> kernels;
  std::vector<double> shares;
  double total = 0.0;
  for (const auto& [a, b] : terms) {
    kernels.push_back(make_kernel(radius, [&, scale = b](int i) {
      return std::exp(-kPi * kPi * i * i / (scale * pixels_per_degree * pixels_per_degree));
    }));
    shares.push_back(a * std::sqrt(kPi / b) * sum(kernels.back()) * sum(kernels.back()));
    total += shares.back();
  }
  Plane result = make_plane(plane.width, plane.height);
  for (std::size_t term = 0; term < kernels.size(); ++term) {
    const Kernel kernel = normalised(kernels[term]);
    const Plane filtered = filter_columns(filter_rows(plane, kernel), kernel);
    const auto share = static_cast<float>(shares[term] / total);
    for (std::size_t i = 0; i < result.values.size(); ++i) result.values[i] += share * filtered.values[i];
  }
  return result;
}

using Opponents = std::array<Plane, 3>;

Opponents opponents_of(const image::Image& image) {
  Opponents planes;
  planes.fill(make_plane(image.width, image.height));
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const Vec3d opponent = opponent_from_rgb(image.pixels[i]);
    for (int c = 0; c < 3; ++c)
      planes[static_cast<std::size_t>(c)].values[i] = static_cast<float>(opponent[c]);
  }
  return planes;
}

// What the eye resolves. The second achromatic and red-green terms of the paper have a = 0.
Opponents resolved(const Opponents& planes, double pixels_per_degree) {
  return {contrast_filter(planes[0], {{1.0, 0.0047}}, pixels_per_degree),
          contrast_filter(planes[1], {{1.0, 0.0053}}, pixels_per_degree),
          contrast_filter(planes[2], {{34.1, 0.04}, {13.5, 0.025}}, pixels_per_degree)};
}

Vec3d hunt_lab_at(const Opponents& planes, std::size_t i) {
  const Vec3d rgb = rgb_from_opponent({planes[0].values[i], planes[1].values[i], planes[2].values[i]});
  return hunt_lab_from_rgb(glm::clamp(rgb, 0.0, 1.0));
}

// Distances up to p_c of the largest one there is (green against blue) fill [0, p_t], the rest [p_t, 1].
double colour_difference(const Vec3d& a, const Vec3d& b) {
  static const double largest =
      std::pow(hyab(hunt_lab_from_rgb({0.0, 1.0, 0.0}), hunt_lab_from_rgb({0.0, 0.0, 1.0})), kColourExponent);
  const double knee = kKneeOfMaximum * largest;
  const double distance = std::pow(hyab(a, b), kColourExponent);
  if (distance < knee) return kKneeValue * distance / knee;
  return std::min(kKneeValue + (1.0 - kKneeValue) * (distance - knee) / (largest - knee), 1.0);
}

// ---------------------------------------------------------------- 3: features

struct Features {
  Plane edges;
  Plane points;
};

Plane gradient_length(const Plane& y, const Kernel& derivative, const Kernel& smooth) {
  Plane across = filter_columns(filter_rows(y, derivative), smooth);
  const Plane down = filter_columns(filter_rows(y, smooth), derivative);
  for (std::size_t i = 0; i < across.values.size(); ++i) {
    across.values[i] = std::hypot(across.values[i], down.values[i]);
  }
  return across;
}

// Derivatives of a Gaussian of standard deviation s = w / 2: -x G and (x^2 / s^2 - 1) G. In two dimensions
// the sign of a weight is that of its derivative factor, so that normalising the factors normalises the
// whole.
Features features_of(const Plane& y, double pixels_per_degree) {
  const double s = 0.5 * kFeatureWidthDegrees * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3.0 * s));
  const auto gaussian = [s](int x) { return std::exp(-x * x / (2.0 * s * s)); };
  const Kernel smooth = normalised(make_kernel(radius, gaussian));
  const Kernel edge = normalised(make_kernel(radius, [&](int x) { return -x * gaussian(x); }));
  const Kernel point =
      normalised(make_kernel(radius, [&](int x) { return (x * x / (s * s) - 1.0) * gaussian(x); }));
  return {gradient_length(y, edge, smooth), gradient_length(y, point, smooth)};
}

// y is in [0, 1] and the weights of one sign add up to 1, so a gradient is at most sqrt 2 long.
double feature_difference(const Features& a, const Features& b, std::size_t i) {
  const double edge = std::abs(double{a.edges.values[i]} - double{b.edges.values[i]});
  const double point = std::abs(double{a.points.values[i]} - double{b.points.values[i]});
  return std::min(std::pow(std::max(edge, point) / std::sqrt(2.0), kFeatureExponent), 1.0);
}

// ----------------------------------------------------------------

void require_displayable(const image::Image& image, const char* which) {
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float value = image.pixels[i][c];
      if (!(value >= 0.0F && value <= 1.0F)) {
        throw InputError(fmt::format("flip: {} pixel {}: values must be in [0, 1], is {}", which, i, value));
      }
    }
  }
}

}  // namespace

std::vector<float> flip(const image::Image& reference, const image::Image& test, double pixels_per_degree) {
  if (reference.width != test.width || reference.height != test.height) {
    throw InputError(fmt::format("flip: images must have one size, are {} x {} and {} x {}", reference.width,
                                 reference.height, test.width, test.height));
  }
  if (!(pixels_per_degree > 0.0 && pixels_per_degree <= 1000.0)) {
    throw InputError(fmt::format("flip: pixels_per_degree must be in (0, 1000], is {}", pixels_per_degree));
  }
  require_displayable(reference, "reference");
  require_displayable(test, "test");
  if (reference.pixels.empty()) return {};

  const Opponents reference_planes = opponents_of(reference);
  const Opponents test_planes = opponents_of(test);
  const Features reference_features = features_of(reference_planes[0], pixels_per_degree);
  const Features test_features = features_of(test_planes[0], pixels_per_degree);
  const Opponents reference_seen = resolved(reference_planes, pixels_per_degree);
  const Opponents test_seen = resolved(test_planes, pixels_per_degree);

  std::vector<float> result(reference.pixels.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    const double colour = colour_difference(hunt_lab_at(reference_seen, i), hunt_lab_at(test_seen, i));
    const double feature = feature_difference(reference_features, test_features, i);
    result[i] = static_cast<float>(std::pow(colour, 1.0 - feature));
  }
  return result;
}

}  // namespace plumbline::metrics
