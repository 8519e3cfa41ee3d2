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
/// A node and its place in the square image it was made for.
struct ImageNode {
  Vec3d direction{0.0};
  double weight = 0.0;  // [sr]
  double s = 0.0;       // [-1, 1], to the right
  double t = 0.0;       // [-1, 1], downwards
};
/// Part of a square image, in the coordinates of ImageNode.
struct ImageRectangle {
  double s0 = 0.0;
  double s1 = 0.0;
  double t0 = 0.0;
  double t1 = 0.0;
};
/// Texel (x, y) of size x size. @throws InputError when it is not in the image
[[nodiscard]] ImageRectangle texel_rectangle(int size, int x, int y);

/// Appends rule.nodes.size()^2 nodes in a rectangle of face 0 … 5 (+X -X +Y -Y +Z -Z); weights sum to its solid
/// angle.
void append_cube_nodes(int face, const ImageRectangle& rectangle, const GaussLegendre& rule,
                       std::vector<ImageNode>& nodes);

/// Appends nodes in the part of a rectangle of an angular map that lies inside the disc; none when that is empty.
/// Weights sum to its solid angle up to the rule's error (rectangles cut by the rim use a finer rule).
void append_angular_nodes(const ImageRectangle& rectangle, const GaussLegendre& rule,
                          std::vector<ImageNode>& nodes);

}  // namespace plumbline::sh
