#include "validation/checks/error_parts.hpp"

#include <cmath>

#include "validation/checks/verdicts.hpp"

namespace plumbline::checks {
namespace {

double channel(const Image& image, std::size_t pixel, int c) {
  return static_cast<double>(image.pixels[pixel][c]);
}

}  // namespace

Image mean_image(const Image& a, const Image& b) {
  Image mean = a;
  for (std::size_t i = 0; i < mean.pixels.size(); ++i) mean.pixels[i] = 0.5F * (a.pixels[i] + b.pixels[i]);
  return mean;
}

Parts measure(const Pictures& p, const Mask& mask) {
  const int w = p.full.mean.width;
  const int h = p.full.mean.height;
  const Image prt = mean_image(p.prt_a, p.prt_b);
  const auto mean = [&](auto&& value) { return tile_mean(mask, w, h, value); };
  const auto a = [&](std::size_t i, int c) { return channel(p.full.mean, i, c); };
  const auto b = [&](std::size_t i, int c) { return channel(p.band_limited.mean, i, c); };
  const auto var_a = [&](std::size_t i, int c) { return channel(p.full.variance, i, c); };
  const auto var_b = [&](std::size_t i, int c) { return channel(p.band_limited.variance, i, c); };
  const auto cross = [&](const Image& x, const Image& y, std::size_t i, int c) {
    return (channel(x, i, c) - b(i, c)) * (channel(y, i, c) - b(i, c));
  };
  Parts parts;
  parts.mean_radiance = mean(a).mean;
  parts.full =
      mean([&](std::size_t i, int c) { return std::pow(channel(prt, i, c) - a(i, c), 2) - var_a(i, c); });
  parts.truncation =
      mean([&](std::size_t i, int c) { return std::pow(b(i, c) - a(i, c), 2) - var_a(i, c) - var_b(i, c); });
  parts.band_limited =
      mean([&](std::size_t i, int c) { return std::pow(channel(prt, i, c) - b(i, c), 2) - var_b(i, c); });
  parts.without_bake_noise =
      mean([&](std::size_t i, int c) { return cross(p.prt_a, p.prt_b, i, c) - var_b(i, c); });
  parts.interpolation =
      mean([&](std::size_t i, int c) { return cross(p.vertex_a, p.vertex_b, i, c) - var_b(i, c); });
  parts.bake_noise = mean([&](std::size_t i, int c) {
    return 0.25 * std::pow(channel(p.prt_a, i, c) - channel(p.prt_b, i, c), 2);
  });
  parts.method = mean([&](std::size_t i, int c) {
    return cross(p.prt_a, p.prt_b, i, c) - cross(p.vertex_a, p.vertex_b, i, c);
  });
  const Image vertex = mean_image(p.vertex_a, p.vertex_b);
  parts.mean_difference = mean([&](std::size_t i, int c) {
    return (channel(prt, i, c) - channel(vertex, i, c)) / parts.mean_radiance;
  });
  return parts;
}

std::vector<Finding> judge_parts(const std::string& name, const Parts& parts, double significance) {
  std::vector<Finding> findings;
  const double m = parts.mean_radiance;
  findings.push_back(judge_deviation(
      {"images", name + " / mean of PRT",
       "The same integral by two methods that share no sampling and no SH code",
       "Mean of PRT less path-traced vertices over the mean radiance, same light, same interpolation."},
      parts.mean_difference, 1e-5, 0.01, significance));
  findings.push_back(judge_deviation(
      {"images", name + " / error beyond interpolation",
       "Under the band-limited light PRT may differ by noise and interpolation only",
       "Mean squared error of PRT less that of interpolated path-traced vertices, bake noise taken off, over "
       "the squared mean radiance."},
      {parts.method.mean / (m * m), parts.method.standard_error / (m * m)}, 1e-8, 1e-3, significance));
  // Minkowski: | |P - A| - |B - A| | <= |P - B|, each at the end of its interval that is kindest to nobody.
  const double gap = std::abs(root(parts.full).value - root(parts.truncation).value) / m;
  const double chance = (root(parts.full).high - root(parts.full).low + root(parts.truncation).high -
                         root(parts.truncation).low) /
                        (2.0 * m);
  findings.push_back(
      judge_error({"images", name + " / full light is truncation",
                   "Triangle inequality: |PRT - truth| = truncation within |PRT - band-limited truth|",
                   "Difference of PRT's error under the full light and the truncation that path tracing "
                   "measures, over the mean radiance."},
                  gap, root(parts.band_limited).high / m + chance));
  return findings;
}

}  // namespace plumbline::checks
