// prt/normal_map/normal_texture.hpp: the normal basis as a picture that a shader looks up.
#pragma once

#include <span>
#include <vector>

#include "prt/normal_map/normal_basis.hpp"

namespace plumbline::normal_map {

/// u_k(n) at texel centres, (x, y) of the normal running over [-1, 1]^2 as in the course's shader (n.xy / 2 + 1/2). Outside the unit
/// disc a texel holds the value at the nearest point of the rim.
struct NormalTexture {
  int side = 0;
  int terms = 0;
  std::vector<float> values;  // [row of y][column of x][term]
};

/// @throws InputError unless 1 <= terms <= 9 and 2 <= side <= 4096
[[nodiscard]] NormalTexture make_normal_texture(const NormalBasis& basis, int terms, int side);

/// Bilinear, clamped at the borders. `normal`: unit, tangent frame, z >= 0. @throws InputError when there are not `terms` values
void look_up(const NormalTexture& texture, const Vec3d& normal, std::span<double> values);

}  // namespace plumbline::normal_map
