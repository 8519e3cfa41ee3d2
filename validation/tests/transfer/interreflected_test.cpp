// Interreflected transfer by both solvers, against closed forms of validation/truth/multibounce.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../integrate/pieces.hpp"
#include "prt/sh/basis.hpp"
#include "prt/transfer/bake.hpp"
#include "reference/base/error.hpp"
#include "reference/scene/builtin.hpp"
#include "reference/scene/shapes.hpp"
#include "validation/metrics/statistics.hpp"
#include "validation/truth/multibounce.hpp"

namespace plumbline::transfer {
namespace {

constexpr double kWhite = 0.28209479177387814;  // 1/sqrt(4 pi): T_00 in a white furnace

BakeSettings settings_of(Solver solver, int bands, int samples, int bounces = kAllBounces, int terms = 0) {
  BakeSettings settings;
  settings.kind = Kind::interreflected;
  settings.method.solver = solver;
  settings.bands = bands;
  settings.samples = samples;
  settings.max_bounces = bounces;
  settings.kept_terms = terms;
  return settings;
}

/// Inside of the lower half of the unit sphere, open above. Its vertices lie on the sphere; the polygon of its rim has
/// 1 - 2 pi^2/(3 segments^2) of the circle's area.
scene::Mesh make_bowl_mesh(int rings, int segments) {
  scene::Mesh mesh;
  for (int i = 0; i <= rings; ++i) {
    for (int k = 0; k <= segments; ++k) {
      const double theta = 0.5 * kPi * i / rings;
      const Vec3d at = scene::around_y(std::sin(theta), -std::cos(theta), 2.0 * kPi * k / segments);
      mesh.positions.emplace_back(at);
      mesh.normals.emplace_back(-at);
    }
  }
  const auto place = [&](int i, int k) { return static_cast<std::uint32_t>(i * (segments + 1) + k); };
  for (int i = 0; i < rings; ++i) {
    for (int k = 0; k < segments; ++k) {
      if (i > 0) mesh.triangles.emplace_back(place(i, k), place(i, k + 1), place(i + 1, k));
      mesh.triangles.emplace_back(place(i, k + 1), place(i + 1, k + 1), place(i + 1, k));
    }
  }
  // Counter-clockwise seen from inside.
  const glm::uvec3 last = mesh.triangles.back();
  const Vec3 a = mesh.positions[last.x];
  const Vec3 normal = glm::cross(mesh.positions[last.y] - a, mesh.positions[last.z] - a);
  if (glm::dot(normal, mesh.normals[last.x]) < 0.0F) {
    for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  }
  return mesh;
}

constexpr int kRings = 16;
constexpr int kSegments = 64;

scene::Scene make_bowl(const Rgb& albedo, int rings = kRings, int segments = kSegments) {
  scene::Scene scene;
  const auto material = scene::add_material(scene, {.name = "bowl", .albedo = albedo});
  scene::append(scene, make_bowl_mesh(rings, segments), material);
  return scene;
}

/// Vertices of a bowl that are not on its rim, where half of the surroundings is missing.
std::size_t inner_vertices(int rings, int segments) {
  return static_cast<std::size_t>(rings * (segments + 1));
}

/// Floor z = 0 towards +y and wall y = 0 towards +z; three pairs of albedos at once, one a channel.
struct Corner {
  scene::Scene scene;
  Rgb floor{0.8F, 0.5F, 1.0F};
  Rgb wall{0.8F, 0.8F, 1.0F};

  explicit Corner(bool is_wall_flipped = false) {
    constexpr double kHalf = 1000.0;
    const auto floor_material = scene::add_material(scene, {.name = "floor", .albedo = floor});
    const auto wall_material =
        scene::add_material(scene, {.name = "wall", .albedo = wall, .is_double_sided = is_wall_flipped});
    scene::append(scene, scene::make_grid({-kHalf, 0, 0}, {2 * kHalf, 0, 0}, {0, kHalf, 0}, 1, 1),
                  floor_material);
    const scene::Mesh upright = scene::make_grid({-kHalf, 0, 0}, {0, 0, kHalf}, {2 * kHalf, 0, 0}, 1, 1);
    scene::append(scene, is_wall_flipped ? scene::inside_out(upright) : upright, wall_material);
  }
};

/// Bounce k alone, by channel.
truth::ThreeBands corner_term(const Corner& corner, int channel, int bounce) {
  const auto sum = [&](int bounces) {
    return truth::corner_transfer({0, 0, 1}, {0, 1, 0}, static_cast<double>(corner.floor[channel]),
                                  static_cast<double>(corner.wall[channel]), bounces);
  };
  truth::ThreeBands term = sum(bounce);
  if (bounce == 0) return term;
  const truth::ThreeBands before = sum(bounce - 1);
  for (std::size_t i = 0; i < term.size(); ++i) term[i] -= before[i];
  return term;
}

// M12, M10 and M2 in one: T = (D1 + F rho_wall D2)/(1 - F^2 rho_floor rho_wall). The quads' size leaves a form factor off by
// 0.568 d/W = 6e-5, the point's clearance of 1e-3 above the floor as little: 2e-4 of the vector's norm is allowed for both.
TEST(TracedTransfer, MatchesTheInfiniteCornerToAThousandth) {
  const Corner corner;
  const trace::RayCaster caster(corner.scene);
  const PointTerms point =
      interreflected_transfer(corner.scene, caster, trace::free_point({0, 0.1F, 0}, {0, 0, 1}),
                              settings_of(Solver::traced, 3, 1 << 22), 0);
  ASSERT_EQ(point.channels, 3);
  for (int c = 0; c < 3; ++c) {
    if (c == 2) {  // white: the sum is 1 whatever the place, the vectors follow from albedos just below 1
      EXPECT_LE(std::abs(point.total.coefficients[18] - kWhite),
                4.5 * point.total.standard_errors[18] + 2e-4 * kWhite);
      continue;
    }
    const truth::ThreeBands truth = truth::corner_transfer(
        {0, 0, 1}, {0, 1, 0}, static_cast<double>(corner.floor[c]), static_cast<double>(corner.wall[c]));
    double distance = 0.0;
    double norm = 0.0;
    double noise = 0.0;
    for (std::size_t i = 0; i < 9; ++i) {
      const std::size_t at = static_cast<std::size_t>(c) * 9 + i;
      distance += std::pow(point.total.coefficients[at] - truth[i], 2);
      noise += std::pow(point.total.standard_errors[at], 2);
      norm += truth[i] * truth[i];
    }
    EXPECT_LE(std::sqrt(distance / norm), 1e-3) << c;
    EXPECT_LE(std::sqrt(noise / norm), 4e-4) << c;
  }
  // The fault T <- (1 + K) T of two public codes: 5.06 instead of 1.94 at four bounces and rho F = 1/2. Here it is far outside.
  const truth::ThreeBands once = truth::corner_transfer({0, 0, 1}, {0, 1, 0}, 0.8, 0.8, 1);
  EXPECT_GT(std::abs(point.total.coefficients[0] - once[0]), 20.0 * 1e-3 * kWhite);
}

TEST(TracedTransfer, KeepsBouncesThatAreTheClosedFormsOnes) {
  for (const bool is_flipped : {false, true}) {
    const Corner corner(is_flipped);  // the back of a double-sided wall reflects like a front
    const trace::RayCaster caster(corner.scene);
    constexpr int kTerms = 9;
    const PointTerms point =
        interreflected_transfer(corner.scene, caster, trace::free_point({0, 0.1F, 0}, {0, 0, 1}),
                                settings_of(Solver::traced, 3, 1 << 19, kAllBounces, kTerms), 3);
    ASSERT_EQ(point.terms.size(), static_cast<std::size_t>(kTerms));
    double worst = 0.0;
    double worst_shifted = 0.0;
    for (int k = 0; k < kTerms; ++k) {
      const PointTransfer& term = point.terms[static_cast<std::size_t>(k)];
      for (int c = 0; c < 3; ++c) {
        const truth::ThreeBands truth = corner_term(corner, c, k);
        const truth::ThreeBands next = corner_term(corner, c, k + 1);
        for (std::size_t i = 0; i < 9; ++i) {
          const std::size_t at = static_cast<std::size_t>(c) * 9 + i;
          const double error = std::max(term.standard_errors[at], 1e-6);
          const double excess =
              std::max(0.0, std::abs(term.coefficients[at] - truth[i]) - 2e-4 * kWhite) / error;
          worst = excess <= worst ? worst : excess;
          worst_shifted = std::max(worst_shifted, std::abs(term.coefficients[at] - next[i]) / error);
        }
      }
    }
    // 243 values of Student's t with 15 degrees of freedom: 6.6 is passed by chance once in 10,000 such tests.
    EXPECT_LE(worst, 6.6) << is_flipped;
    EXPECT_GT(worst_shifted, 50.0);  // one bounce taken for the next is seen
  }
}

TEST(TracedTransfer, BackOfASingleSidedWallReflectsNothing) {
  Corner corner(true);
  corner.scene.materials[1].is_double_sided = false;
  const trace::RayCaster caster(corner.scene);
  const PointTerms point =
      interreflected_transfer(corner.scene, caster, trace::free_point({0, 0.1F, 0}, {0, 0, 1}),
                              settings_of(Solver::traced, 3, 1 << 12, 4, 5), 0);
  for (std::size_t k = 1; k < 5; ++k) {
    for (const double value : point.terms[k].coefficients) EXPECT_EQ(value, 0.0);
  }
  EXPECT_GT(point.terms[0].coefficients[0], 0.1);
}

TEST(TracedTransfer, TakesAlbedoFromTextures) {
  Corner corner;
  scene::Texture texture;
  texture.image = image::make_image(1, 1);
  texture.image.at(0, 0) = Rgb(0.25F, 0.5F, 1.0F);
  corner.scene.textures.push_back(texture);
  corner.scene.materials[1].albedo = Rgb(0.8F);
  corner.scene.materials[1].albedo_texture = 0;
  corner.scene.texcoords.assign(corner.scene.positions.size(), Vec2(0.5F));
  corner.scene.materials[0].albedo = Rgb(0.8F);
  const trace::RayCaster caster(corner.scene);
  const PointTerms point =
      interreflected_transfer(corner.scene, caster, trace::free_point({0, 0.1F, 0}, {0, 0, 1}),
                              settings_of(Solver::traced, 1, 1 << 18, 1, 2), 0);
  for (int c = 0; c < 3; ++c) {
    const double wall = 0.8 * std::pow(2.0, c - 2);
    const double truth = 0.25 * wall * kWhite;  // F (1 - F) rho_wall T_00
    const auto at = static_cast<std::size_t>(c);
    EXPECT_LE(std::abs(point.terms[1].coefficients[at] - truth),
              4.5 * point.terms[1].standard_errors[at] + 2e-4 * kWhite)
        << c;
  }
}

/// Relative allowance for the bowl's polygon: the rim's share, and half of it for every bounce's sky once more.
double bowl_allowance(int bounce) {
  return (1.0 + bounce) * 2.0 * kPi * kPi / (3.0 * kSegments * kSegments);
}

// M16: in a bowl under a uniform sky bounce k gives T_00 = f (rho (1 - f))^k / sqrt(4 pi) with f = 1/2 at every point, so that
// interpolation between vertices costs nothing.
TEST(IterativeTransfer, KeepsBouncesThatAreTheBowlsOnes) {
  const scene::Scene scene = make_bowl(Rgb(0.8F, 0.5F, 1.0F));
  constexpr int kTerms = 7;
  const Transfer baked = bake(scene, settings_of(Solver::iterative, 2, 512, kTerms - 1, kTerms));
  ASSERT_EQ(baked.channels, 3);
  ASSERT_EQ(baked.terms.size(), static_cast<std::size_t>(kTerms));
  const double albedo[] = {0.8, 0.5, 1.0};
  for (int k = 0; k < kTerms; ++k) {
    for (int c = 0; c < 3; ++c) {
      const double truth = truth::neumann_term(0.5 * kWhite, albedo[c], 0.5, k);
      double mean = 0.0;
      const std::size_t vertices = inner_vertices(kRings, kSegments);
      for (std::size_t v = 0; v < vertices; ++v) {
        mean +=
            static_cast<double>(baked.row_of(baked.terms[static_cast<std::size_t>(k)].coefficients, v, c)[0]);
      }
      mean /= static_cast<double>(vertices);
      // Noise of the mean over 1040 vertices is below 1e-3/sqrt(1040) of it.
      EXPECT_LE(std::abs(mean / truth - 1.0), bowl_allowance(k) + 2e-4) << k << ' ' << c;
      // What T <- (1 + K) T adds at bounce k is binomial: seen from k = 2 on.
      if (k == 2) {
        EXPECT_GT(std::abs(mean / (2.0 * truth) - 1.0), 10.0 * bowl_allowance(k));
      }
    }
  }
}

// M6 for all bounces, and M2: with albedo 1 every open scene is a white furnace.
TEST(IterativeTransfer, SumsAllBounces) {
  const scene::Scene scene = make_bowl(Rgb(0.8F, 0.5F, 1.0F));
  const Transfer baked = bake(scene, settings_of(Solver::iterative, 1, 256));
  EXPECT_GT(baked.remainder, 0.0);
  EXPECT_LE(baked.remainder, 1e-4 * kWhite);
  const double albedo[] = {0.8, 0.5, 1.0};
  for (int c = 0; c < 3; ++c) {
    const double truth = kWhite * truth::neumann_sum(0.5, albedo[c], 0.5, truth::kAllBounces);
    double mean = 0.0;
    const std::size_t vertices = inner_vertices(kRings, kSegments);
    for (std::size_t v = 0; v < vertices; ++v) mean += static_cast<double>(baked.vector(v, c)[0]);
    mean /= static_cast<double>(vertices);
    EXPECT_LE(std::abs(mean / truth - 1.0), bowl_allowance(1) + 4e-4) << c;
  }
}

TEST(InterreflectedTransfer, SolversAgreeWithinNoise) {
  const scene::Scene scene = make_bowl(Rgb(0.8F, 0.5F, 0.2F), 12, 48);
  const Transfer traced = bake(scene, settings_of(Solver::traced, 3, 512, 3));
  const Transfer iterative = bake(scene, settings_of(Solver::iterative, 3, 512, 3));
  ASSERT_EQ(traced.coefficients.size(), iterative.coefficients.size());
  const std::size_t vertices = inner_vertices(12, 48);
  for (int c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < 9; ++i) {
      double difference = 0.0;
      double variance = 0.0;
      for (std::size_t v = 0; v < vertices; ++v) {
        difference += static_cast<double>(traced.vector(v, c)[i] - iterative.vector(v, c)[i]);
        variance += std::pow(static_cast<double>(traced.row_of(traced.standard_errors, v, c)[i]), 2) +
                    std::pow(static_cast<double>(iterative.row_of(iterative.standard_errors, v, c)[i]), 2);
      }
      // Interpolation of what is linear over the sphere errs by less than h^2/2 = 2e-3 of it, h the rings' 1/12 quarter turn
      // over two; of the indirect part, below 0.6 of the whole.
      EXPECT_LE(std::abs(difference),
                4.5 * std::sqrt(variance) + 1.2e-3 * kWhite * static_cast<double>(vertices))
          << c << ' ' << i;
    }
  }
}

TEST(InterreflectedTransfer, OpenWhiteScenesAreFurnaces) {
  scene::Scene scene = scene::make_builtin_scene("open-box");
  for (scene::Material& material : scene.materials) material.albedo = Rgb(1.0F);
  const trace::RayCaster caster(scene);
  const std::vector<trace::SurfacePoint> points = trace::vertex_points(scene);
  for (const std::size_t v : {std::size_t{30}, std::size_t{700}, std::size_t{2000}}) {
    const PointTerms point =
        interreflected_transfer(scene, caster, points[v], settings_of(Solver::traced, 1, 1 << 12), v);
    EXPECT_EQ(point.channels, 1);
    EXPECT_LE(std::abs(point.total.coefficients[0] - kWhite), 5.0 * point.total.standard_errors[0] + 1e-6);
    EXPECT_LE(point.total.standard_errors[0], 0.02 * kWhite);
  }
}

// No light from afar gets in, and whatever the albedo nothing ever bounces.
TEST(InterreflectedTransfer, ClosedWhiteRoomIsDark) {
  scene::Scene scene = scene::make_builtin_scene("box-furnace");
  for (scene::Material& material : scene.materials) material.albedo = Rgb(1.0F);
  for (const Solver solver : {Solver::iterative, Solver::traced}) {
    const Transfer baked = bake(scene, settings_of(solver, 2, 64));
    EXPECT_EQ(baked.remainder, 0.0);
    for (const float value : baked.coefficients) EXPECT_EQ(value, 0.0F);
  }
}

// A hundredth of one wall of six is open: after 1000 bounces (1 - 1/600)^1000 = 0.19 of the light is still inside.
TEST(IterativeTransfer, RefusesLightThatHardlyLeaves) {
  const scene::Scene closed = scene::make_builtin_scene("box-furnace");
  scene::Scene scene = closed;
  scene.materials[0].albedo = Rgb(1.0F);
  scene.triangles.clear();
  scene.triangle_materials.clear();
  for (std::uint32_t t = 0; t < closed.triangles.size(); ++t) {
    if (scene::geometric_normal(closed, t).z < -0.5F) continue;  // the wall z = 1
    scene.triangles.push_back(closed.triangles[t]);
    scene.triangle_materials.push_back(0);
  }
  scene::Mesh wall = scene::make_grid({-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, 10, 10);
  wall.triangles.erase(wall.triangles.begin() + 90, wall.triangles.begin() + 92);  // a cell near the middle
  scene::append(scene, wall, 0);
  BakeSettings endless = settings_of(Solver::iterative, 1, 1024);
  endless.threads = 1;
  EXPECT_THROW((void)bake(scene, endless), InputError);
  EXPECT_NO_THROW((void)bake(scene, settings_of(Solver::iterative, 1, 64, 3)));
}

TEST(InterreflectedTransfer, TermsAddUpAndBounceZeroIsShadowed) {
  const scene::Scene scene = make_bowl(Rgb(0.7F), 6, 24);
  BakeSettings direct = settings_of(Solver::traced, 3, 256);
  direct.kind = Kind::shadowed;
  direct.kept_terms = 1;
  const Transfer shadowed = bake(scene, direct);
  EXPECT_EQ(shadowed.terms.front().coefficients, shadowed.coefficients);
  for (const Solver solver : {Solver::traced, Solver::iterative}) {
    const Transfer baked = bake(scene, settings_of(solver, 3, 256, 3, 100));
    EXPECT_EQ(baked.channels, 1);
    EXPECT_EQ(baked.bounces, 3);
    ASSERT_EQ(baked.terms.size(), 4U);
    for (std::size_t i = 0; i < baked.coefficients.size(); ++i) {
      float sum = 0.0F;
      for (const Term& term : baked.terms) sum += term.coefficients[i];
      EXPECT_LE(std::abs(sum - baked.coefficients[i]), 1e-6F) << i;
      // The same rays; closest hits and occlusion may differ in what they see through an edge.
      EXPECT_LE(std::abs(baked.terms[0].coefficients[i] - shadowed.coefficients[i]), 2e-3F) << i;
    }
    const Transfer none = bake(scene, settings_of(solver, 3, 256, 0));
    EXPECT_EQ(none.coefficients, baked.terms[0].coefficients);
  }
}

TEST(InterreflectedTransfer, DependsOnSeedAndNotOnThreads) {
  const scene::Scene scene = make_bowl(Rgb(0.8F, 0.5F, 0.2F), 6, 24);
  for (const Solver solver : {Solver::traced, Solver::iterative}) {
    BakeSettings settings = settings_of(solver, 3, 64, 3, 2);
    settings.threads = 1;
    const Transfer one = bake(scene, settings);
    settings.threads = 2;
    const Transfer two = bake(scene, settings);
    EXPECT_EQ(one.coefficients, two.coefficients);
    EXPECT_EQ(one.standard_errors, two.standard_errors);
    EXPECT_EQ(one.terms, two.terms);
    settings.seed = 1;
    EXPECT_NE(one.coefficients, bake(scene, settings).coefficients);
  }
}

// The sixteen sets are solved apart, so that what they say of the error holds for the light of all bounces.
TEST(InterreflectedTransfer, StandardErrorsAreHonest) {
  const scene::Scene scene = make_bowl(Rgb(0.9F), 4, 12);
  constexpr std::size_t kSeeds = 200;
  for (const Solver solver : {Solver::traced, Solver::iterative}) {
    BakeSettings settings = settings_of(solver, 2, 256, 4);
    settings.threads = 1;  // so little work that handing it out takes longer
    std::vector<Transfer> bakes;
    for (settings.seed = 0; settings.seed < kSeeds; ++settings.seed) bakes.push_back(bake(scene, settings));
    std::vector<double> p;
    for (const std::size_t vertex : {0U, 14U, 17U, 30U}) {
      for (const std::size_t i : {0U, 2U}) {
        double mean = 0.0;
        for (const Transfer& b : bakes) mean += static_cast<double>(b.vector(vertex, 0)[i]) / kSeeds;
        // Every seed is held against the mean of the others.
        for (const Transfer& b : bakes) {
          const auto value = static_cast<double>(b.vector(vertex, 0)[i]);
          const double others = (mean * kSeeds - value) / (kSeeds - 1);
          p.push_back(metrics::two_sided_p_student(
              (value - others) / static_cast<double>(b.row_of(b.standard_errors, vertex, 0)[i]), 15));
        }
      }
    }
    EXPECT_GE(metrics::kolmogorov_smirnov_uniform(p).p, 1e-4) << to_string(solver);
    // Errors stated at half their size would be found out.
    std::vector<double> wrong;
    for (const double value : p) wrong.push_back(value * 0.5);
    EXPECT_LE(metrics::kolmogorov_smirnov_uniform(wrong).p, 1e-4);
  }
}

/// A small plate at the bottom of a bowl whose front is outside.
TEST(InterreflectedTransfer, BacksOfDoubleSidedSurfacesReflect) {
  for (const bool is_double_sided : {true, false}) {
    scene::Scene scene;
    const auto bowl =
        scene::add_material(scene, {.name = "bowl", .albedo = Rgb(0.8F), .is_double_sided = is_double_sided});
    const auto plate = scene::add_material(scene, {.name = "plate", .albedo = Rgb(0.8F)});
    scene::append(scene, scene::inside_out(make_bowl_mesh(kRings, kSegments)), bowl);
    const auto first = scene.positions.size();
    scene::append(scene, scene::make_grid({-0.02, -0.99, 0.02}, {0.04, 0, 0}, {0, 0, -0.04}, 1, 1), plate);
    for (const Solver solver : {Solver::traced, Solver::iterative}) {
      const Transfer baked = bake(scene, settings_of(solver, 1, 1 << 10, 2, 3));
      for (std::size_t k = 0; k < 3; ++k) {
        double mean = 0.0;
        double error = 0.0;
        for (std::size_t v = first; v < baked.vertices; ++v) {
          mean += 0.25 * static_cast<double>(baked.terms[k].coefficients[v]);
          error += 0.25 * static_cast<double>(baked.terms[k].standard_errors[v]);
        }
        const double truth = truth::neumann_term(0.5 * kWhite, is_double_sided || k == 0 ? 0.8 : 0.0, 0.5,
                                                 static_cast<int>(k));
        // The plate lies 1/100 above the bottom: it sees that much more of the sky.
        EXPECT_LE(std::abs(mean - truth), 0.01 * truth + 4.5 * error + 1e-9)
            << is_double_sided << ' ' << to_string(solver) << ' ' << k;
      }
    }
  }
}

TEST(InterreflectedTransfer, HasAsManyChannelsAsItNeeds) {
  scene::Scene convex = scene::make_builtin_scene("convex");
  convex.materials[0].albedo = Rgb(0.8F, 0.4F, 0.2F);  // colour that nothing sees
  for (const Solver solver : {Solver::traced, Solver::iterative}) {
    EXPECT_EQ(bake(convex, settings_of(solver, 2, 64)).channels, 1);
    EXPECT_EQ(bake(make_bowl(Rgb(0.8F), 4, 12), settings_of(solver, 2, 64)).channels, 1);
    EXPECT_EQ(bake(make_bowl(Rgb(0.8F, 0.8F, 0.7F), 4, 12), settings_of(solver, 2, 64)).channels, 3);
  }
}

TEST(InterreflectedTransfer, RefusesWhatItCannotDo) {
  const scene::Scene scene = scene::make_builtin_scene("corner");
  EXPECT_THROW((void)bake(scene, settings_of(Solver::traced, 3, 64, -1)), InputError);
  EXPECT_THROW((void)bake(scene, settings_of(Solver::iterative, 3, 64, 1, -1)), InputError);
  EXPECT_THROW((void)bake(scene::make_builtin_scene("bowl"), settings_of(Solver::iterative, 3, 64)),
               InputError);
}

}  // namespace
}  // namespace plumbline::transfer
