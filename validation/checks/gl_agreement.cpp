#include "validation/checks/gl_agreement.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "reference/trace/ray_caster.hpp"

namespace plumbline::checks {
namespace {

constexpr double kSameDepth = 1e-6;

// NaN on either side counts as Inf: it must not pass for agreement.
double quotient(double difference, double size) {
  if (difference == 0.0) return 0.0;
  const double result = difference / size;
  return std::isnan(result) ? std::numeric_limits<double>::infinity() : result;
}

std::vector<Rgb> sizes_of_terms(const transfer::Transfer& transfer, const sh::ShRgb& lighting) {
  std::vector<Rgb> sizes(transfer.vertices);
  for (std::size_t v = 0; v < sizes.size(); ++v) {
    for (int c = 0; c < 3; ++c) {
      const std::span<const float> vector = transfer.vector(v, c);
      double sum = 0.0;
      for (std::size_t i = 0; i < vector.size(); ++i)
        sum += std::abs(static_cast<double>(vector[i]) * lighting.coefficients[i][c]);
      sizes[v][c] = static_cast<float>(sum);
    }
  }
  return sizes;
}

struct Worst {
  UlpHistogram& histogram;
  double& relative;
  double& of_terms;

  void compare(const Rgb& gl, const Rgb& cpu, const Rgb& terms) const {
    for (int c = 0; c < 3; ++c) {
      const double difference = std::abs(static_cast<double>(gl[c]) - static_cast<double>(cpu[c]));
      add(histogram, gl[c], cpu[c]);
      relative = std::max(relative, quotient(difference, std::abs(static_cast<double>(cpu[c]))));
      of_terms = std::max(of_terms, quotient(difference, static_cast<double>(terms[c])));
    }
  }
};

/// Where a sample lies in a triangle's plane.
struct Place {
  double to_edge = std::numeric_limits<double>::infinity();  // in samples
  double depth = std::numeric_limits<double>::infinity();
};

Place place_of(const scene::Scene& scene, std::uint32_t triangle, const relight::SampleGrid& grid, int column,
               int row) {
  if (triangle == relight::gl::kNoTriangle) return {};
  const relight::ScreenTriangle s = relight::screen_triangle(scene, triangle, grid);
  Place place;
  double inverse_depth = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double value = static_cast<double>(s.a[k]) +
                         static_cast<double>(s.b[k]) * (column - static_cast<double>(s.x)) +
                         static_cast<double>(s.c[k]) * (row - static_cast<double>(s.y));
    inverse_depth += value;
    const double slope = std::hypot(static_cast<double>(s.b[k]), static_cast<double>(s.c[k]));
    place.to_edge = std::min(place.to_edge, quotient(std::abs(value), slope));
  }
  place.depth = 1.0 / inverse_depth;
  return place;
}

struct Comparison {
  const scene::Scene& scene;
  const trace::RayCaster& caster;
  const relight::SampleGrid& grid;
  const image::LayeredImage& cpu;
  const image::LayeredImage& terms;
  GlAgreement& result;

  [[nodiscard]] Rgb at(const image::LayeredImage& image, int column, int row) const {
    const auto i = static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
                   static_cast<std::size_t>(column);
    return {image.channels.at("R")[i], image.channels.at("G")[i], image.channels.at("B")[i]};
  }

  void explain(std::uint32_t ours, std::uint32_t theirs, int column, int row) const {
    const Place a = place_of(scene, ours, grid, column, row);
    const Place b = place_of(scene, theirs, grid, column, row);
    const double to_edge = std::min(a.to_edge, b.to_edge);
    if (to_edge <= result.edge_width) {
      ++result.at_edges;
      result.farthest_edge = std::max(result.farthest_edge, to_edge);
    } else if (std::abs(a.depth - b.depth) <= kSameDepth * a.depth) {
      ++result.at_depths;
    } else {
      ++result.unexplained;
    }
  }

  void compare(int column, int row, std::uint32_t theirs, const Rgb& radiance) const {
    const std::optional<trace::Hit> hit =
        caster.closest_hit({Vec3(grid.eye), relight::sample_direction(grid, column, row)});
    const std::uint32_t ours = hit ? hit->triangle : relight::gl::kNoTriangle;
    if (ours != theirs) return explain(ours, theirs, column, row);
    if (!hit) {
      ++result.sky;
      return;
    }
    ++result.inside;
    const Worst worst{result.samples, result.samples_relative, result.samples_of_terms};
    worst.compare(radiance, at(cpu, column, row), at(terms, column, row));
  }
};

}  // namespace

std::size_t ulps_apart(float a, float b) {
  if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<std::size_t>::max();
  const auto ordered = [](float value) {
    const auto bits = static_cast<std::int64_t>(std::bit_cast<std::uint32_t>(value) & 0x7FFFFFFFU);
    return std::signbit(value) ? -bits : bits;
  };
  return static_cast<std::size_t>(std::abs(ordered(a) - ordered(b)));
}

void add(UlpHistogram& histogram, float a, float b) {
  const auto bin = static_cast<std::size_t>(std::bit_width(ulps_apart(a, b)));
  ++histogram.counts[std::min(bin, UlpHistogram::kBins - 1)];
}

GlAgreement gl_agreement(const relight::gl::Context& context, relight::gl::Renderer& renderer,
                         const transfer::Baked& baked, const sh::ShRgb& lighting, const std::vector<Rgb>& cpu,
                         const scene::Camera& camera, int width, int height) {
  GlAgreement result;
  result.edge_width = std::ldexp(1.0, -context.integer(GL_SUBPIXEL_BITS));
  const std::vector<Rgb> terms = sizes_of_terms(baked.transfer, lighting);
  renderer.set_light(lighting);
  const std::vector<Rgb> gl = renderer.unit_albedo_exit_radiance();
  const Worst worst{result.vertices, result.vertices_relative, result.vertices_of_terms};
  for (std::size_t v = 0; v < gl.size(); ++v) worst.compare(gl[v], cpu[v], terms[v]);

  const relight::ViewSettings view{width, height, 1, 0};
  const image::LayeredImage cpu_image = relight::render_view(baked.scene, cpu, camera, view, nullptr);
  const image::LayeredImage terms_image = relight::render_view(baked.scene, terms, camera, view, nullptr);
  const trace::RayCaster caster(baked.scene);
  const relight::SampleGrid grid = relight::sample_grid(camera, width, height, 1);
  const Comparison comparison{baked.scene, caster, grid, cpu_image, terms_image, result};
  renderer.set_view(camera, view);
  renderer.draw([&](const relight::gl::Tile& tile) {
    for (int y = 0; y < tile.rows; ++y) {
      for (int x = 0; x < tile.columns; ++x) {
        const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(tile.columns) +
                       static_cast<std::size_t>(x);
        comparison.compare(tile.x + x, tile.y + y, tile.triangles[i], Rgb(tile.radiance[i]));
      }
    }
  });
  return result;
}

}  // namespace plumbline::checks
