#include "prt/normal_map/view.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>

#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"
#include "reference/scene/normal_map.hpp"
#include "reference/trace/ray_caster.hpp"
#include "reference/trace/surface_point.hpp"

namespace plumbline::normal_map {
namespace {

/// Row k of `rows` interpolated over the triangle, `stride` rows a vertex.
RgbD interpolated(const std::vector<Rgb>& rows, std::size_t stride, std::size_t k, const Fragment& f) {
  RgbD sum(0.0);
  for (int corner = 0; corner < 3; ++corner) {
    sum += static_cast<double>(f.weights[corner]) * RgbD(rows[f.corners[corner] * stride + k]);
  }
  return sum;
}

/// Exit radiance for unit albedo of nine coefficients of incident radiance at a normal given in their axes.
Rgb evaluated(const std::vector<Rgb>& rows, const Fragment& f, const Vec3d& normal) {
  const Quadratic weights = reflected(normal);
  RgbD sum(0.0);
  for (std::size_t j = 0; j < kQuadraticCount; ++j)
    sum += weights[j] * interpolated(rows, kQuadraticCount, j, f);
  return Rgb(sum);
}

/// Three rows a vertex.
Rgb weighted(const std::vector<Rgb>& rows, const Vec3d& weights, const Fragment& f) {
  RgbD sum(0.0);
  for (int k = 0; k < 3; ++k) sum += weights[k] * interpolated(rows, 3, static_cast<std::size_t>(k), f);
  return Rgb(sum);
}

RgbD unshadowed(const sh::ShRgb& lighting, const Vec3d& normal) {
  const Quadratic weights = reflected(normal);
  RgbD sum(0.0);
  for (std::size_t j = 0; j < kQuadraticCount; ++j) sum += weights[j] * lighting.coefficients[j];
  return sum;
}

double luminance_of(const RgbD& c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

struct Met {
  Fragment fragment;
  Rgb albedo{0.0F};
};

std::optional<Met> meet(const trace::RayCaster& caster, const scene::Scene& scene, const trace::Ray& ray) {
  const std::optional<trace::Hit> hit = caster.closest_hit(ray);
  if (!hit) return std::nullopt;
  const trace::SurfaceHit surface = trace::surface_hit(scene, *hit, ray.direction);
  if (!surface.is_front) return std::nullopt;
  Met met;
  Fragment& f = met.fragment;
  f.corners = scene.triangles[hit->triangle];
  f.weights = {1.0F - hit->barycentrics.x - hit->barycentrics.y, hit->barycentrics.x, hit->barycentrics.y};
  f.normal = glm::normalize(Vec3d(surface.point.shading_normal));
  f.in_frame = Vec3d(0.0, 0.0, 1.0);
  met.albedo = scene::albedo_at(scene, hit->triangle, hit->barycentrics);
  const scene::Material& material = scene::material_of(scene, hit->triangle);
  if (material.normal_texture < 0) return met;
  const Vec3 smooth =
      glm::normalize(f.weights.x * scene.normals[f.corners.x] + f.weights.y * scene.normals[f.corners.y] +
                     f.weights.z * scene.normals[f.corners.z]);
  if (const auto frame = scene::tangent_frame(scene, f.corners, f.weights, smooth)) {
    f.in_frame = {glm::dot(f.normal, Vec3d(frame->tangent)), glm::dot(f.normal, Vec3d(frame->bitangent)),
                  glm::dot(f.normal, Vec3d(frame->normal))};
  }
  return met;
}

}  // namespace

std::vector<image::Image> render_shaded(const scene::Scene& scene, const scene::Camera& camera,
                                        const relight::ViewSettings& settings,
                                        const std::vector<Shader>& shaders) {
  if (settings.width < 1 || settings.height < 1 || settings.grid < 1) {
    throw InputError(fmt::format("size: expected at least 1x1 with 1 ray a pixel, got {}x{} with {}",
                                 settings.width, settings.height, settings.grid * settings.grid));
  }
  const trace::RayCaster caster(scene);
  std::vector<image::Image> images(shaders.size(), image::make_image(settings.width, settings.height));
  const int rays = settings.grid * settings.grid;
  parallel_for(static_cast<std::size_t>(settings.height), settings.threads, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    std::vector<RgbD> sums(shaders.size());
    for (int x = 0; x < settings.width; ++x) {
      std::fill(sums.begin(), sums.end(), RgbD(0.0));
      for (int k = 0; k < rays; ++k) {
        const float step = 1.0F / static_cast<float>(settings.grid);
        const float dx = (static_cast<float>(k % settings.grid) + 0.5F) * step;
        const float dy = (static_cast<float>(k / settings.grid) + 0.5F) * step;
        const Vec3 direction = scene::ray_direction(
            camera, static_cast<float>(x) + dx, static_cast<float>(y) + dy, settings.width, settings.height);
        const std::optional<Met> met = meet(caster, scene, {camera.eye, direction});
        if (!met) continue;
        for (std::size_t i = 0; i < shaders.size(); ++i)
          sums[i] += RgbD(met->albedo * shaders[i](met->fragment));
      }
      for (std::size_t i = 0; i < shaders.size(); ++i)
        images[i].at(x, y) = Rgb(sums[i] / static_cast<double>(rays));
    }
  });
  return images;
}

Shader shade_in_world(std::vector<Rgb> rows) {
  return [rows = std::move(rows)](const Fragment& f) { return evaluated(rows, f, f.normal); };
}

Shader shade_in_frame(std::vector<Rgb> rows) {
  return [rows = std::move(rows)](const Fragment& f) { return evaluated(rows, f, f.in_frame); };
}

Shader shade_by_texture(std::vector<Rgb> rows, NormalTexture texture) {
  return [rows = std::move(rows), texture = std::move(texture)](const Fragment& f) {
    std::array<double, kQuadraticCount> u{};
    const auto terms = static_cast<std::size_t>(texture.terms);
    look_up(texture, f.in_frame, std::span(u).first(terms));
    RgbD sum(0.0);
    for (std::size_t k = 0; k < terms; ++k) sum += u[k] * interpolated(rows, terms, k, f);
    return Rgb(sum);
  };
}

Shader shade_half_life_2(std::vector<Rgb> rows) {
  return [rows = std::move(rows)](const Fragment& f) {
    return weighted(rows, half_life_2_weights(f.in_frame), f);
  };
}

Shader shade_half_life_2_fitted(std::vector<Rgb> rows) {
  return [rows = std::move(rows)](const Fragment& f) {
    return weighted(rows, half_life_2_functions(f.in_frame), f);
  };
}

Shader shade_by_ratio(const scene::Scene& scene, const std::vector<Rgb>& shadowed,
                      const sh::ShRgb& lighting) {
  constexpr double kDark = 1e-3;
  if (lighting.bands < kQuadraticBands) {
    throw InputError(fmt::format("lighting: {} bands, the ratio method needs 3", lighting.bands));
  }
  // A constant light with this y_00 coefficient would be reflected as this radiance.
  const double mean = luminance_of(lighting.coefficients[0]) / std::sqrt(4.0 * kPi);
  std::vector<float> ratios;
  for (std::size_t v = 0; v < shadowed.size(); ++v) {
    const double open = luminance_of(unshadowed(lighting, Vec3d(scene.normals[v])));
    ratios.push_back(open > kDark * mean ? static_cast<float>(luminance_of(RgbD(shadowed[v])) / open) : 0.0F);
  }
  return [ratios = std::move(ratios), lighting](const Fragment& f) {
    const float ratio = f.weights.x * ratios[f.corners.x] + f.weights.y * ratios[f.corners.y] +
                        f.weights.z * ratios[f.corners.z];
    return Rgb(static_cast<double>(ratio) * unshadowed(lighting, f.normal));
  };
}

Shader shade_without_map(std::vector<Rgb> vertex_radiance) {
  return [rows = std::move(vertex_radiance)](const Fragment& f) { return Rgb(interpolated(rows, 1, 0, f)); };
}

}  // namespace plumbline::normal_map
