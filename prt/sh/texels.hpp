// prt/sh/texels.hpp: quadrature nodes inside the texels of environment images.
// Pixel <-> direction mappings: CONVENTIONS.md#environments. Nodes are in double precision.
#pragma once

#include <vector>

#include "prt/sh/quadrature.hpp"

namespace plumbline::sh {

/// Number of Gauss points, 2 to 2000, that integrates cos(phase t) over -1/2 <= t <= 1/2 to the relative
/// `tolerance`.
[[nodiscard]] int gauss_count(double phase, double tolerance);

/// Solid angle [sr] of texel (x, y) of a cube face of size x size texels, in closed form.
[[nodiscard]] double cube_texel_solid_angle(int size, int x, int y);
/// Appends rule.nodes.size()^2 nodes in texel (x, y) of face 0 … 5 (+X -X +Y -Y +Z -Z); weights sum to the
/// solid angle.
void append_cube_texel(int face, int size, int x, int y, const GaussLegendre& rule,
                       std::vector<SphereNode>& nodes);

/// Appends nodes in the part of texel (x, y) of a size x size angular map that lies inside the disc; none
/// when that is empty. Weights sum to its solid angle up to the rule's error (texels cut by the rim use a
/// finer rule).
void append_angular_texel(int size, int x, int y, const GaussLegendre& rule, std::vector<SphereNode>& nodes);

}  // namespace plumbline::sh
