// validation/checks/gl_agreement.hpp: the OpenGL image against the CPU's, sample by sample.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "prt/relight/gl/renderer.hpp"
#include "prt/transfer/baked_file.hpp"

namespace plumbline::checks {

/// How far apart floats are, counted in floats between them: [0] equal, [1] one apart, [2] two or three, [k] 2^(k-1) … 2^k - 1;
/// the last one holds all beyond, the values of different signs among them.
struct UlpHistogram {
  static constexpr std::size_t kBins = 16;
  std::array<std::size_t, kBins> counts{};
};
/// Floats between a and b: 0 for +0 and -0; NaN is as far as can be.
[[nodiscard]] std::size_t ulps_apart(float a, float b);
void add(UlpHistogram& histogram, float a, float b);

/// What is compared are single channels. Relative differences are |gl - cpu| / |cpu|, Inf where only the CPU's is 0.
/// "Of the terms" divides by sum_i |T_i l_i| instead (in pixels: interpolated, times albedo): the size of what was
/// added. The two are the same where no light is negative; where terms cancel, the second alone measures arithmetic.
struct GlAgreement {
  UlpHistogram vertices;
  double vertices_relative = 0.0;
  double vertices_of_terms = 0.0;

  UlpHistogram samples;  // inside triangles
  double samples_relative = 0.0;
  double samples_of_terms = 0.0;

  std::size_t inside = 0;  // both see the same triangle
  std::size_t sky = 0;     // both see none
  std::size_t at_edges =
      0;  // they see different triangles, or one sees none, at most `edge_width` from an edge of either
  std::size_t at_depths =
      0;  // … elsewhere, at depths that are apart by 1e-6 of them at most: surfaces meet there
  std::size_t unexplained = 0;  // … elsewhere
  double edge_width =
      0.0;  // in samples: one step of the driver's subpixel grid, to which corners are rounded
  double farthest_edge = 0.0;  // in samples, of those at edges
};

/// `cpu`: exit radiance for unit albedo at the vertices. The renderer holds baked.scene under the same lighting. One
/// sample a pixel.
[[nodiscard]] GlAgreement gl_agreement(const relight::gl::Context& context, relight::gl::Renderer& renderer,
                                       const transfer::Baked& baked, const sh::ShRgb& lighting,
                                       const std::vector<Rgb>& cpu, const scene::Camera& camera, int width,
                                       int height);

}  // namespace plumbline::checks
