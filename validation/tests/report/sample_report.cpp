#include "validation/tests/report/sample_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

namespace plumbline::report {
namespace {

using checks::Verdict;

constexpr int kSide = 256;

// A sphere over a floor under a sky with a bright sun lobe; `bands` lowers its sharpness, `noise` is
// relative.
Rgb shade(double u, double v, double sharpness) {
  const double r2 = (u * u + (v - 0.1) * (v - 0.1)) / 0.36;
  if (r2 > 1.0) {
    const Rgb sky =
        glm::mix(Rgb(0.25F, 0.42F, 0.85F), Rgb(0.9F, 0.95F, 1.0F), static_cast<float>(0.5 - 0.5 * v));
    const double shadow = 1.0 - 0.8 * std::exp(-sharpness * (u * u + 4.0 * (v + 0.62) * (v + 0.62)));
    return v < -0.35 ? Rgb(0.42F, 0.36F, 0.30F) * static_cast<float>(shadow) : sky;
  }
  const Vec3d n(u / 0.6, (v - 0.1) / 0.6, std::sqrt(1.0 - r2));
  const double sun = std::max(0.0, glm::dot(n, glm::normalize(Vec3d(-0.6, 0.7, 0.5))));
  const double light = 0.25 + 0.2 * n.y + 3.5 * std::pow(sun, sharpness);
  return Rgb(0.8F, 0.55F, 0.35F) * static_cast<float>(light);
}

image::Image picture(double sharpness, double noise) {
  image::Image image = image::make_image(kSide, kSide);
  std::mt19937 generator(7);
  std::normal_distribution<float> normal(0.0F, static_cast<float>(noise));
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const float factor = noise > 0.0 ? 1.0F + normal(generator) : 1.0F;
      image.at(x, y) =
          shade(2.0 * (x + 0.5) / kSide - 1.0, 1.0 - 2.0 * (y + 0.5) / kSide, sharpness) * factor;
    }
  }
  return image;
}

Rgb heat(double share) {
  const auto t = static_cast<float>(std::clamp(share, 0.0, 1.0));
  return {std::min(1.0F, 2.2F * t), t * t, 0.35F * std::sin(3.0F * t) + 0.05F};
}

void push(image::Image8& image, const Rgb& colour) {
  for (int c = 0; c < 3; ++c) image.rgb.push_back(static_cast<std::uint8_t>(std::lround(255.0F * colour[c])));
}

Gallery::ErrorMap difference(const image::Image& a, const image::Image& b, double scale) {
  Gallery::ErrorMap map{"|PRT, 5 bands - path traced|", {kSide, kSide, {}}, scale, "radiance", {64, 1, {}}};
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const Rgb d = glm::abs(a.pixels[i] - b.pixels[i]);
    push(map.image, heat((d.x + d.y + d.z) / (3.0 * scale)));
  }
  for (int i = 0; i < 64; ++i) push(map.ramp, heat(i / 63.0));
  return map;
}

Gallery gallery() {
  const image::Image truth = picture(6.0, 0.01);
  const image::Image five = picture(4.0, 0.0);
  image::Image three = picture(2.0, 0.0);
  three.at(200, 30) = Rgb(std::nanf(""));
  three.at(10, 10) = Rgb(-0.02F, 0.5F, 40.0F);
  return {"Sphere over a floor, camera “front”",
          "Same view, same light. Drag the divider; raise the exposure to see the shadow.",
          {{"path traced, 4096 spp", truth}, {"PRT, 5 bands", five}, {"PRT, 3 bands", three}},
          {difference(truth, five, 0.5)}};
}

std::vector<Chart> charts() {
  Chart bands{"Error against the number of bands",
              "Good: the points lie on the dashed theory line; their distance "
              "from it is the error of this implementation.",
              "bands",
              "relative RMSE",
              false,
              true,
              {}};
  Series measured{"interreflected PRT", {}, {}, {}, {}};
  Series shadowed{"shadowed PRT", {}, {}, {}, {}};
  Series theory{"truncation, closed form", {}, {}, {}, {}, true};
  for (int n = 1; n <= 8; ++n) {
    const double value = 0.6 * std::pow(n, -1.8);
    theory.x.push_back(n), theory.y.push_back(value);
    measured.x.push_back(n), measured.y.push_back(value * 1.07), measured.y_low.push_back(value * 0.95);
    measured.y_high.push_back(value * 1.2);
    shadowed.x.push_back(n), shadowed.y.push_back(value * 1.2 + 0.02),
        shadowed.y_low.push_back(value * 1.1 + 0.018);
    shadowed.y_high.push_back(value * 1.35 + 0.022);
  }
  bands.series = {measured, shadowed, theory};
  Chart time{"Error against run time",
             "Good: low and left. Both axes are logarithmic.",
             "seconds a frame",
             "relative RMSE",
             true,
             true,
             {}};
  time.series = {{"PRT", {2e-4, 4e-4, 9e-4, 2e-3}, {0.09, 0.03, 0.012, 0.0}, {}, {}},
                 {"path traced",
                  {0.05, 0.2, 0.8, 3.2, 12.8},
                  {0.2, 0.1, 0.05, 0.025, 0.0125},
                  {0.19, 0.095, 0.0475, 0.0237, 0.0118},
                  {0.21, 0.105, 0.0525, 0.0262, 0.0131}}};
  return {bands, time};
}

std::vector<checks::Finding> findings() {
  return {
      {"gram-matrix", "bands 9 / max |G - I|", 3.1e-15, 0.0, 1e-12, 0.0, "", Verdict::pass,
       "n eps max|term|, n = 4096", "orthonormal to rounding", 0.021, 0},
      {"gram-matrix", "bands 3 / trace", 9.0, 0.0, 1e-12, 9.0, "", Verdict::pass, "exact", "", 0.002, 0},
      {"projection", "white / L00", 3.5449, 0.0, 1e-4, 3.54490770181, "", Verdict::pass, "sqrt(4 pi)", "",
       0.3, 0},
      {"projection", "two-lobes / L21", 0.1321, 0.0008, 0.002, 0.1315, "", Verdict::pass,
       "Monte Carlo, 95 % interval", "", 1.2, 11},
      {"transfer", "open floor / T00", 0.8862, 0.0011, 0.005, 0.886226925453, "", Verdict::pass, "sqrt(pi)/2",
       "", 2.4, 3},
      {"transfer", "corner 90°, albedo 0.8 / E", 2.5104, 0.0123, 0.026, 2.61799387799, "W/m²", Verdict::fail,
       "closed form of the infinite dihedral, 1 % of it",
       "4.1 % too dark: the last bounce seems to be missing (2 bounces would give 2.51)", 8.7, 5},
      {"transfer", "furnace / T00 sqrt(4 pi)", 1.0004, 0.0009, 0.003, 1.0, "", Verdict::pass, "white furnace",
       "", 5.5, 5},
      {"transfer", "bowl, albedo 0.8 / B", 0.6669, 0.0015, 0.0033, 0.6666666667, "W/m²", Verdict::pass,
       "spherical cavity", "", 6.5, 5},
      {"image", "sphere / bias", 0.00004, 0.00031, 0.001, 0.0, "of the mean", Verdict::pass,
       "two one-sided tests, alpha 0.01", "no bias seen; 0.07 % would have been", 31.0, 17},
      {"image", "sphere / relative RMSE", 0.0121, 0.0004, 0.02, 0.0, "", Verdict::pass,
       "truncation of the light, closed form", "", 31.0, 17},
      {"image", "terrain / bias", 0.0006, 0.0021, 0.001, 0.0, "of the mean", Verdict::inconclusive,
       "two one-sided tests, alpha 0.01", "too few samples: 64 times as many would decide", 64.0, 17},
      {"rotation", "90° about z / band traces", -1.0, 0.0, 1e-12, -1.0, "", Verdict::pass,
       "sin((2l+1)t/2)/sin(t/2)", "", 0.004, 0},
  };
}

}  // namespace

Report sample_report() {
  Report report;
  report.title = "Validation of sphere.gltf under two-lobes";
  report.summary =
      "Precomputed radiance transfer with 5 bands against the path tracer and closed forms. "
      "One check of multi-bounce transfer fails.";
  report.date = "2025-01-31T12:00:00Z";
  report.version = "0.1.0";
  report.command =
      "plumbline validate sphere.gltf --env builtin:two-lobes --bands 3,5 --checks gram-matrix,projection,"
      "transfer,image,rotation -o report";
  report.machine = {{"cpu", "AMD EPYC 7763, 2 cores"},
                    {"threads", "2"},
                    {"memory", "8 GiB"},
                    {"os", "Debian 12"},
                    {"compiler", "GCC 12.2"}};
  report.settings = {{"seed", "17"},
                     {"samples a pixel", "4096"},
                     {"significance", "1e-4 over all checks (Šidák)"},
                     {"bands", "3, 5"}};
  report.headlines = {{"error under the band-limited light", "0.31 % ± 0.04 %",
                       "Good below 1 %: what the implementation itself adds."},
                      {"error under the full light", "1.21 % ± 0.04 %",
                       "Good near 1.15 %, what 5 bands can do for this light."},
                      {"one frame", "0.9 ms", "3500 × faster than path tracing to the same error."}};
  report.galleries = {gallery()};
  report.charts = charts();
  report.tables = {
      {"Error budget",
       "Where the total comes from, each part measured by swapping one stage for its exact version.",
       {"part", "relative RMSE", "share", "verdict"},
       {{"light truncation", "1.15 %", "90 %", "pass"},
        {"bake noise", "0.22 %", "3 %", "pass"},
        {"spatial interpolation", "0.31 %", "7 %", "pass"},
        {"total", "1.21 % ± 0.04 %", "100 %", ""}}}};
  report.findings = findings();
  return report;
}

}  // namespace plumbline::report
