#include "reference/scene/plaza.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "reference/scene/shapes.hpp"

namespace plumbline::scene {
namespace {

constexpr double kSunk = 0.01;     // how deep a piece stands in what carries it [m]
constexpr double kTerrace = 0.48;  // height of the terrace's floor
constexpr double kColonnadeRadius = 4.9;
constexpr double kCreaseDeg = 40.0;
constexpr double kDegree = kPi / 180.0;

// ---------------------------------------------------------------- terrace and ground
Mesh make_terrace() {
  const double step = kTerrace / 3.0;
  std::vector<ProfilePoint> profile = {{0.0, -kSunk},    {6.7, -kSunk},   {6.7, step},    {6.35, step},
                                       {6.35, 2 * step}, {6.0, 2 * step}, {6.0, kTerrace}};
  for (double radius = 5.6; radius > 0.1; radius -= 0.4) profile.push_back({radius, kTerrace});
  profile.push_back({0.0, kTerrace});
  return make_lathe(profile, 96, kCreaseDeg);
}

// ---------------------------------------------------------------- columns
/// Points of a half-round moulding that bulges outward, from (radius, low) to (radius, high).
void add_torus(std::vector<ProfilePoint>& profile, double radius, double low, double high) {
  constexpr int kChords = 6;
  const double half = (high - low) / 2.0;
  for (int i = 0; i <= kChords; ++i) {
    const double angle = kPi * (static_cast<double>(i) / kChords - 0.5);
    profile.push_back({radius + half * std::cos(angle), low + half + half * std::sin(angle)});
  }
}

/// Twenty flutes and a slight swelling (entasis); from y = 0 to `height`.
Mesh make_shaft(double radius, double height) {
  constexpr int kFlutes = 20;
  const auto surface = [=](double u, double v) {
    const double taper = 1.0 - 0.17 * v * v;
    const double wave = std::sin(kFlutes * kPi * u);
    const double flute = 1.0 - 0.09 * wave * wave;
    return around_y(radius * taper * flute, height * v, 2.0 * kPi * u);
  };
  return make_tube(surface, kFlutes * 6, 8, Ends::capped);
}

/// Attic base, fluted shaft, moulded capital and abacus; its axis is the y axis, its foot at y = 0.
Mesh make_column(double height) {
  constexpr double kRadius = 0.25;
  const double top = height - 0.38;  // where the capital starts
  std::vector<ProfilePoint> base = {{0.0, 0.11}};
  add_torus(base, 0.30, 0.11, 0.20);
  base.push_back({0.275, 0.21});
  add_torus(base, 0.27, 0.23, 0.29);
  base.push_back({0.0, 0.29});
  std::vector<ProfilePoint> capital = {{0.0, top}};
  add_torus(capital, 0.215, top, top + 0.05);
  capital.insert(capital.end(), {{0.21, top + 0.06},
                                 {0.22, top + 0.14},
                                 {0.26, top + 0.21},
                                 {0.32, top + 0.26},
                                 {0.33, top + 0.27},
                                 {0.0, top + 0.27}});
  Mesh column = make_box({-0.36, -kSunk, -0.36}, {0.36, 0.12, 0.36});
  append(column, make_lathe(base, 40, kCreaseDeg));
  append(column, placed(make_shaft(kRadius, top - 0.26), {0.0, 0.28, 0.0}));
  append(column, make_lathe(capital, 40, kCreaseDeg));
  append(column, make_box({-0.36, top + 0.26, -0.36}, {0.36, height + kSunk, 0.36}));
  return column;
}

// ---------------------------------------------------------------- colonnades
struct Arc {
  double from_rad = 0.0;
  double to_rad = 0.0;
};
constexpr std::array<Arc, 2> kArcs = {{{8.0 * kDegree, 68.0 * kDegree}, {112.0 * kDegree, 172.0 * kDegree}}};

/// Ring sector of rectangular section about the colonnade's circle.
Mesh make_beam(const Arc& arc, double half_width, double low, double high, double flare) {
  const std::array<ProfilePoint, 4> profile = {{{kColonnadeRadius - half_width, low},
                                                {kColonnadeRadius + half_width, low},
                                                {kColonnadeRadius + half_width + flare, high},
                                                {kColonnadeRadius - half_width - flare, high}}};
  return make_ring_sector(profile, arc.from_rad, arc.to_rad, 36);
}

Mesh make_colonnade(const Arc& arc) {
  constexpr int kColumns = 4;
  constexpr double kHeight = 3.3;
  const Mesh column = make_column(kHeight);
  Mesh colonnade;
  const double margin = 6.0 * kDegree;
  for (int i = 0; i < kColumns; ++i) {
    const double span = arc.to_rad - arc.from_rad - 2.0 * margin;
    const double azimuth = arc.from_rad + margin + span * i / (kColumns - 1);
    append(colonnade, placed(column, around_y(kColonnadeRadius, kTerrace, azimuth), 1.0, azimuth));
  }
  const double top = kTerrace + kHeight;
  append(colonnade, make_beam(arc, 0.30, top, top + 0.26, 0.0));
  const double inset = 0.3 * kDegree;  // the ends of the three courses lie in different planes
  const Arc frieze = {arc.from_rad + inset, arc.to_rad - inset};
  const Arc cornice = {arc.from_rad - 2.0 * inset, arc.to_rad + 2.0 * inset};
  append(colonnade, make_beam(frieze, 0.27, top + 0.25, top + 0.51, 0.0));
  append(colonnade, make_beam(cornice, 0.33, top + 0.50, top + 0.64, 0.12));
  return colonnade;
}

Mesh make_bench(const Arc& arc) {
  const double shift = 8.0 * kDegree;
  const std::array<ProfilePoint, 4> seat = {
      {{3.55, kTerrace + 0.36}, {4.05, kTerrace + 0.36}, {4.05, kTerrace + 0.45}, {3.55, kTerrace + 0.45}}};
  Mesh bench = make_ring_sector(seat, arc.from_rad + shift, arc.to_rad - shift, 32);
  for (int i = 0; i < 4; ++i) {
    const double middle =
        arc.from_rad + shift + (arc.to_rad - arc.from_rad - 2.0 * shift) * (0.08 + 0.28 * i);
    const std::array<ProfilePoint, 4> leg = {{{3.62, kTerrace - kSunk},
                                              {3.98, kTerrace - kSunk},
                                              {3.98, kTerrace + 0.37},
                                              {3.62, kTerrace + 0.37}}};
    append(bench, make_ring_sector(leg, middle - 1.2 * kDegree, middle + 1.2 * kDegree, 2));
  }
  return bench;
}

// ---------------------------------------------------------------- arch
Mesh make_gate() {
  const ArchShape shape = {
      .half_width = 1.45, .height = 4.1, .opening_half_width = 0.85, .springing_height = 2.3, .depth = 0.9};
  Mesh gate = make_arch(shape, 48);
  for (const double x : {-1.15, 1.15}) {  // foot and impost around each pier
    append(gate, make_box({x - 0.36, -0.02, -0.51}, {x + 0.36, 0.30, 0.51}));
    append(gate, make_box({x - 0.34, 2.18, -0.49}, {x + 0.34, 2.28, 0.49}));
  }
  append(gate, make_box({-0.13, 3.02, -0.52}, {0.13, 3.62, 0.52}));  // keystone
  append(gate, make_box({-1.53, 3.78, -0.53}, {1.53, 3.88, 0.53}));  // string course
  append(gate, make_box({-1.60, 4.09, -0.60}, {1.60, 4.27, 0.60}));  // cornice
  append(gate, make_box({-1.25, 4.26, -0.40}, {1.25, 4.62, 0.40}));  // attic
  return placed(gate, {0.0, kTerrace - kSunk, -kColonnadeRadius});
}

// ---------------------------------------------------------------- sculpture
Mesh make_pedestal() {
  std::vector<ProfilePoint> profile = {{0.0, 0.18}, {0.62, 0.18}, {0.62, 0.26}};
  add_torus(profile, 0.58, 0.28, 0.38);
  profile.insert(profile.end(), {{0.54, 0.42},
                                 {0.50, 0.50},
                                 {0.48, 0.62},
                                 {0.48, 0.92},
                                 {0.50, 1.00},
                                 {0.56, 1.06},
                                 {0.64, 1.09},
                                 {0.64, 1.17},
                                 {0.0, 1.17}});
  Mesh pedestal = make_box({-0.85, -kSunk, -0.85}, {0.85, 0.10, 0.85});
  append(pedestal, make_box({-0.72, 0.09, -0.72}, {0.72, 0.19, 0.72}));
  append(pedestal, make_lathe(profile, 64, kCreaseDeg));
  return placed(pedestal, {0.0, kTerrace, 0.0});
}

// Trefoil c(t) = (sin t + 2 sin 2t, cos t - 2 cos 2t, -sin 3t), upright, with a tube about it. Its curvature
// never vanishes, so the Frenet frame (tangent T, normal N, binormal B = T x N) is smooth and closes. With
// u turning from N to B and v along T, du x dv points along B x T = N at u = 0: outward.
Mesh make_knot() {
  constexpr double kThickness = 0.46;
  const auto surface = [](double u, double v) {
    const double t = 2.0 * kPi * v;
    const Vec3d centre(std::sin(t) + 2.0 * std::sin(2.0 * t), std::cos(t) - 2.0 * std::cos(2.0 * t),
                       -std::sin(3.0 * t));
    const Vec3d first(std::cos(t) + 4.0 * std::cos(2.0 * t), -std::sin(t) + 4.0 * std::sin(2.0 * t),
                      -3.0 * std::cos(3.0 * t));
    const Vec3d second(-std::sin(t) - 8.0 * std::sin(2.0 * t), -std::cos(t) + 8.0 * std::cos(2.0 * t),
                       9.0 * std::sin(3.0 * t));
    const Vec3d binormal = glm::normalize(glm::cross(first, second));
    const Vec3d normal = glm::cross(binormal, glm::normalize(first));
    const double phi = 2.0 * kPi * u;
    const double radius = kThickness * (1.0 + 0.07 * std::cos(3.0 * phi + 12.0 * t));  // a twisted strand
    return centre + radius * (std::cos(phi) * normal + std::sin(phi) * binormal);
  };
  return placed(make_tube(surface, 24, 240, Ends::joined), {0.0, kTerrace + 2.18, 0.0}, 0.36, 0.35);
}

// ---------------------------------------------------------------- planted urns
Mesh make_urn() {
  std::vector<ProfilePoint> profile = {{0.0, 0.15}};
  add_torus(profile, 0.26, 0.15, 0.23);
  profile.insert(
      profile.end(),
      {{0.16, 0.29}, {0.15, 0.36}, {0.22, 0.42}, {0.36, 0.52}, {0.46, 0.66}, {0.50, 0.82}, {0.50, 0.90}});
  add_torus(profile, 0.52, 0.91, 0.99);
  profile.insert(profile.end(), {{0.47, 0.99}, {0.45, 0.92}, {0.0, 0.92}});
  Mesh urn = make_box({-0.38, -kSunk, -0.38}, {0.38, 0.16, 0.38});
  append(urn, make_lathe(profile, 48, kCreaseDeg));
  return urn;
}

/// A clipped bush: a sphere with a bumpy radius.
Mesh make_bush() {
  Mesh bush = make_icosphere(4);
  for (Vec3& p : bush.positions) {
    const Vec3d d(p);
    const double bumps = std::sin(9.0 * d.x + 4.0 * d.y) * std::sin(11.0 * d.y - 3.0 * d.z) *
                             std::sin(10.0 * d.z + 5.0 * d.x) +
                         0.5 * std::sin(21.0 * d.x) * std::sin(19.0 * d.y) * std::sin(20.0 * d.z);
    p = Vec3(d * (0.56 * (1.0 + 0.10 * bumps)));
  }
  return smoothed(bush);
}

}  // namespace

Scene make_plaza() {
  Scene scene;
  const auto gravel = add_material(scene, {.name = "gravel", .albedo = Rgb(0.42F, 0.38F, 0.32F)});
  const auto limestone = add_material(scene, {.name = "limestone", .albedo = Rgb(0.60F, 0.57F, 0.50F)});
  const auto marble = add_material(scene, {.name = "marble", .albedo = Rgb(0.80F, 0.78F, 0.74F)});
  const auto brick = add_material(scene, {.name = "brick", .albedo = Rgb(0.62F, 0.34F, 0.24F)});
  const auto wood = add_material(scene, {.name = "wood", .albedo = Rgb(0.38F, 0.24F, 0.13F)});
  const auto gold = add_material(scene, {.name = "gilding", .albedo = Rgb(0.85F, 0.60F, 0.20F)});
  const auto clay = add_material(scene, {.name = "clay", .albedo = Rgb(0.70F, 0.38F, 0.26F)});
  const auto leaf = add_material(scene, {.name = "leaf", .albedo = Rgb(0.16F, 0.34F, 0.09F)});

  append(scene, make_grid({-18.0, 0.0, 18.0}, {36.0, 0.0, 0.0}, {0.0, 0.0, -36.0}, 64, 64), gravel);
  append(scene, make_terrace(), limestone);
  for (const Arc& arc : kArcs) {
    append(scene, make_colonnade(arc), marble);
    append(scene, make_bench(arc), wood);
  }
  append(scene, make_gate(), brick);
  append(scene, make_pedestal(), marble);
  append(scene, make_knot(), gold);
  const Mesh urn = make_urn();
  const Mesh bush = make_bush();
  for (const double x : {-3.2, 3.2}) {
    const Vec3d foot(x, 0.0, 6.8);
    append(scene, placed(urn, foot, 1.0, x), clay);
    append(scene, placed(bush, foot + Vec3d(0.0, 1.30, 0.0), 1.0, x), leaf);
  }
  scene.cameras.push_back(
      look_at({0.7F, 2.7F, 15.4F}, {0.0F, 1.9F, 0.0F}, {0.0F, 1.0F, 0.0F}, 37.0F, "front"));
  scene.cameras.push_back(
      look_at({-2.4F, 2.2F, 3.6F}, {0.1F, 2.4F, 0.0F}, {0.0F, 1.0F, 0.0F}, 42.0F, "sculpture"));
  return scene;
}

}  // namespace plumbline::scene
