// validation/tests/relight/gl_scenes.hpp: baked scenes and lights for the tests of OpenGL.
#pragma once

#include <string>
#include <vector>

#include "prt/sh/lighting.hpp"
#include "prt/transfer/baked_file.hpp"

namespace plumbline::test {

struct RelitScene {
  std::string name;
  transfer::Baked baked;
  sh::ShRgb lighting;
};

/// 78,188 triangles, shadowed, 5 bands, under a blue sky with a sun.
[[nodiscard]] RelitScene plaza_in_the_sun();
/// The Stanford bunny, shadowed, 4 bands, under an HDR city.
[[nodiscard]] RelitScene bunny_in_the_city();
/// A textured floor behind coloured triangles, all ways to wrap among them, three channels of transfer, 3 bands.
[[nodiscard]] RelitScene textures();

/// Exit radiance for unit albedo at the vertices, summed in double and rounded once.
[[nodiscard]] std::vector<Rgb> rounded_sums(const RelitScene& scene);

}  // namespace plumbline::test
