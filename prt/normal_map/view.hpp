// prt/normal_map/view.hpp: normal-mapped pictures, each pixel shaded with the normal of its own point.
#pragma once

#include <functional>
#include <vector>

#include "prt/normal_map/local_transfer.hpp"
#include "prt/normal_map/normal_texture.hpp"
#include "prt/relight/cpu.hpp"
#include "reference/image/image.hpp"

namespace plumbline::normal_map {

/// A point that a camera ray meets, seen from its front.
struct Fragment {
  glm::uvec3 corners{0U};
  Vec3 weights{0.0F};   // barycentric, sum 1
  Vec3d normal{0.0};    // unit, of the normal map, world axes
  Vec3d in_frame{0.0};  // the same in the point's right-handed tangent frame; (0, 0, 1) without a map
};

/// Exit radiance for unit albedo at a fragment.
using Shader = std::function<Rgb(const Fragment&)>;

/// One picture a shader, all from the same camera rays: mean over grid x grid rays a pixel of albedo x shader, black where nothing or a
/// back is met. Shaders are called from many threads. @throws InputError for a size or grid below 1
[[nodiscard]] std::vector<image::Image> render_shaded(const scene::Scene& scene, const scene::Camera& camera,
                                                      const relight::ViewSettings& settings,
                                                      const std::vector<Shader>& shaders);

/// The nine world-axes rows, convolved and evaluated at the mapped normal. `rows`: of lit_rows(), as for the others.
[[nodiscard]] Shader shade_in_world(std::vector<Rgb> rows);
/// The nine rows in vertex tangent frames, at the mapped normal in the point's frame.
[[nodiscard]] Shader shade_in_frame(std::vector<Rgb> rows);
/// Rows of compressed(), as many as the texture has terms.
[[nodiscard]] Shader shade_by_texture(std::vector<Rgb> rows, NormalTexture texture);
/// Rows of half_life_2().
[[nodiscard]] Shader shade_half_life_2(std::vector<Rgb> rows);
/// Rows of half_life_2_fitted().
[[nodiscard]] Shader shade_half_life_2_fitted(std::vector<Rgb> rows);
/// The course's cheapest: unshadowed exit radiance of `lighting` (3 bands) at the mapped normal, times the interpolated ratio of
/// luminances shadowed / unshadowed at the vertices. `shadowed`: exit radiance for unit albedo at the vertices, without the map.
/// Where a vertex would have no unshadowed light (below 1e-3 of the light's mean), the ratio is 0.
/// @throws InputError when the lighting has fewer than 3 bands
[[nodiscard]] Shader shade_by_ratio(const scene::Scene& scene, const std::vector<Rgb>& shadowed,
                                    const sh::ShRgb& lighting);
/// Vertex values interpolated, the map ignored.
[[nodiscard]] Shader shade_without_map(std::vector<Rgb> vertex_radiance);

}  // namespace plumbline::normal_map
