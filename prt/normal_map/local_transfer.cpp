#include "prt/normal_map/local_transfer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "prt/sh/basis.hpp"
#include "prt/sh/quadrature.hpp"
#include "prt/sh/rotation.hpp"
#include "prt/transfer/directions.hpp"
#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"
#include "reference/scene/normal_map.hpp"
#include "reference/trace/ray_caster.hpp"
#include "reference/trace/surface_point.hpp"

namespace plumbline::normal_map {
namespace {

constexpr int kShifts = 16;
constexpr int kMostSamples = 1 << 26;

std::size_t light_count(int bands) {
  return static_cast<std::size_t>(sh::coefficient_count(bands));
}

void require_valid(const LocalBakeSettings& settings) {
  sh::require_bands(settings.bands);
  if (settings.samples < kShifts || settings.samples > kMostSamples) {
    throw InputError(
        fmt::format("samples: expected {} to {}, got {}", kShifts, kMostSamples, settings.samples));
  }
}

void require_nine_rows(const LocalTransfer& transfer) {
  if (transfer.rows != static_cast<int>(kQuadraticCount)) {
    throw InputError(fmt::format("normal-mapped transfer: expected 9 rows, got {}", transfer.rows));
  }
}

LocalTransfer make_transfer(int rows, int bands, std::size_t vertices) {
  return {rows, bands, vertices,
          std::vector<float>(vertices * static_cast<std::size_t>(rows) * light_count(bands))};
}

/// Uniform over the hemisphere about a unit normal: z = u.y, azimuth 2 pi u.x.
Vec3d hemisphere_direction(const Vec3d& normal, const glm::dvec2& u) {
  const double sine = std::sqrt(std::max(0.0, 1.0 - u.y * u.y));
  const double azimuth = 2.0 * kPi * u.x;
  const Vec3d helper = std::abs(normal.x) < 0.5 ? Vec3d(1.0, 0.0, 0.0) : Vec3d(0.0, 1.0, 0.0);
  const Vec3d tangent = glm::normalize(glm::cross(helper, normal));
  return sine * std::cos(azimuth) * tangent + sine * std::sin(azimuth) * glm::cross(normal, tangent) +
         u.y * normal;
}

/// sum += values(first 9) x values, the outer product of one direction.
void add_product(const std::vector<double>& light, const Quadratic& local, std::vector<double>& sum) {
  const std::size_t n = light.size();
  for (std::size_t j = 0; j < kQuadraticCount; ++j) {
    double* row = sum.data() + j * n;
    for (std::size_t i = 0; i < n; ++i) row[i] += local[j] * light[i];
  }
}

class PointBaker {
 public:
  PointBaker(const trace::RayCaster& caster, const LocalBakeSettings& settings)
      : caster_(caster), settings_(settings), basis_(std::max(settings.bands, kQuadraticBands)) {}

  /// The 9 x bands^2 matrix of one point.
  [[nodiscard]] std::vector<double> operator()(const trace::SurfacePoint& point, std::uint64_t stream) const {
    const std::size_t count = light_count(settings_.bands);
    std::vector<double> all(light_count(basis_.bands()));
    std::vector<double> light(count);
    std::vector<double> sum(kQuadraticCount * count, 0.0);
    Quadratic local{};
    const int per_shift = settings_.samples / kShifts;
    for (std::uint32_t r = 0; r < kShifts; ++r) {
      const glm::dvec2 shift = transfer::random_shift(settings_.seed, stream, r);
      for (int s = 0; s < per_shift; ++s) {
        const glm::dvec2 u = transfer::shifted_sequence_point(static_cast<std::uint64_t>(s), shift);
        const Vec3d direction = hemisphere_direction(Vec3d(point.geometric_normal), u);
        const Vec3 ray(glm::normalize(Vec3(direction)));
        if (!(glm::dot(ray, point.geometric_normal) > 0.0F)) continue;
        if (caster_.is_occluded({trace::ray_origin(point, ray), ray})) continue;
        basis_.evaluate(direction.x, direction.y, direction.z, all);
        std::copy_n(all.begin(), count, light.begin());
        std::copy_n(all.begin(), kQuadraticCount, local.begin());
        add_product(light, local, sum);
      }
    }
    for (double& value : sum) value *= 2.0 * kPi / (kShifts * per_shift);
    return sum;
  }

 private:
  const trace::RayCaster& caster_;
  const LocalBakeSettings& settings_;
  sh::Basis<double> basis_;
};

/// rows_out[r] = sum_j coefficients[r][j] rows_in[j], for the matrix of one vertex.
void combine(std::span<const float> in, std::span<const Quadratic> coefficients, std::size_t count,
             float* out) {
  for (std::size_t r = 0; r < coefficients.size(); ++r) {
    for (std::size_t i = 0; i < count; ++i) {
      double sum = 0.0;
      for (std::size_t j = 0; j < kQuadraticCount; ++j)
        sum += coefficients[r][j] * static_cast<double>(in[j * count + i]);
      out[r * count + i] = static_cast<float>(sum);
    }
  }
}

LocalTransfer combined(const LocalTransfer& in, std::span<const Quadratic> coefficients) {
  require_nine_rows(in);
  LocalTransfer result = make_transfer(static_cast<int>(coefficients.size()), in.bands, in.vertices);
  const std::size_t count = light_count(in.bands);
  for (std::size_t v = 0; v < in.vertices; ++v) {
    combine(in.matrix(v), coefficients, count, result.matrices.data() + v * coefficients.size() * count);
  }
  return result;
}

/// Rows of R: local coefficient r of a function that has the world coefficients j. World axes seen from the frame are the columns of
/// the inverse of [tangent, bitangent, normal].
std::array<Quadratic, kQuadraticCount> rotation_rows(const scene::TangentFrame& frame) {
  const glm::dmat3 to_world(Vec3d(frame.tangent), Vec3d(frame.bitangent), Vec3d(frame.normal));
  const sh::Rotation to_local(sh::RotationMatrix(glm::transpose(to_world)), kQuadraticBands);
  std::array<Quadratic, kQuadraticCount> rows{};
  Quadratic unit{};
  Quadratic column{};
  for (std::size_t j = 0; j < kQuadraticCount; ++j) {
    unit.fill(0.0);
    unit[j] = 1.0;
    to_local.apply(std::span<const double>(unit), std::span<double>(column));
    for (std::size_t r = 0; r < kQuadraticCount; ++r) rows[r][j] = column[r];
  }
  return rows;
}

const std::array<Vec3d, 3>& half_life_2_directions() {
  static const double third = std::sqrt(1.0 / 3.0);
  static const std::array<Vec3d, 3> directions = {Vec3d(std::sqrt(2.0 / 3.0), 0.0, third),
                                                  Vec3d(-std::sqrt(1.0 / 6.0), std::sqrt(0.5), third),
                                                  Vec3d(-std::sqrt(1.0 / 6.0), -std::sqrt(0.5), third)};
  return directions;
}

// Minimise the integral of n.z |sum_k c_k p_k(n) - sum_j A_j(n) q_j|^2: c = G^-1 B q with G_kl = <p_k, p_l>, B_kj = <p_k, A_j>. The
// functions have kinks in their second derivative only, so that 64 x 128 nodes leave errors of about (1/64)^3.
std::vector<Quadratic> fit_half_life_2() {
  constexpr int kHeights = 64;
  constexpr int kAzimuths = 128;
  const sh::GaussLegendre gauss = sh::gauss_legendre(kHeights);
  glm::dmat3 gram(0.0);
  std::array<Vec3d, kQuadraticCount> moments{};
  for (std::size_t i = 0; i < gauss.nodes.size(); ++i) {
    const double z = 0.5 * (gauss.nodes[i] + 1.0);
    const double sine = std::sqrt(1.0 - z * z);
    for (int j = 0; j < kAzimuths; ++j) {
      const double azimuth = 2.0 * kPi * (j + 0.5) / kAzimuths;
      const Vec3d normal(sine * std::cos(azimuth), sine * std::sin(azimuth), z);
      const Vec3d p = gauss.weights[i] * z * half_life_2_functions(normal);
      const Quadratic row = reflected(normal);
      gram += glm::outerProduct(p, half_life_2_functions(normal));
      for (std::size_t c = 0; c < kQuadraticCount; ++c) moments[c] += row[c] * p;
    }
  }
  const glm::dmat3 inverse = glm::inverse(gram);
  std::vector<Quadratic> rows(3, Quadratic{});
  for (std::size_t c = 0; c < kQuadraticCount; ++c) {
    const Vec3d fitted = inverse * moments[c];
    for (int k = 0; k < 3; ++k) rows[static_cast<std::size_t>(k)][c] = fitted[k];
  }
  return rows;
}

}  // namespace

std::span<const float> LocalTransfer::matrix(std::size_t vertex) const {
  const std::size_t size = static_cast<std::size_t>(rows) * light_count(bands);
  return std::span(matrices).subspan(vertex * size, size);
}

LocalTransfer bake_incident_radiance(const scene::Scene& scene, const LocalBakeSettings& settings) {
  require_valid(settings);
  scene::refuse_primitives(scene, "normal-mapped transfer");
  LocalTransfer result =
      make_transfer(static_cast<int>(kQuadraticCount), settings.bands, scene.positions.size());
  const trace::RayCaster caster(scene);
  const std::vector<trace::SurfacePoint> points = trace::vertex_points(scene);
  const PointBaker bake_point(caster, settings);
  const std::size_t size = kQuadraticCount * light_count(settings.bands);
  constexpr std::size_t kBlock = 64;
  const std::size_t blocks = (points.size() + kBlock - 1) / kBlock;
  std::atomic<std::size_t> done{0};
  parallel_for(blocks, settings.threads, [&](std::size_t block) {
    for (std::size_t v = block * kBlock; v < std::min(points.size(), (block + 1) * kBlock); ++v) {
      const std::vector<double> matrix = bake_point(points[v], v);
      std::transform(matrix.begin(), matrix.end(),
                     result.matrices.begin() + static_cast<std::ptrdiff_t>(v * size),
                     [](double value) { return static_cast<float>(value); });
    }
    if (settings.progress)
      settings.progress(static_cast<double>(done.fetch_add(1) + 1) / static_cast<double>(blocks));
  });
  return result;
}

LocalTransfer in_tangent_frames(const LocalTransfer& world, const scene::Scene& scene) {
  require_nine_rows(world);
  if (scene.tangents.size() != world.vertices || scene.normals.size() != world.vertices) {
    throw InputError(fmt::format("normal-mapped transfer: {} vertices, the scene has {} tangents",
                                 world.vertices, scene.tangents.size()));
  }
  LocalTransfer result = make_transfer(world.rows, world.bands, world.vertices);
  const std::size_t count = light_count(world.bands);
  for (std::uint32_t v = 0; v < world.vertices; ++v) {
    const std::optional<scene::TangentFrame> frame =
        scene::tangent_frame(scene, {v, v, v}, {1.0F, 0.0F, 0.0F}, scene.normals[v]);
    if (!frame)
      throw InputError(fmt::format("normal-mapped transfer: the tangent of vertex {} is its normal", v));
    const auto rows = rotation_rows(*frame);
    combine(world.matrix(v), rows, count, result.matrices.data() + v * kQuadraticCount * count);
  }
  return result;
}

LocalTransfer compressed(const LocalTransfer& tangent, const NormalBasis& basis, int terms) {
  (void)energy_kept(basis, terms);  // the range of terms
  std::vector<Quadratic> rows;
  for (int k = 0; k < terms; ++k) rows.push_back(light_row(basis, k));
  return combined(tangent, rows);
}

LocalTransfer half_life_2(const LocalTransfer& tangent) {
  std::vector<Quadratic> rows;
  for (const Vec3d& direction : half_life_2_directions()) rows.push_back(reflected(direction));
  return combined(tangent, rows);
}

LocalTransfer half_life_2_fitted(const LocalTransfer& tangent) {
  return combined(tangent, fit_half_life_2());
}

std::vector<Rgb> lit_rows(const LocalTransfer& transfer, const sh::ShRgb& lighting) {
  if (lighting.bands < transfer.bands) {
    throw InputError(
        fmt::format("lighting: {} bands are fewer than the transfer's {}", lighting.bands, transfer.bands));
  }
  const std::size_t count = light_count(transfer.bands);
  std::vector<Rgb> result;
  result.reserve(transfer.matrices.size() / std::max<std::size_t>(1, count));
  for (std::size_t row = 0; row * count < transfer.matrices.size(); ++row) {
    RgbD sum(0.0);
    for (std::size_t i = 0; i < count; ++i) {
      sum += static_cast<double>(transfer.matrices[row * count + i]) * lighting.coefficients[i];
    }
    result.emplace_back(sum);
  }
  return result;
}

Vec3d half_life_2_functions(const Vec3d& normal) {
  Vec3d values(0.0);
  for (int k = 0; k < 3; ++k) {
    const double cosine =
        std::max(0.0, glm::dot(normal, half_life_2_directions()[static_cast<std::size_t>(k)]));
    values[k] = cosine * cosine;
  }
  return values;
}

Vec3d half_life_2_weights(const Vec3d& normal) {
  const Vec3d values = half_life_2_functions(normal);
  return values / (values.x + values.y + values.z);
}

}  // namespace plumbline::normal_map
