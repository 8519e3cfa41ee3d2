// reference/light/environment.hpp: light from infinitely far away.
// Directions are unit, in world space (+Y up), and point away from the surface. CONVENTIONS.md#environments
// has the pixel <-> direction mappings.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "reference/base/vector.hpp"
#include "reference/image/image.hpp"

namespace plumbline::light {

/// The same radiance from everywhere.
struct ConstantSky {
  Rgb radiance{0.0F};
};
/// Latitude-longitude image: u = 1/2 + atan2(z, x) / 2 pi, v = acos(y) / pi from the top row.
struct LatLongSky {
  image::Image image;
};
/// Debevec's angular map ("light probe"): centre = +Z, rim = -Z, radius = angle / pi, image right = +X, image
/// up = +Y.
struct AngularMapSky {
  image::Image image;  // square; only the inscribed disc is used
};
/// Six square faces +X -X +Y -Y +Z -Z, each oriented as OpenGL's cube maps are.
struct CubeMapSky {
  std::array<image::Image, 6> faces;
};
/// Any function of direction; may be negative (band-limited light is).
struct AnalyticSky {
  std::function<Rgb(const Vec3& direction)> radiance;
};

/// A disc of constant radiance added to the sky: the sun, or a cap of any size up to the whole sphere.
struct SunDisc {
  Vec3 direction{0.0F, 1.0F,
                 0.0F};         // unit, to the centre, in the environment's frame (it turns with the sky)
  double half_angle_rad = 0.0;  // in (0, pi]
  Rgb radiance{0.0F};
};

using Sky = std::variant<ConstantSky, LatLongSky, AngularMapSky, CubeMapSky, AnalyticSky>;

/// How images are read between texel centres. `nearest`: each texel is a region of constant radiance.
/// `bilinear`: continuous, the texel's own value at its centre. At borders (CONVENTIONS.md#environments): lat-long
/// images wrap around in u and are clamped in v; the faces of a cube and the disc of an angular map are clamped,
/// each by itself.
enum class Lookup { nearest, bilinear };

struct Environment {
  std::string name;
  Sky sky = ConstantSky{};
  std::vector<SunDisc> suns;
  glm::mat3 rotation{1.0F};         // environment to world: the light arriving from R d is the file's at d
  std::size_t texels = 0;           // of the image file; 0 for what is built in
  std::size_t negative_texels = 0;  // set to 0 on loading, counted here
  Lookup lookup = Lookup::nearest;  // no matter where there is no image
};

/// Radiance arriving from `direction` (unit). The one lookup: camera rays, light sampling and projection all
/// use it. Images are looked up as environment.lookup says.
[[nodiscard]] Rgb radiance(const Environment& environment, const Vec3& direction);

/// The same without the suns.
[[nodiscard]] Rgb sky_radiance(const Environment& environment, const Vec3& direction);

/// True when no direction has any radiance for certain (constant black and no suns, or black ones).
[[nodiscard]] bool is_black(const Environment& environment);

/// Pixel <-> direction, continuous image coordinates in [0, 1]^2 with (0, 0) the top left corner. Good to
/// 2e-7 of the image's width and height (LatLong.*, AngularMap.*, Cube.* tests).
[[nodiscard]] Vec2 lat_long_from_direction(const Vec3& direction);
[[nodiscard]] Vec3 direction_from_lat_long(const Vec2& uv);
[[nodiscard]] Vec2 angular_map_from_direction(const Vec3& direction);
/// uv must lie inside the inscribed disc.
[[nodiscard]] Vec3 direction_from_angular_map(const Vec2& uv);
/// The texel that stands for (x, y), inside the square image, in the bilinear lookup of an angular map: itself,
/// or where its centre lies outside the inscribed disc, the texel on the same radius that holds the point half a
/// texel's diagonal inside the rim (its centre is in the disc).
[[nodiscard]] const Rgb& angular_map_texel(const image::Image& image, int x, int y);
struct CubeCoordinate {
  int face = 0;  // +X -X +Y -Y +Z -Z
  Vec2 uv{0.0F};
};
[[nodiscard]] CubeCoordinate cube_from_direction(const Vec3& direction);
[[nodiscard]] Vec3 direction_from_cube(const CubeCoordinate& coordinate);

/// Turns the environment (sky and suns): about world X by x degrees, then Y, then Z (each right-handed).
[[nodiscard]] Environment rotated(Environment environment, Vec3 degrees_xyz);

/// Which arrangement an image file has; `automatic` decides by the aspect ratio: 2:1 lat-long, 1:1 angular
/// map, 4:3 / 3:4 cube cross, 6:1 / 1:6 cube strip.
enum class EnvironmentLayout { automatic, lat_long, angular_map, cube };

/// `builtin:NAME` or an image file. @throws InputError naming the file and the reason (missing, no image,
/// truncated, non-finite texel with its position, an aspect ratio no layout has). Negative texels are set to
/// 0 and counted.
[[nodiscard]] Environment load_environment(const std::string& source,
                                           EnvironmentLayout layout = EnvironmentLayout::automatic);

struct BuiltinEnvironment {
  std::string name;
  std::string description;  // one line
};
/// white (radiance 1), black, overcast (CIE, zenith 1), two-lobes (the papers' analytic light), sun-sky.
/// make_builtin_environment throws InputError, listing the names there are, for any other.
[[nodiscard]] std::vector<BuiltinEnvironment> builtin_environments();
[[nodiscard]] Environment make_builtin_environment(const std::string& name);

}  // namespace plumbline::light
