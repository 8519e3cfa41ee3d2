#include "reference/scene/shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace plumbline::scene {
namespace {

using Index = std::uint32_t;

Index add_vertex(Mesh& mesh, const Vec3& position, const Vec3d& normal) {
  mesh.positions.push_back(position);
  mesh.normals.emplace_back(glm::normalize(normal));
  return static_cast<Index>(mesh.positions.size() - 1);
}

/// Flat quadrilateral a b c d, counter-clockwise seen from its front.
void add_flat_quad(Mesh& mesh, const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const Vec3d normal = glm::cross(c - a, d - b);
  const Index first = add_vertex(mesh, Vec3(a), normal);
  for (const Vec3d& point : {b, c, d}) add_vertex(mesh, Vec3(point), normal);
  mesh.triangles.emplace_back(first, first + 1, first + 2);
  mesh.triangles.emplace_back(first, first + 2, first + 3);
}

/// Flat cap over a ring that runs counter-clockwise about `normal`.
void add_fan(Mesh& mesh, std::span<const Vec3> ring, const Vec3d& normal) {
  Vec3d sum(0.0);
  for (const Vec3& point : ring) sum += Vec3d(point);
  const auto count = static_cast<Index>(ring.size());
  const Index centre = add_vertex(mesh, Vec3(sum / static_cast<double>(count)), normal);
  for (const Vec3& point : ring) add_vertex(mesh, point, normal);
  for (Index i = 0; i < count; ++i) {
    mesh.triangles.emplace_back(centre, centre + 1 + i, centre + 1 + (i + 1) % count);
  }
}

/// Two triangles between vertex i and its neighbour on two rings of vertices.
void add_cell(Mesh& mesh, Index a, Index b, Index c, Index d) {
  if (a != b) mesh.triangles.emplace_back(a, b, c);
  if (c != d) mesh.triangles.emplace_back(a, c, d);
}

}  // namespace

Vec3d around_y(double radius, double height, double azimuth_rad) {
  return {radius * std::cos(azimuth_rad), height, -radius * std::sin(azimuth_rad)};
}

Mesh make_grid(const Vec3d& corner, const Vec3d& edge_u, const Vec3d& edge_v, int columns, int rows) {
  Mesh mesh;
  const Vec3d normal = glm::cross(edge_u, edge_v);
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      const Vec3d point =
          corner + edge_u * (static_cast<double>(i) / columns) + edge_v * (static_cast<double>(j) / rows);
      add_vertex(mesh, Vec3(point), normal);
    }
  }
  const auto stride = static_cast<Index>(columns + 1);
  for (Index j = 0; j < static_cast<Index>(rows); ++j) {
    for (Index i = 0; i < static_cast<Index>(columns); ++i) {
      const Index a = j * stride + i;
      add_cell(mesh, a, a + 1, a + 1 + stride, a + stride);
    }
  }
  return mesh;
}

Mesh make_graded_square(const Vec3d& centre, const Vec3d& axis_u, const Vec3d& axis_v, double finest,
                        double half_size) {
  Mesh mesh;
  const Vec3d normal = glm::cross(axis_u, axis_v);
  const int rings = std::max(0, static_cast<int>(std::ceil(std::log(half_size / finest) / std::log(4.0))));
  const double growth = rings == 0 ? 1.0 : std::pow(half_size / finest, 1.0 / rings);
  for (int ring = 0; ring <= rings; ++ring) {
    const double half = ring == rings ? half_size : finest * std::pow(growth, ring);
    for (const glm::dvec2& c : {glm::dvec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
      add_vertex(mesh, Vec3(centre + half * (c.x * axis_u + c.y * axis_v)), normal);
    }
  }
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  for (Index ring = 0; ring < static_cast<Index>(rings); ++ring) {
    for (Index k = 0; k < 4; ++k) {  // a trapezium between a side and the next ring's
      const Index in_a = 4 * ring + k;
      const Index in_b = 4 * ring + (k + 1) % 4;
      mesh.triangles.emplace_back(in_a, in_a + 4, in_b + 4);
      mesh.triangles.emplace_back(in_a, in_b + 4, in_b);
    }
  }
  return mesh;
}

Mesh make_box(const Vec3d& low, const Vec3d& high) {
  const auto corner = [&](int x, int y, int z) {
    return Vec3d(x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z);
  };
  Mesh mesh;
  add_flat_quad(mesh, corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1), corner(0, 1, 0));  // -x
  add_flat_quad(mesh, corner(1, 0, 1), corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1));  // +x
  add_flat_quad(mesh, corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1));  // -y
  add_flat_quad(mesh, corner(0, 1, 1), corner(1, 1, 1), corner(1, 1, 0), corner(0, 1, 0));  // +y
  add_flat_quad(mesh, corner(1, 0, 0), corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0));  // -z
  add_flat_quad(mesh, corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1));  // +z
  return mesh;
}

namespace {

// Twelve corners of three golden rectangles, one in each coordinate plane: (0, +-1, +-g) and its cyclic
// permutations, g = (1 + sqrt 5)/2. Any three at mutual distance 2 (the edge length) are a face; it is turned
// so that its front looks away from the centre.
struct SphereMesh {
  std::vector<Vec3d> points;
  std::vector<glm::uvec3> triangles;
};

SphereMesh icosahedron() {
  const double g = (1.0 + std::sqrt(5.0)) / 2.0;
  SphereMesh sphere;
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-g, g}) {
      for (const Vec3d& p : {Vec3d(0.0, a, b), Vec3d(a, b, 0.0), Vec3d(b, 0.0, a)})
        sphere.points.push_back(p);
    }
  }
  const auto adjacent = [&](Index i, Index j) {
    return std::abs(glm::distance(sphere.points[i], sphere.points[j]) - 2.0) < 1e-9;
  };
  for (Index i = 0; i < 12; ++i) {
    for (Index j = i + 1; j < 12; ++j) {
      for (Index k = j + 1; k < 12; ++k) {
        if (!adjacent(i, j) || !adjacent(j, k) || !adjacent(i, k)) continue;
        const Vec3d& a = sphere.points[i];
        const bool faces_out = glm::dot(glm::cross(sphere.points[j] - a, sphere.points[k] - a), a) > 0.0;
        sphere.triangles.emplace_back(i, faces_out ? j : k, faces_out ? k : j);
      }
    }
  }
  for (Vec3d& point : sphere.points) point = glm::normalize(point);
  return sphere;
}

SphereMesh subdivided(const SphereMesh& coarse) {
  SphereMesh fine{coarse.points, {}};
  std::map<std::pair<Index, Index>, Index> middles;
  const auto middle = [&](Index a, Index b) {
    const auto [place, is_new] =
        middles.try_emplace(std::minmax(a, b), static_cast<Index>(fine.points.size()));
    if (is_new) fine.points.push_back(glm::normalize(fine.points[a] + fine.points[b]));
    return place->second;
  };
  for (const glm::uvec3& t : coarse.triangles) {
    const Index ab = middle(t.x, t.y);
    const Index bc = middle(t.y, t.z);
    const Index ca = middle(t.z, t.x);
    fine.triangles.insert(fine.triangles.end(), {{t.x, ab, ca}, {ab, t.y, bc}, {ca, bc, t.z}, {ab, bc, ca}});
  }
  return fine;
}

}  // namespace

Mesh make_icosphere(int subdivisions) {
  SphereMesh sphere = icosahedron();
  for (int level = 0; level < subdivisions; ++level) sphere = subdivided(sphere);
  Mesh mesh;
  mesh.triangles = std::move(sphere.triangles);
  for (const Vec3d& point : sphere.points) add_vertex(mesh, Vec3(point), point);
  return mesh;
}

Mesh make_tube(const std::function<Vec3d(double, double)>& surface, int columns, int rows, Ends ends) {
  constexpr double kStep = 1e-5;  // truncation ~ step^2, rounding ~ 1e-16/step: both below float
  Mesh mesh;
  const int rings = ends == Ends::joined ? rows : rows + 1;
  for (int j = 0; j < rings; ++j) {
    for (int i = 0; i < columns; ++i) {
      const double u = static_cast<double>(i) / columns;
      const double v = static_cast<double>(j) / rows;
      const Vec3d du = surface(u + kStep, v) - surface(u - kStep, v);
      const Vec3d dv = surface(u, v + kStep) - surface(u, v - kStep);
      add_vertex(mesh, Vec3(surface(u, v)), glm::cross(du, dv));
    }
  }
  const auto vertex = [&](int i, int j) { return static_cast<Index>((j % rings) * columns + i % columns); };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      add_cell(mesh, vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1));
    }
  }
  if (ends == Ends::capped) {
    const auto ring_size = static_cast<std::ptrdiff_t>(columns);
    std::vector<Vec3> first(mesh.positions.begin(), mesh.positions.begin() + ring_size);
    std::vector<Vec3> last(mesh.positions.end() - ring_size, mesh.positions.end());
    std::reverse(first.begin(), first.end());  // seen from outside, the first ring runs the other way
    const auto normal = [](std::span<const Vec3> ring) {
      const std::size_t third = ring.size() / 3;
      return Vec3d(glm::cross(ring[third] - ring[0], ring[2 * third] - ring[0]));
    };
    add_fan(mesh, first, normal(first));
    add_fan(mesh, last, normal(last));
  }
  return mesh;
}

namespace {

/// Outward unit normal (radius, height) of a profile edge: to the right of its direction.
Vec2 edge_normal(const ProfilePoint& a, const ProfilePoint& b) {
  const double dr = b.radius - a.radius;
  const double dh = b.height - a.height;
  return glm::normalize(Vec2(static_cast<float>(dh), static_cast<float>(-dr)));
}

/// Adds the vertices of one ring (one vertex where it degenerates to a point on the axis).
/// @return index of the first.
Index add_ring(Mesh& mesh, const ProfilePoint& point, const Vec2& normal, int segments) {
  const auto first = static_cast<Index>(mesh.positions.size());
  if (point.radius == 0.0) {
    add_vertex(mesh, Vec3(around_y(0.0, point.height, 0.0)), Vec3d(0.0, normal.y > 0.0F ? 1.0 : -1.0, 0.0));
    return first;
  }
  for (int i = 0; i < segments; ++i) {
    const double azimuth = 2.0 * kPi * i / segments;
    add_vertex(mesh, Vec3(around_y(point.radius, point.height, azimuth)),
               around_y(static_cast<double>(normal.x), static_cast<double>(normal.y), azimuth));
  }
  return first;
}

}  // namespace

Mesh make_lathe(std::span<const ProfilePoint> profile, int segments, double crease_deg) {
  Mesh mesh;
  const auto cos_crease = static_cast<float>(std::cos(crease_deg * kPi / 180.0));
  const std::size_t edges = profile.size() - 1;
  const auto normal_of = [&](std::size_t edge) { return edge_normal(profile[edge], profile[edge + 1]); };
  const auto is_smooth = [&](std::size_t point) {  // between edge point-1 and edge point
    return point > 0 && point < edges && glm::dot(normal_of(point - 1), normal_of(point)) >= cos_crease;
  };
  Index upper = 0;
  for (std::size_t e = 0; e < edges; ++e) {
    const Vec2 own = normal_of(e);
    const Index lower = is_smooth(e) ? upper : add_ring(mesh, profile[e], own, segments);
    const Vec2 end = is_smooth(e + 1) ? glm::normalize(own + normal_of(e + 1)) : own;
    upper = add_ring(mesh, profile[e + 1], end, segments);
    const bool has_lower_ring = profile[e].radius > 0.0;
    const bool has_upper_ring = profile[e + 1].radius > 0.0;
    for (int i = 0; i < segments; ++i) {
      const auto here = static_cast<Index>(i);
      const auto next = static_cast<Index>((i + 1) % segments);
      add_cell(mesh, lower + (has_lower_ring ? here : 0), lower + (has_lower_ring ? next : 0),
               upper + (has_upper_ring ? next : 0), upper + (has_upper_ring ? here : 0));
    }
  }
  return mesh;
}

namespace {

void add_sector_ends(Mesh& mesh, std::span<const ProfilePoint> profile, double from_rad, double to_rad) {
  std::vector<Vec3> start;
  std::vector<Vec3> end;
  for (const ProfilePoint& p : profile) {
    start.emplace_back(around_y(p.radius, p.height, from_rad));
    end.emplace_back(around_y(p.radius, p.height, to_rad));
  }
  std::reverse(end.begin(), end.end());
  // The azimuth grows along (-sin a, 0, -cos a); each end looks away from the sweep.
  add_fan(mesh, start, -around_y(1.0, 0.0, from_rad + kPi / 2.0));
  add_fan(mesh, end, around_y(1.0, 0.0, to_rad + kPi / 2.0));
}

}  // namespace

Mesh make_ring_sector(std::span<const ProfilePoint> profile, double from_rad, double to_rad, int segments) {
  Mesh mesh;
  const auto azimuth = [&](int i) {
    return i == segments ? to_rad : from_rad + (to_rad - from_rad) * i / segments;
  };
  for (std::size_t e = 0; e < profile.size(); ++e) {
    const ProfilePoint& a = profile[e];
    const ProfilePoint& b = profile[(e + 1) % profile.size()];
    const Vec2 normal = edge_normal(a, b);
    const auto first = static_cast<Index>(mesh.positions.size());
    for (int i = 0; i <= segments; ++i) {
      const Vec3d n = around_y(static_cast<double>(normal.x), static_cast<double>(normal.y), azimuth(i));
      add_vertex(mesh, Vec3(around_y(a.radius, a.height, azimuth(i))), n);
      add_vertex(mesh, Vec3(around_y(b.radius, b.height, azimuth(i))), n);
    }
    for (Index i = 0; i < static_cast<Index>(segments); ++i) {
      const Index v = first + 2 * i;
      add_cell(mesh, v, v + 2, v + 3, v + 1);
    }
  }
  add_sector_ends(mesh, profile, from_rad, to_rad);
  return mesh;
}

namespace {

// The front of an arch is a strip of quadrilaterals between two outlines with as many points each, left foot
// to right foot: the opening (leg, half circle, leg) and the rectangle around it. Above the springing line
// the outer points are the inner ones projected from the circle's centre; the angles at which this ray meets
// the rectangle's corners are among those taken, so that the outline is exact.
struct ArchOutline {
  std::vector<Vec2> inner_normals;  // into the opening
  std::vector<Vec3d> inner;
  std::vector<Vec3d> outer;
};

ArchOutline arch_outline(const ArchShape& s, int segments) {
  const double corner = std::atan2(s.height - s.springing_height, s.half_width);
  const int side = std::max(1, static_cast<int>(std::ceil(segments * corner / kPi)));
  const int top = std::max(2, static_cast<int>(std::ceil(segments * (kPi - 2.0 * corner) / kPi)));
  std::vector<double> angles;
  for (int i = 0; i < side; ++i) angles.push_back(kPi - corner * i / side);
  for (int i = 0; i < top; ++i) angles.push_back(kPi - corner - (kPi - 2.0 * corner) * i / top);
  for (int i = 0; i <= side; ++i) angles.push_back(corner - corner * i / side);

  ArchOutline outline;
  const auto add = [&](double angle, double inner_height, const Vec3d& outer) {
    const double c = std::cos(angle);
    const double inner_x = s.opening_half_width * c;
    outline.inner.emplace_back(inner_x, inner_height, 0.0);
    outline.outer.push_back(outer);
    outline.inner_normals.emplace_back(static_cast<float>(-c), static_cast<float>(-std::sin(angle)));
  };
  add(kPi, 0.0, Vec3d(-s.half_width, 0.0, 0.0));
  for (const double angle : angles) {
    const double c = std::cos(angle);
    const double up = std::sin(angle);
    const bool meets_side = std::abs(c) * (s.height - s.springing_height) > up * s.half_width;
    const double reach = meets_side ? s.half_width / std::abs(c) : (s.height - s.springing_height) / up;
    const Vec3d outer(reach * c, s.springing_height + reach * up, 0.0);
    add(angle, s.springing_height + s.opening_half_width * up, outer);
  }
  add(0.0, 0.0, Vec3d(s.half_width, 0.0, 0.0));
  return outline;
}

}  // namespace

Mesh make_arch(const ArchShape& shape, int segments) {
  const ArchOutline outline = arch_outline(shape, segments);
  const std::size_t last = outline.inner.size() - 1;
  const Vec3d front(0.0, 0.0, shape.depth / 2.0);
  Mesh mesh;
  for (std::size_t i = 0; i < last; ++i) {
    const Vec3d& in0 = outline.inner[i];
    const Vec3d& in1 = outline.inner[i + 1];
    const Vec3d& out0 = outline.outer[i];
    const Vec3d& out1 = outline.outer[i + 1];
    add_flat_quad(mesh, in0 + front, in1 + front, out1 + front, out0 + front);
    add_flat_quad(mesh, in1 - front, in0 - front, out0 - front, out1 - front);
    add_flat_quad(mesh, out0 + front, out1 + front, out1 - front, out0 - front);
    const auto soffit = static_cast<Index>(mesh.positions.size());
    for (const std::size_t k : {i, i + 1}) {
      const Vec3d normal(Vec3(outline.inner_normals[k], 0.0F));
      add_vertex(mesh, Vec3(outline.inner[k] + front), normal);
      add_vertex(mesh, Vec3(outline.inner[k] - front), normal);
    }
    add_cell(mesh, soffit + 2, soffit, soffit + 1, soffit + 3);
  }
  for (const bool is_left : {true, false}) {  // the feet
    const Vec3d a = is_left ? outline.outer[0] : outline.inner[last];
    const Vec3d b = is_left ? outline.inner[0] : outline.outer[last];
    add_flat_quad(mesh, a - front, b - front, b + front, a + front);
  }
  return mesh;
}

Mesh faceted(const Mesh& mesh) {
  Mesh flat;
  for (const glm::uvec3& t : mesh.triangles) {
    const std::array<Vec3, 3> p = {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
    const Vec3d normal = glm::cross(Vec3d(p[1]) - Vec3d(p[0]), Vec3d(p[2]) - Vec3d(p[0]));
    const auto first = static_cast<Index>(flat.positions.size());
    for (const Vec3& point : p) add_vertex(flat, point, normal);
    flat.triangles.emplace_back(first, first + 1, first + 2);
  }
  return flat;
}

Mesh smoothed(Mesh mesh) {
  std::vector<Vec3d> sums(mesh.positions.size(), Vec3d(0.0));
  for (const glm::uvec3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Vec3d here(mesh.positions[t[k]]);
      const Vec3d to_next = glm::normalize(Vec3d(mesh.positions[t[(k + 1) % 3]]) - here);
      const Vec3d to_last = glm::normalize(Vec3d(mesh.positions[t[(k + 2) % 3]]) - here);
      const double angle = std::acos(std::clamp(glm::dot(to_next, to_last), -1.0, 1.0));
      sums[t[k]] += angle * glm::normalize(glm::cross(to_next, to_last));
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) mesh.normals[i] = Vec3(glm::normalize(sums[i]));
  return mesh;
}

Mesh placed(Mesh mesh, const Vec3d& origin, double scale, double yaw_rad) {
  const double c = std::cos(yaw_rad);
  const double s = std::sin(yaw_rad);
  const auto turned = [&](const Vec3d& v) { return Vec3d(c * v.x + s * v.z, v.y, c * v.z - s * v.x); };
  for (Vec3& p : mesh.positions) p = Vec3(origin + scale * turned(Vec3d(p)));
  for (Vec3& n : mesh.normals) n = Vec3(glm::normalize(turned(Vec3d(n))));
  return mesh;
}

Mesh inside_out(Mesh mesh) {
  for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  for (Vec3& n : mesh.normals) n = -n;
  return mesh;
}

void append(Mesh& mesh, const Mesh& part) {
  const auto offset = static_cast<Index>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
  mesh.normals.insert(mesh.normals.end(), part.normals.begin(), part.normals.end());
  for (const glm::uvec3& t : part.triangles) mesh.triangles.push_back(t + offset);
}

std::uint32_t add_material(Scene& scene, Material material) {
  scene.materials.push_back(std::move(material));
  return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

void append(Scene& scene, const Mesh& mesh, std::uint32_t material) {
  const auto offset = static_cast<Index>(scene.positions.size());
  scene.positions.insert(scene.positions.end(), mesh.positions.begin(), mesh.positions.end());
  scene.normals.insert(scene.normals.end(), mesh.normals.begin(), mesh.normals.end());
  for (const glm::uvec3& t : mesh.triangles) scene.triangles.push_back(t + offset);
  scene.triangle_materials.insert(scene.triangle_materials.end(), mesh.triangles.size(), material);
}

}  // namespace plumbline::scene
