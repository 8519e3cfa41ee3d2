// Projection of images and their lookup. Bounds allow any sampling that is symmetric about a texel's middle and no
// wider than bilinear: what the image means is known to the second moment of a texel only. A kernel of width h
// changes degree l by at most l (l + 1) h^2 / 6 of the coefficient (hat of two texels: variance h^2/6 in each of
// two directions; box: half of it; point: none).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "validation/conformance/check.hpp"
#include "validation/conformance/diagnosis.hpp"
#include "validation/conformance/truths.hpp"

namespace plumbline::conformance {
namespace {

constexpr const char* kLatLong = "project lat-long";
constexpr const char* kCube = "project cube";
constexpr const char* kLookup = "lookup lat-long";
constexpr double kWhite = 3.5449077018110318;  // sqrt(4 pi)
constexpr const char* kTexelSource = "Any symmetric sampling up to bilinear: l (l + 1) h^2/6";

std::size_t size_of(int bands) {
  return static_cast<std::size_t>(bands) * static_cast<std::size_t>(bands);
}

Values channel(const Values& rgb, std::size_t which) {
  Values result;
  for (std::size_t i = which; i < rgb.size(); i += 3) result.push_back(rgb[i]);
  return result;
}

/// One row of the image, or one texel, of radiance 1 and the rest 0.
image::Image spot_image(int width, int height, int x, int y, float value) {
  image::Image image = image::make_image(width, height);
  image.at(x, y) = Rgb(value);
  return image;
}

/// Sums of many single-precision texels: an implementation may add them in float, n texels give n roundings at most;
/// pairwise or double sums are far better. This is the bound for a float sum in order.
double sum_rounding(const Context& context, std::size_t texels) {
  constexpr double kFloat = 0x1p-24;
  const bool is_float = context.subject.epsilon() > 1e-10;
  return (is_float ? static_cast<double>(texels) * kFloat : 64.0 * context.subject.epsilon()) + kFloat;
}

double moment_bound(int bands, double h) {
  const double l = bands - 1.0;
  return l * (l + 1.0) * h * h / 6.0 + h * h / 12.0;
}

// ---------------------------------------------------------------- radiance 1
/// From the errors at each size, coarse to fine: some sizes only, or how they change with the resolution; else from
/// the finest.
std::string white_cause(const std::vector<double>& resolution, const std::vector<double>& error, double bound,
                        const Pairs& pairs, int bands) {
  const std::size_t last = error.size() - 1;
  std::string bad;
  std::size_t good = 0;
  for (std::size_t k = 0; k <= last; ++k) {
    if (error[k] <= bound)
      ++good;
    else
      bad += fmt::format("{}{:g}", bad.empty() ? "" : ", ", resolution[k]);
  }
  if (good > 1) return "wrong at some sizes only, of this many rows: " + bad;
  const double order =
      std::log(error[last - 1] / error[last]) / std::log(resolution[last] / resolution[last - 1]);
  // Falls with the square of the texel: weights of the midpoint rule; the same at all sizes: a factor.
  if (error[last] < 0.02 && order > 1.5 && order < 2.5)
    return fmt::format(
        "texel weights do not add up to 4 pi: {:.2g} at the coarsest, falling with the square of the "
        "resolution (weights at the texel's middle instead of its solid angle)",
        error.front());
  if (order < -0.5) return "the result grows with the resolution: the weights lack the texels' solid angle";
  return diagnose({bands, {pairs.expected.back()}, {pairs.measured.back()}, 1e-3});
}

Values white(int bands) {
  Values expected(size_of(bands), 0.0);
  expected[0] = kWhite;
  return expected;
}

/// Errors at each size into one finding.
Judged white_finding(const Context& context, const char* operation, const Pairs& pairs,
                     const std::vector<double>& resolution, std::size_t texels) {
  const int bands = context.bands;
  std::vector<double> errors;
  for (std::size_t k = 0; k < pairs.expected.size(); ++k) {
    Pairs one;
    one.add(pairs.expected[k], pairs.measured[k]);
    errors.push_back(one.error(context.ruler));
  }
  const double error = pairs.error(context.ruler);
  // The weights' sum must be 4 pi to rounding whatever the sampling; higher bands are smooth functions under it.
  const double bound = kWhite * (1e-6 + sum_rounding(context, texels));
  const std::string cause =
      context.ruler.accepts(error, bound) ? "" : white_cause(resolution, errors, bound, pairs, bands);
  return judged(context, {operation, "radiance 1", "c_00 = sqrt(4 pi) at every size, all others 0", bands},
                error, bound, cause);
}

/// c_00 alone: higher bands of midpoint sampling are judged by their own bound elsewhere.
Values first_only(const Values& values) {
  Values result(values.size(), 0.0);
  result[0] = values[0];
  return result;
}

std::vector<Judged> white_lat_long(const Context& context) {
  Pairs pairs;
  std::vector<double> resolution;
  for (const int height : {1, 2, 3, 4, 6, 8, 16, 32, 64}) {
    const image::Image image = image::make_image(2 * height, height, Rgb(1.0F));
    const Values c = must(context.subject.project_lat_long(context.bands, image), "an image of radiance 1");
    pairs.add(white(context.bands), first_only(channel(c, static_cast<std::size_t>(height % 3))));
    resolution.push_back(height);
  }
  return {white_finding(context, kLatLong, pairs, resolution, 128 * 64)};
}

std::vector<Judged> white_cube(const Context& context) {
  Pairs pairs;
  std::vector<double> resolution;
  for (const int size : {1, 2, 4, 8, 16, 32}) {
    const std::vector<Rgb> texels(static_cast<std::size_t>(6 * size * size), Rgb(1.0F));
    const Values c = must(context.subject.project_cube(context.bands, size, texels), "faces of radiance 1");
    pairs.add(white(context.bands), first_only(channel(c, 1)));
    resolution.push_back(size);
  }
  return {white_finding(context, kCube, pairs, resolution, 6 * 32 * 32)};
}

/// The dark bands of a white sky at a resolution where every sampling sees them vanish.
std::vector<Judged> white_bands(const Context& context) {
  const image::Image image = image::make_image(128, 64, Rgb(1.0F));
  Pairs pairs;
  pairs.add(
      white(context.bands),
      channel(must(context.subject.project_lat_long(context.bands, image), "an image of radiance 1"), 0));
  const double h = kPi / 64.0;
  return {judged_coefficients(context, {kLatLong, "bands of radiance 1", kTexelSource, context.bands}, pairs,
                              kWhite * (moment_bound(context.bands, h) + sum_rounding(context, 8192)), 1e-2)};
}

// ---------------------------------------------------------------- where light comes from
struct Texel {
  int x;
  int y;
};

/// Names single wrong texels, and directions that are off by half a texel; else as judged_coefficients().
/// `moved(k, dx, dy)` is what pair k would be with the texel moved.
template <class Moved>
Judged judged_texels(const Context& context, const Label& label, const std::vector<Texel>& texels,
                     const Pairs& pairs, double bound, const Moved& moved) {
  Judged result = judged_coefficients(context, label, pairs, bound, 0.02);
  if (result.finding.verdict == checks::Verdict::pass || !std::isfinite(result.finding.measured))
    return result;
  const auto error = [&](std::size_t k, const Values& expected) {
    Pairs one;
    one.add(expected, pairs.measured[k]);
    return one.error(context.ruler);
  };
  std::string wrong;
  std::size_t count = 0;
  for (std::size_t k = 0; k < texels.size(); ++k) {
    if (error(k, pairs.expected[k]) <= bound) continue;
    ++count;
    wrong += fmt::format(" ({}, {})", texels[k].x, texels[k].y);
  }
  if (2 * count < texels.size()) result.cause = "wrong only at the texels" + wrong;
  for (const double dx : {-0.5, 0.0, 0.5}) {
    for (const double dy : {-0.5, 0.0, 0.5}) {
      double worst = 0.0;
      for (std::size_t k = 0; k < texels.size(); ++k)
        worst = context.ruler.worse(worst, error(k, moved(k, dx, dy)));
      if ((dx != 0.0 || dy != 0.0) && worst <= 2.0 * bound)
        result.cause = fmt::format("directions are off by half a texel ({:g}, {:g})", dx, dy);
    }
  }
  result.finding.detail = result.cause;
  return result;
}

std::vector<Judged> texels_lat_long(const Context& context) {
  constexpr int kWidth = 256;
  constexpr int kHeight = 128;
  // Both sides of the seam, near the poles and in between; three colours see that channels stay apart.
  const std::vector<Texel> texels{{0, 40}, {255, 41}, {127, 9}, {190, 64}, {60, 100}, {13, 118}, {100, 30}};
  Pairs pairs;
  double scale = 0.0;
  std::vector<double> values;
  for (const Texel& t : texels) {
    const Values truth = truths::lat_long_texel(context.bands, kWidth, kHeight, t.x, t.y);
    const double power = 1.0 / truth[0];  // makes each texel's c_00 the same
    const auto value = static_cast<float>(power);
    const Values c =
        must(context.subject.project_lat_long(context.bands, spot_image(kWidth, kHeight, t.x, t.y, value)),
             "an image with one bright texel");
    Values expected = truth;
    for (double& v : expected) v *= static_cast<double>(value);
    for (const double v : expected) scale = std::max(scale, std::abs(v));
    values.push_back(static_cast<double>(value));
    pairs.add(expected, channel(c, values.size() % 3));
  }
  const double h = kPi / kHeight;
  // Near the poles a texel's own weight varies by h^2/sin^2 over it.
  const double polar = h * h / std::pow(std::sin(kPi * 9.5 / kHeight), 2);
  const auto moved = [&](std::size_t k, double dx, double dy) {
    Values v = truths::lat_long_texel(context.bands, kWidth, kHeight, texels[k].x + dx, texels[k].y + dy);
    for (double& one : v) one *= values[k];
    return v;
  };
  return {judged_texels(context, {kLatLong, "one bright texel", kTexelSource, context.bands}, texels, pairs,
                        scale * (moment_bound(context.bands, h) + polar), moved)};
}

std::vector<Judged> texels_cube(const Context& context) {
  constexpr int kSize = 64;
  Pairs pairs;
  std::vector<Texel> all;
  std::vector<double> values;
  double scale = 0.0;
  for (int face = 0; face < 6; ++face) {
    for (const Texel& t : {Texel{45, 12}, Texel{5, 50}}) {
      const Values truth = truths::cube_texel(context.bands, kSize, face, t.x, t.y);
      const auto value = static_cast<float>(1.0 / truth[0]);
      std::vector<Rgb> texels(static_cast<std::size_t>(6 * kSize * kSize), Rgb(0.0F));
      texels[static_cast<std::size_t>((face * kSize + t.y) * kSize + t.x)] = Rgb(value);
      const Values c = must(context.subject.project_cube(context.bands, kSize, texels),
                            "a cube map with one bright texel");
      Values expected = truth;
      for (double& v : expected) v *= static_cast<double>(value);
      for (const double v : expected) scale = std::max(scale, std::abs(v));
      pairs.add(expected, channel(c, 1));
      all.push_back(t);
      values.push_back(static_cast<double>(value));
    }
  }
  const auto moved = [&](std::size_t k, double dx, double dy) {
    Values v =
        truths::cube_texel(context.bands, kSize, static_cast<int>(k / 2), all[k].x + dx, all[k].y + dy);
    for (double& one : v) one *= values[k];
    return v;
  };
  return {judged_texels(context, {kCube, "one bright texel on each face", kTexelSource, context.bands}, all,
                        pairs, scale * moment_bound(context.bands, 2.0 / kSize), moved)};
}

// Face +Z of radiance 1: c_00 = sqrt(4 pi)/6, c_10 = sqrt(3/4 pi) 4/sqrt 2 atan(1/sqrt 2), c_20 from the integral of
// z^2 over the face, 2 pi/9 + 4/(3 sqrt 3); the other faces by permuting the axes.
std::vector<Judged> six_faces(const Context& context) {
  constexpr std::array<double, 6> kFaces{1.0, 2.0, 4.0, 8.0, 16.0, 32.0};
  constexpr int kSize = 32;
  std::vector<Rgb> texels;
  for (const double value : kFaces)
    texels.insert(texels.end(), static_cast<std::size_t>(kSize * kSize), Rgb(static_cast<float>(value)));
  const int bands = std::min(3, context.bands);
  const double c10 = std::sqrt(3.0 / (4.0 * kPi)) * 4.0 / std::sqrt(2.0) * std::atan(1.0 / std::sqrt(2.0));
  const double square = 2.0 * kPi / 9.0 + 4.0 / (3.0 * std::sqrt(3.0));
  const double c20 = std::sqrt(5.0 / (16.0 * kPi)) * (3.0 * square - 4.0 * kPi / 6.0);
  const auto difference = [&](std::size_t axis) { return kFaces.at(2 * axis) - kFaces.at(2 * axis + 1); };
  const auto sum = [&](std::size_t axis) { return kFaces.at(2 * axis) + kFaces.at(2 * axis + 1); };
  Values expected(9, 0.0);
  expected[0] = kWhite / 6.0 * (sum(0) + sum(1) + sum(2));
  expected[1] = -c10 * difference(1);
  expected[2] = c10 * difference(2);
  expected[3] = -c10 * difference(0);
  expected[6] = c20 * (sum(2) - 0.5 * (sum(0) + sum(1)));
  expected[8] = c20 * std::sqrt(3.0) / 2.0 * (sum(0) - sum(1));
  expected.resize(size_of(bands));
  Pairs pairs;
  pairs.add(
      expected,
      channel(must(context.subject.project_cube(bands, kSize, texels), "a cube map of six colours"), 1));
  // Bilinear with neighbouring faces blends half a texel at the edges: up to 1/kSize of a face's difference.
  return {judged_coefficients(
      context, {kCube, "six faces of different colour", "Closed form to l = 2; midpoint rule", bands}, pairs,
      63.0 * (moment_bound(bands, 2.0 / kSize) + 1e-6), 0.02)};
}

// ---------------------------------------------------------------- smooth skies
std::vector<Judged> polynomial(const Context& context) {
  double bound = 0.0;
  const int bands = std::min(3, context.bands);
  const Values truth = truths::projected(bands, truths::polynomial_sky, 4);
  Pairs finest;
  double error = 0.0;
  for (const int height : {16, 32, 64}) {
    image::Image image = image::make_image(2 * height, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < 2 * height; ++x)
        image.at(x, y) = Rgb(
            static_cast<float>(truths::polynomial_sky(truths::lat_long_centre(2 * height, height, x, y))));
    finest = {};
    finest.add(truth, channel(must(context.subject.project_lat_long(bands, image), "a smooth sky"), 1));
    // Errors are brought to those of 16 rows: they fall with h^2.
    error = context.ruler.worse(error, finest.error(context.ruler) * std::pow(height / 16.0, 2));
    bound = finest.scale() * moment_bound(3, kPi / 16.0);
  }
  const std::string cause =
      context.ruler.accepts(error, bound) ? "" : diagnose({bands, finest.expected, finest.measured, 0.01});
  return {judged(context, {kLatLong, "polynomial sky, three sizes", "Error falls with h^2", bands}, error,
                 bound, cause)};
}

std::vector<Judged> linear(const Context& context) {
  image::Image a = image::make_image(16, 8);
  image::Image b = image::make_image(16, 8);
  image::Image sum = image::make_image(16, 8);
  const Values noise = truths::some_values(a.pixels.size(), 3);
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    a.pixels[i] = Rgb(static_cast<float>(1.0 + noise[i]));
    b.pixels[i] = Rgb(i % 7 == 0 ? 0.5F : 0.125F);
    sum.pixels[i] = 2.0F * a.pixels[i] + 0.25F * b.pixels[i];
  }
  const auto projected = [&](const image::Image& image) {
    return channel(must(context.subject.project_lat_long(context.bands, image), "an image"), 0);
  };
  Values expected = projected(a);
  const Values other = projected(b);
  for (std::size_t i = 0; i < expected.size(); ++i) expected[i] = 2.0 * expected[i] + 0.25 * other[i];
  Pairs pairs;
  pairs.add(expected, projected(sum));
  // A half-gray image, which an sRGB curve would make 0.2140.
  Values gray(size_of(context.bands), 0.0);
  gray[0] = 0.5 * kWhite;
  pairs.add(gray, first_only(projected(image::make_image(32, 16, Rgb(0.5F)))));
  const double error = pairs.error(context.ruler);
  const double bound = pairs.scale() * (1e-6 + sum_rounding(context, 512)) +
                       0.5 * kWhite * kPi * kPi / (24.0 * 256.0);  // midpoint rows of the gray image
  std::string cause = "not linear in the radiance: project(2 a + b/4) is not 2 project(a) + project(b)/4";
  const double ratio = pairs.measured[1][0] / gray[0];
  if (std::abs(ratio * 0.5 - 0.2140) < 0.002)
    cause = "radiance 0.5 counts as 0.214: linear input is decoded with the sRGB curve";
  else if (std::abs(ratio - 1.0) > 1e-3)
    cause += fmt::format("; radiance 0.5 is {}", in_words(ratio));
  return {judged(context,
                 {kLatLong, "linear in the radiance", "Linearity of the integral; rounding", context.bands},
                 error, bound, cause)};
}

/// A sun of 1e6 and more in one texel: finite, and in proportion.
template <class Project>
Judged sun(const Context& context, const char* operation, const Project& project) {
  Pairs pairs;
  const Values base = project(1.0F);
  for (const float power : {1e5F, 1e6F, 1e30F}) {
    Values measured = project(power);
    for (double& v : measured) v /= static_cast<double>(power);
    pairs.add(base, measured);
  }
  const double bound = pairs.scale() * sum_rounding(context, 64);
  return judged_coefficients(
      context, {operation, "suns of 1e5, 1e6 and 1e30", "Proportional; rounding", context.bands}, pairs,
      bound, 1e-3);
}

std::vector<Judged> sun_lat_long(const Context& context) {
  return {sun(context, kLatLong, [&](float power) {
    return channel(
        must(context.subject.project_lat_long(context.bands, spot_image(16, 8, 5, 3, power)), "a bright sun"),
        0);
  })};
}
std::vector<Judged> sun_cube(const Context& context) {
  return {sun(context, kCube, [&](float power) {
    std::vector<Rgb> texels(6 * 16, Rgb(0.0F));
    texels[37] = Rgb(power);
    return channel(must(context.subject.project_cube(context.bands, 4, texels), "a bright sun"), 0);
  })};
}

// ---------------------------------------------------------------- lookup
std::vector<Judged> lookups(const Context& context) {
  constexpr int kWidth = 16;
  constexpr int kHeight = 8;
  image::Image image = image::make_image(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) image.at(x, y) = Rgb(static_cast<float>(x), static_cast<float>(y), 1.0F);
  Pairs pairs;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const Vec3d d = truths::lat_long_centre(kWidth, kHeight, x + 0.3, y - 0.3);
      pairs.add({static_cast<double>(x), static_cast<double>(y), 1.0},
                must(context.subject.lookup_lat_long(image, d), "a direction"));
    }
  }
  // At the poles any column will do; on the seam either side.
  for (const double pole : {1.0, -1.0}) {
    Values texel = must(context.subject.lookup_lat_long(image, {0.0, pole, 0.0}), "a pole");
    const bool is_column = texel[0] >= 0.0 && texel[0] < kWidth;
    pairs.add({0.0, pole > 0.0 ? 0.0 : kHeight - 1.0, 1.0},
              {is_column ? 0.0 : std::nan(""), texel[1], texel[2]});
  }
  Values seam = must(context.subject.lookup_lat_long(image, {-1.0, 0.0, 0.0}), "a direction on the seam");
  const bool is_side = seam[0] == 0.0 || seam[0] == kWidth - 1.0;
  pairs.add({0.0, 1.0}, {is_side ? 0.0 : std::nan(""), seam[2]});
  const double error = pairs.error(context.ruler);
  std::string cause = "another texel than the nearest";
  if (std::isnan(error))
    cause = "reads outside of the image (no clamp in the last row or column, or at the poles)";
  else if (pairs.measured[0][0] != 0.0 || pairs.measured[0][1] != 0.0)
    cause += fmt::format(": texel ({:g}, {:g}) for (0, 0)", pairs.measured[0][0], pairs.measured[0][1]);
  return {
      judged(context, {kLookup, "every texel, poles and seam", "The texel's own value"}, error, 0.0, cause)};
}

bool has_lat_long(const Implementation& i) {
  return i.project_lat_long != nullptr;
}
bool has_cube(const Implementation& i) {
  return i.project_cube != nullptr;
}
bool has_lookup(const Implementation& i) {
  return i.lookup_lat_long != nullptr;
}

}  // namespace

std::vector<Check> projection_checks() {
  return {{kLatLong, "radiance 1", has_lat_long, true, white_lat_long},
          {kLatLong, "bands of radiance 1", has_lat_long, true, white_bands},
          {kLatLong, "one bright texel", has_lat_long, true, texels_lat_long},
          {kLatLong, "polynomial sky, three sizes", has_lat_long, true, polynomial},
          {kLatLong, "linear in the radiance", has_lat_long, true, linear},
          {kLatLong, "suns of 1e5, 1e6 and 1e30", has_lat_long, true, sun_lat_long},
          {kCube, "radiance 1", has_cube, true, white_cube},
          {kCube, "six faces of different colour", has_cube, true, six_faces},
          {kCube, "one bright texel on each face", has_cube, true, texels_cube},
          {kCube, "suns of 1e5, 1e6 and 1e30", has_cube, true, sun_cube},
          {kLookup, "every texel, poles and seam", has_lookup, false, lookups}};
}

}  // namespace plumbline::conformance
