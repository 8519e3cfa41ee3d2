#include "reference/light/environment.hpp"

#include <algorithm>
#include <cmath>

#include "reference/light/environment_lookup.hpp"

namespace plumbline::light {
namespace {

// The angle of (x, y) from +x in turns, in [-1/2, 1/2]; 0 for (0, 0). Turns rather than radians make the axes
// exact: they are texel borders of most images. Inside the first eighth of a turn,
//   atan(a) / 2 pi = a P(a^2),  0 <= a <= 1,
// with P the polynomial of degree 8 of least relative error (1.6e-8, found by Remez exchange; with float
// rounding about 1e-7); the rest is symmetry. About three times as fast as std::atan2 and, unlike it, the
// same bits on every machine. One turn error of 1e-7 is 1/1000 of a texel of an image 8192 wide.
float angle_in_turns(float y, float x) {
  const float abs_x = std::abs(x);
  const float abs_y = std::abs(y);
  const float larger = std::max(abs_x, abs_y);
  const float a = larger > 0.0F ? std::min(abs_x, abs_y) / larger : 0.0F;
  const float s = a * a;
  float p = 0.0004535740197F;
  p = p * s - 0.002557401728F;
  p = p * s + 0.006794566327F;
  p = p * s - 0.01194345572F;
  p = p * s + 0.0169355725F;
  p = p * s - 0.02260580227F;
  p = p * s + 0.03181924202F;
  p = p * s - 0.05305123391F;
  p = p * s + 0.1591549407F;
  float turns = a * p;
  turns = abs_y > abs_x ? 0.25F - turns : turns;
  turns = x < 0.0F ? 0.5F - turns : turns;
  return std::copysign(turns, y);
}

float length_of(float a, float b) {
  return std::sqrt(a * a + b * b);
}

const Rgb& texel_of(const image::Image& image, const Vec2& uv) {
  const Texel texel = texel_at(uv, image.width, image.height);
  return image.at(texel.x, texel.y);
}

// (1 - f) a + f b rather than a + f (b - a): beside a sun of 10^5 the sky keeps its digits.
template <class TexelAt>
Rgb blended(const Neighbours& u, const Neighbours& v, const TexelAt& texel) {
  const Rgb upper = glm::mix(texel(u.first, v.first), texel(u.second, v.first), u.fraction);
  const Rgb lower = glm::mix(texel(u.first, v.second), texel(u.second, v.second), u.fraction);
  return glm::mix(upper, lower, v.fraction);
}

Rgb sky_radiance(const ConstantSky& sky, const Vec3& /*direction*/, Lookup /*lookup*/) {
  return sky.radiance;
}
Rgb sky_radiance(const LatLongSky& sky, const Vec3& direction, Lookup lookup) {
  const Vec2 uv = lat_long_from_direction(direction);
  if (lookup == Lookup::nearest) return texel_of(sky.image, uv);
  return blended(wrapped_neighbours(uv.x, sky.image.width), clamped_neighbours(uv.y, sky.image.height),
                 [&](int x, int y) { return sky.image.at(x, y); });
}
Rgb sky_radiance(const AngularMapSky& sky, const Vec3& direction, Lookup lookup) {
  const Vec2 uv = angular_map_from_direction(direction);
  if (lookup == Lookup::nearest) return texel_of(sky.image, uv);
  return blended(clamped_neighbours(uv.x, sky.image.width), clamped_neighbours(uv.y, sky.image.height),
                 [&](int x, int y) { return angular_map_texel(sky.image, x, y); });
}
Rgb sky_radiance(const CubeMapSky& sky, const Vec3& direction, Lookup lookup) {
  const CubeCoordinate coordinate = cube_from_direction(direction);
  const image::Image& face = sky.faces[static_cast<std::size_t>(coordinate.face)];
  if (lookup == Lookup::nearest) return texel_of(face, coordinate.uv);
  return blended(clamped_neighbours(coordinate.uv.x, face.width),
                 clamped_neighbours(coordinate.uv.y, face.height),
                 [&](int x, int y) { return face.at(x, y); });
}
Rgb sky_radiance(const AnalyticSky& sky, const Vec3& direction, Lookup /*lookup*/) {
  return sky.radiance(direction);
}

// Quarter turns come out exact, so that a turned cube map stays a cube map to the last bit.
struct SineCosine {
  double sine = 0.0;
  double cosine = 1.0;
};
SineCosine sine_cosine_of_degrees(double degrees) {
  const double turn = std::remainder(degrees, 360.0);
  if (turn == 0.0) return {0.0, 1.0};
  if (std::abs(turn) == 180.0) return {0.0, -1.0};
  if (std::abs(turn) == 90.0) return {std::copysign(1.0, turn), 0.0};
  const double radians = turn * (kPi / 180.0);
  return {std::sin(radians), std::cos(radians)};
}

// Right-handed rotation about world axis k: takes axis k+1 towards axis k+2.
glm::dmat3 rotation_about(int axis, double degrees) {
  const auto [sine, cosine] = sine_cosine_of_degrees(degrees);
  const int from = (axis + 1) % 3;
  const int towards = (axis + 2) % 3;
  glm::dmat3 result(1.0);  // glm: result[column][row]
  result[from][from] = cosine;
  result[from][towards] = sine;
  result[towards][from] = -sine;
  result[towards][towards] = cosine;
  return result;
}

}  // namespace

Rgb sky_radiance(const Environment& environment, const Vec3& direction) {
  const Vec3 local = to_environment_frame(environment, direction);
  return std::visit([&](const auto& sky) { return sky_radiance(sky, local, environment.lookup); },
                    environment.sky);
}

Rgb radiance(const Environment& environment, const Vec3& direction) {
  Rgb total = sky_radiance(environment, direction);
  if (environment.suns.empty()) return total;
  const Vec3 local = to_environment_frame(environment, direction);
  for (const SunDisc& sun : environment.suns) {
    if (contains(sun, local)) total += sun.radiance;
  }
  return total;
}

bool is_black(const Environment& environment) {
  const auto* constant = std::get_if<ConstantSky>(&environment.sky);
  return constant != nullptr && plumbline::is_black(constant->radiance) &&
         std::all_of(environment.suns.begin(), environment.suns.end(),
                     [](const SunDisc& sun) { return plumbline::is_black(sun.radiance); });
}

// acos(y) = atan2(|(x, z)|, y) for a unit vector, but keeps its precision at the poles: a float y near 1 is
// known to 6e-8, which is 3e-4 rad of polar angle, half a texel of an image 8192 wide.
Vec2 lat_long_from_direction(const Vec3& direction) {
  return {0.5F + angle_in_turns(direction.z, direction.x),
          2.0F * angle_in_turns(length_of(direction.x, direction.z), direction.y)};
}

Vec3 direction_from_lat_long(const Vec2& uv) {
  const double phi = 2.0 * kPi * (static_cast<double>(uv.x) - 0.5);
  const double theta = kPi * static_cast<double>(uv.y);
  return Vec3(Vec3d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)));
}

// At +Z and -Z the azimuth is undefined: any is right at the centre, and any point of the rim is -Z. So close
// to them that the squares underflow it would be noise.
Vec2 angular_map_from_direction(const Vec3& direction) {
  const float across = length_of(direction.x, direction.y);
  const float radius = 2.0F * angle_in_turns(across, direction.z);  // 0 … 1
  if (!(across > 1e-15F)) return {0.5F + 0.5F * radius, 0.5F};
  const float scale = 0.5F * radius / across;
  return {0.5F + scale * direction.x, 0.5F - scale * direction.y};
}

Vec3 direction_from_angular_map(const Vec2& uv) {
  const double right = 2.0 * static_cast<double>(uv.x) - 1.0;
  const double up = 1.0 - 2.0 * static_cast<double>(uv.y);
  const double radius = std::sqrt(right * right + up * up);
  if (radius == 0.0) return {0.0F, 0.0F, 1.0F};
  const double theta = kPi * std::min(radius, 1.0);
  const double scale = std::sin(theta) / radius;
  return Vec3(Vec3d(scale * right, scale * up, std::cos(theta)));
}

// A texel reaches half a diagonal from its centre, sqrt(2) / width of the disc's radius: the texel that holds a point
// so far inside the rim has its centre in the disc.
const Rgb& angular_map_texel(const image::Image& image, int x, int y) {
  const double right = (2.0 * x + 1.0) / image.width - 1.0;
  const double down = (2.0 * y + 1.0) / image.height - 1.0;
  const double radius = std::sqrt(right * right + down * down);
  if (radius <= 1.0) return image.at(x, y);
  const double scale = 0.5 * std::max(0.0, 1.0 - std::sqrt(2.0) / image.width) / radius;
  return texel_of(image, Vec2(glm::dvec2(0.5 + scale * right, 0.5 + scale * down)));
}

// The face is that of the largest component; on an edge or corner x wins over y, and y over z.
CubeCoordinate cube_from_direction(const Vec3& direction) {
  const Vec3 size = glm::abs(direction);
  int face = 0;
  Vec2 st;  // times the largest component
  if (size.x >= size.y && size.x >= size.z) {
    face = direction.x > 0.0F ? 0 : 1;
    st = {face == 0 ? -direction.z : direction.z, -direction.y};
  } else if (size.y >= size.z) {
    face = direction.y > 0.0F ? 2 : 3;
    st = {direction.x, face == 2 ? direction.z : -direction.z};
  } else {
    face = direction.z > 0.0F ? 4 : 5;
    st = {face == 4 ? direction.x : -direction.x, -direction.y};
  }
  const float largest = std::max(size.x, std::max(size.y, size.z));
  return {face, Vec2(0.5F) + 0.5F * st / largest};
}

Vec3 direction_from_cube(const CubeCoordinate& coordinate) {
  const double s = 2.0 * static_cast<double>(coordinate.uv.x) - 1.0;
  const double t = 2.0 * static_cast<double>(coordinate.uv.y) - 1.0;
  return Vec3(glm::normalize(cube_face_point(coordinate.face, s, t)));
}

Environment rotated(Environment environment, Vec3 degrees_xyz) {
  glm::dmat3 rotation(environment.rotation);
  for (int axis = 0; axis < 3; ++axis) {
    rotation = rotation_about(axis, static_cast<double>(degrees_xyz[axis])) * rotation;
  }
  environment.rotation = glm::mat3(rotation);
  return environment;
}

}  // namespace plumbline::light
