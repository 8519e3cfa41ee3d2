// The path tracer with a normal map that leans everywhere by the same angle, against closed forms. The surface itself still blocks what
// comes from below its own plane.
#include <gtest/gtest.h>

#include <cmath>

#include "agreement.hpp"
#include "pieces.hpp"
#include "reference/image/exr.hpp"
#include "reference/integrate/gather.hpp"
#include "reference/integrate/render.hpp"
#include "reference/scene/tangents.hpp"

namespace plumbline {
namespace {

using integrate::World;
using test::expect_agrees;

/// A square [-1, 1]^2 facing +y, its map leaning by `lean_deg` towards +x (u).
scene::Scene leaning_square(double lean_deg) {
  const double a = lean_deg * kPi / 180.0;
  scene::Scene scene;
  scene.positions = {{-1.0F, 0.0F, 1.0F}, {1.0F, 0.0F, 1.0F}, {1.0F, 0.0F, -1.0F}, {-1.0F, 0.0F, -1.0F}};
  scene.normals.assign(4, Vec3(0.0F, 1.0F, 0.0F));
  scene.texcoords = {{0.0F, 1.0F}, {1.0F, 1.0F}, {1.0F, 0.0F}, {0.0F, 0.0F}};
  scene.triangles = {{0U, 1U, 2U}, {0U, 2U, 3U}};
  scene.triangle_materials = {0U, 0U};
  scene.materials.push_back({"leaning", Rgb(1.0F), Rgb(0.0F), -1, false});
  scene.materials[0].normal_texture = 0;
  const Vec3 texel(Vec3d(0.5 * (1.0 + std::sin(a)), 0.5, 0.5 * (1.0 + std::cos(a))));
  scene.textures.push_back({image::make_image(2, 2, texel)});
  scene.tangents.assign(4, glm::vec4(0.0F));
  scene = scene::with_computed_tangents(std::move(scene));
  scene.cameras.push_back(
      scene::look_at({0.0F, 2.0F, 0.0F}, Vec3(0.0F), {0.0F, 0.0F, -1.0F}, 30.0F, "above"));
  scene::validate(scene, "leaning");
  return scene;
}

/// Irradiance where the square is met from above.
integrate::RgbEstimate irradiance_on(const scene::Scene& scene, const light::Environment& environment,
                                     int samples) {
  const World world(scene, environment);
  const trace::Ray ray{{0.3F, 1.0F, 0.2F}, {0.0F, -1.0F, 0.0F}};
  const std::optional<trace::Hit> hit = world.caster.closest_hit(ray);
  if (!hit) throw std::logic_error("the square is missed");
  integrate::GatherSettings settings;
  settings.samples = samples;
  const trace::SurfacePoint point = world.surfaces.hit(*hit, ray.direction).point;
  return integrate::gather_irradiance(world, std::vector{point}, settings)[0];
}

// E = E0 n.l for a directional light; nothing where the light comes from below the square though it is above the leaning plane.
TEST(NormalMappedClosedForm, DirectionalLight) {
  const auto under_sun_at = [](double angle_deg) {
    const double a = angle_deg * kPi / 180.0;
    scene::Scene scene = leaning_square(40.0);
    const Vec3 travels(Vec3d(-std::sin(a), -std::cos(a), 0.0));
    scene.lights.emplace_back(light::DirectionalLight{travels, Rgb(2.0F)});
    return irradiance_on(scene, test::no_sky(), 16);
  };
  // 1e-6: float rounding of the normal, some 8 ulps; without the map the first would be 2 cos 60 = 1.
  EXPECT_NEAR(under_sun_at(60.0).mean.x, 2.0 * std::cos(20.0 * kPi / 180.0), 2e-6);
  EXPECT_NEAR(under_sun_at(0.0).mean.x, 2.0 * std::cos(40.0 * kPi / 180.0), 2e-6);
  EXPECT_NEAR(under_sun_at(-45.0).mean.x, 2.0 * std::cos(85.0 * kPi / 180.0), 2e-6);
  EXPECT_EQ(under_sun_at(-60.0).mean.x, 0.0);  // behind the leaning plane
  EXPECT_EQ(under_sun_at(100.0).mean.x, 0.0);  // before the leaning plane (60 degrees), below the square
}

// Under a sky of 1 the square cuts the lune between the two planes: E = (pi/2)(1 + cos lean), as for a receiver over black ground.
TEST(NormalMappedClosedForm, UniformSkyWithoutTheLuneBelowTheHorizon) {
  for (const double lean : {0.0, 30.0, 60.0}) {
    const double expected = 0.5 * kPi * (1.0 + std::cos(lean * kPi / 180.0));
    expect_agrees(irradiance_on(leaning_square(lean), test::white_sky(), 1 << 18), expected);
  }
}

// The same through the camera: exit radiance E / pi of a white surface, in the image and in its normal layer.
TEST(NormalMappedClosedForm, ThroughTheCamera) {
  scene::Scene scene = leaning_square(40.0);
  scene.lights.emplace_back(light::DirectionalLight{{0.0F, -1.0F, 0.0F}, Rgb(1.0F)});
  integrate::RenderSettings settings;
  settings.width = settings.height = 4;
  settings.samples_per_pixel = 4;
  const World world(scene, test::no_sky());
  const integrate::RenderResult result = integrate::render(world, world.scene.cameras[0], settings);
  const image::Image mean = *image::rgb_layer(result.image, "");
  for (const Rgb& pixel : mean.pixels) EXPECT_NEAR(pixel.x, std::cos(40.0 * kPi / 180.0) / kPi, 1e-6);
  for (const Rgb& pixel : mean.pixels)
    EXPECT_GE(std::abs(static_cast<double>(pixel.x) - 1.0 / kPi), 0.05);  // without the map
}

}  // namespace
}  // namespace plumbline
