// reference/scene/shapes.hpp: triangle meshes made in code, the parts of the built-in scenes.
// Every closed shape is watertight after welding equal positions: neighbouring patches compute the points of
// their common border by the same expression, so these are equal bit by bit.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "reference/scene/scene.hpp"

namespace plumbline::scene {

/// Triangles (counter-clockwise front) with one unit normal per vertex, not yet part of a scene.
struct Mesh {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<glm::uvec3> triangles;
};

/// Point of a profile that turns about the y axis.
struct ProfilePoint {
  double radius = 0.0;  // >= 0
  double height = 0.0;
};

/// Cylindrical coordinates about +y: (r cos a, h, -r sin a); the azimuth turns counter-clockwise seen from
/// above.
[[nodiscard]] Vec3d around_y(double radius, double height, double azimuth_rad);

/// columns x rows flat cells, 2 triangles each, with shared vertices; the front has the normal
/// edge_u x edge_v.
[[nodiscard]] Mesh make_grid(const Vec3d& corner, const Vec3d& edge_u, const Vec3d& edge_v, int columns,
                             int rows);

/// Flat square about `centre` that stands for an infinite plane; axis_u and axis_v are orthogonal unit vectors,
/// its front has the normal axis_u x axis_v, its sides are at `half_size`. It is made of square rings whose size
/// grows by at most 4 from `finest` on, so that near the centre floats resolve positions as finely as a small
/// square's: a hit's rounding is relative to the coordinates of its triangle. 2 + 8 log_4(half_size/finest)
/// triangles, rounded up.
/// What is missing outside: from a point of its plane or near it, all directions closer than about
/// distance/half_size to the horizon. Two such squares at right angles through the same centre are a corner whose
/// faces see each other, at the distance d from the edge's middle, with the form factor 1/2 - 0.568 d/half_size.
[[nodiscard]] Mesh make_graded_square(const Vec3d& centre, const Vec3d& axis_u, const Vec3d& axis_v,
                                      double finest, double half_size);

/// Closed axis-aligned box, 12 triangles, flat, normals outward.
[[nodiscard]] Mesh make_box(const Vec3d& low, const Vec3d& high);

/// Regular icosahedron with vertices on the unit sphere: 20 triangles, 12 shared vertices with radial
/// normals. Every edge is split `subdivisions` times at its middle, pushed out to the sphere: 20 *
/// 4^subdivisions triangles. The six points on the axes are vertices when subdivisions > 0.
[[nodiscard]] Mesh make_icosphere(int subdivisions);

/// Surface (u, v) -> point over [0, 1]^2 in columns x rows cells, u along columns; the normal is du x dv by
/// central differences, so `surface` must be smooth and defined a little beyond the square.
/// The surface must be periodic in u (columns are joined), and in v too with `Ends::joined`; with
/// `Ends::capped` two flat fans about the mean of the first and the last ring close it (each ring must be
/// flat and star-shaped about its mean).
enum class Ends { joined, capped };
[[nodiscard]] Mesh make_tube(const std::function<Vec3d(double u, double v)>& surface, int columns, int rows,
                             Ends ends);

/// Solid of revolution about +y. The profile runs from the axis to the axis (first and last radius 0) with
/// the outside on its right: outward along the bottom, up, and back along the top. Profile edges that turn by
/// at most crease_deg share a smooth normal.
[[nodiscard]] Mesh make_lathe(std::span<const ProfilePoint> profile, int segments, double crease_deg);

/// Part of a ring: a convex, counter-clockwise profile (radius to the right, height up; all radii > 0) swept
/// from one azimuth to a larger one, closed by flat ends. Smooth along the sweep, creased at profile points.
[[nodiscard]] Mesh make_ring_sector(std::span<const ProfilePoint> profile, double from_rad, double to_rad,
                                    int segments);

/// Free-standing round arch in the xy plane, from y = 0, symmetric about x = 0 and z = 0.
struct ArchShape {
  double half_width = 1.0;
  double height = 3.0;
  double opening_half_width = 0.6;  // < half_width
  double springing_height = 1.5;    // where the half circle starts; + opening_half_width < height
  double depth = 0.5;
};
/// Closed; `segments` (>= 4) is the least number of chords of the half circle.
[[nodiscard]] Mesh make_arch(const ArchShape& shape, int segments);

/// Every triangle gets three vertices of its own with its geometric normal.
[[nodiscard]] Mesh faceted(const Mesh& mesh);
/// Normals become the mean of the faces at each vertex, weighted by angle.
[[nodiscard]] Mesh smoothed(Mesh mesh);
/// Scaled, turned about +y (counter-clockwise seen from above), then moved.
[[nodiscard]] Mesh placed(Mesh mesh, const Vec3d& origin, double scale = 1.0, double yaw_rad = 0.0);
/// Front and back exchanged.
[[nodiscard]] Mesh inside_out(Mesh mesh);

/// Adds a part behind what the mesh holds.
void append(Mesh& mesh, const Mesh& part);

/// Adds a material. @return its index.
std::uint32_t add_material(Scene& scene, Material material);
/// Adds a mesh with one material.
void append(Scene& scene, const Mesh& mesh, std::uint32_t material);

}  // namespace plumbline::scene
