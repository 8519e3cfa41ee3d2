// Projection of cube maps with constant texels: project_cube_faces of projection_parts.hpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "prt/sh/aligned.hpp"
#include "prt/sh/batch.hpp"
#include "prt/sh/moment_kernels.hpp"
#include "prt/sh/projection_parts.hpp"
#include "prt/sh/quadrature.hpp"

namespace plumbline::sh {
namespace {

// Every face has, in its own frame (s to the right, t downwards, 1 outwards), the same integrals of y_lm over its texels,
// and under s -> -s and t -> -t each y_lm is even or odd. So the integrals are needed for a quarter of one face only:
// the four mirror images of a texel are first added and subtracted to their four even and odd parts. The faces'
// coefficients are then turned into the world's frame.

/// 0: even in s and t, 1: odd in s, 2: odd in t, 3: odd in both. (-s + it)^m = (-1)^m conj((s + it)^m).
std::size_t parity_of(int m) {
  const bool is_odd_in_t = m < 0;
  const bool is_odd_in_s = (m % 2 != 0) != is_odd_in_t;
  return (is_odd_in_s ? 1U : 0U) + (is_odd_in_t ? 2U : 0U);
}

/// The frame of face 0 … 5 (+X -X +Y -Y +Z -Z): columns are where s, t and 1 point.
Matrix face_frame(std::size_t face) {
  switch (face) {
    case 0:
      return Matrix(Vec3d(0, 0, -1), Vec3d(0, -1, 0), Vec3d(1, 0, 0));
    case 1:
      return Matrix(Vec3d(0, 0, 1), Vec3d(0, -1, 0), Vec3d(-1, 0, 0));
    case 2:
      return Matrix(Vec3d(1, 0, 0), Vec3d(0, 0, 1), Vec3d(0, 1, 0));
    case 3:
      return Matrix(Vec3d(1, 0, 0), Vec3d(0, 0, -1), Vec3d(0, -1, 0));
    case 4:
      return Matrix(Vec3d(1, 0, 0), Vec3d(0, -1, 0), Vec3d(0, 0, 1));
    default:
      return Matrix(Vec3d(-1, 0, 0), Vec3d(0, -1, 0), Vec3d(0, 0, -1));
  }
}

/// One quarter of a face of size x size texels: the first `half` rows and columns, the middle ones included.
struct Quarter {
  int size = 0;
  std::size_t half = 0;
  std::size_t count = 0;  // half, padded
  // The count and one cache line: rows do not share their places in the cache.
  std::size_t stride = 0;
  std::vector<double> corners;  // solid angle between the face's centre and corner (x, y), symmetric: [y][x]

  explicit Quarter(int face_size)
      : size(face_size),
        half((static_cast<std::size_t>(face_size) + 1) / 2),
        count(padded(half)),
        stride(count + 8) {
    const std::size_t width = half + 1;
    corners.resize(width * width);
    for (std::size_t y = 0; y < width; ++y) {
      for (std::size_t x = 0; x <= y; ++x) {
        const double u = edge(x);
        const double v = edge(y);
        corners[y * width + x] = corners[x * width + y] = std::atan2(u * v, std::sqrt(u * u + v * v + 1.0));
      }
    }
  }
  [[nodiscard]] double edge(std::size_t i) const { return 2.0 * static_cast<double>(i) / size - 1.0; }
  [[nodiscard]] double solid_angle(std::size_t x, std::size_t y) const {
    const std::size_t width = half + 1;
    const double* corner = corners.data() + y * width + x;
    return corner[0] - corner[1] - corner[width] + corner[width + 1];
  }
};

/// The coefficients, those of one parity after the other.
struct Groups {
  std::vector<std::size_t> indices;     // by place
  std::vector<std::size_t> places;      // by index
  std::array<std::size_t, 5> firsts{};  // places where the parities start, and their number

  explicit Groups(int bands) : places(static_cast<std::size_t>(coefficient_count(bands))) {
    for (std::size_t parity = 0; parity < 4; ++parity) {
      firsts[parity] = indices.size();
      for (int l = 0; l < bands; ++l) {
        for (int m = -l; m <= l; ++m) {
          if (parity_of(m) != parity) continue;
          places[static_cast<std::size_t>(index(l, m))] = indices.size();
          indices.push_back(static_cast<std::size_t>(index(l, m)));
        }
      }
    }
    firsts[4] = indices.size();
  }
};

/// integrals[place][x] over the texels of row y of a quarter; what is beside the row is 0. Made for 16 texels at a time,
/// so that the nodes' values stay in the first-level cache.
class RowIntegrals {
 public:
  RowIntegrals(const Quarter& quarter, const GaussLegendre& rule, const BatchBasis<double>& basis,
               const Groups& groups)
      : quarter_(quarter),
        rule_(rule),
        basis_(basis),
        groups_(groups),
        width_(rule.nodes.size() * kBlockDirections),
        together_(std::max<std::size_t>(1, kNumbersTogether / (width_ * groups.indices.size()))) {
    const std::size_t blocks = quarter.count / kBlockDirections;
    for (auto* values : {&s_, &ds_}) values->resize(width_ * blocks);
    for (auto* values : {&x_, &y_, &z_, &weight_}) values->resize(width_ * rule.nodes.size());
    values_.resize(blocked_size(basis.bands(), width_ * std::min(together_, rule.nodes.size())));
    table_.resize(groups.indices.size() * quarter.stride);
    for (std::size_t x = 0; x < quarter.count; ++x) {
      for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
        const std::size_t at = x / kBlockDirections * width_ + i * kBlockDirections + x % kBlockDirections;
        s_[at] = quarter.edge(x) + (1.0 + rule.nodes[i]) / quarter.size;
        ds_[at] = x < quarter.half ? rule.weights[i] : 0.0;
      }
    }
  }

  void make(std::size_t row) {
    for (std::size_t x = 0; x < quarter_.count; x += kBlockDirections) make_block(row, x);
  }
  [[nodiscard]] const double* of(std::size_t place) const { return table_.data() + place * quarter_.stride; }

 private:
  static constexpr std::size_t kNumbersTogether = 2048;

  void make_block(std::size_t row, std::size_t x) {
    const std::size_t from = x * rule_.nodes.size();
    for (std::size_t j = 0; j < rule_.nodes.size(); ++j) {
      const double t = quarter_.edge(row) + (1.0 + rule_.nodes[j]) / quarter_.size;
      const std::size_t to = j * width_;
      face_nodes(s_.data() + from, ds_.data() + from, t, rule_.weights[j], width_, x_.data() + to,
                 y_.data() + to, z_.data() + to, weight_.data() + to);
    }
    std::array<double, kBlockDirections> solid_angles{};
    for (std::size_t u = 0; u < kBlockDirections && x + u < quarter_.half; ++u) {
      solid_angles[u] = quarter_.solid_angle(x + u, row);
    }
    scale_weights(weight_.data(), weight_.size() / kBlockDirections, solid_angles.data());
    for (std::size_t j = 0; j < rule_.nodes.size(); j += together_) {
      const std::size_t count = std::min(together_, rule_.nodes.size() - j) * width_;
      const auto part = [&](const AlignedVector<double>& all) {
        return std::span<const double>(all).subspan(j * width_, count);
      };
      basis_.evaluate_blocked({part(x_), part(y_), part(z_)}, values_);
      add_weighted_blocks(part(weight_).data(), values_.data(), count / kBlockDirections,
                          groups_.places.data(), groups_.places.size(), j == 0, table_.data() + x,
                          quarter_.stride);
    }
  }

  const Quarter& quarter_;
  const GaussLegendre& rule_;
  const BatchBasis<double>& basis_;
  const Groups& groups_;
  std::size_t width_;     // nodes of 16 texels with the same t
  std::size_t together_;  // how many t are evaluated at a time
  AlignedVector<double> s_, ds_, x_, y_, z_, weight_, values_, table_;
};

/// The sums of one task, not yet added up over the lanes of their vectors.
class FaceSums {
 public:
  FaceSums(const Quarter& quarter, const Groups& groups)
      : quarter_(quarter),
        groups_(groups),
        parts_(12 * quarter.stride, 0.0),
        sums_(6 * 3 * groups.indices.size() * kSumLanes, 0.0) {}

  void add_row(const RowIntegrals& integrals, const image::Image& image, std::size_t y, std::size_t face) {
    const auto width = static_cast<std::size_t>(quarter_.size);
    const std::size_t mirror = width - 1 - y;
    const float* bottom = mirror != y ? &image.pixels[mirror * width].x : nullptr;  // else it counts once
    fold_rows(&image.pixels[y * width].x, bottom, width, parts_.data(), quarter_.stride);
    for (std::size_t parity = 0; parity < 4; ++parity) {
      const std::size_t first = groups_.firsts[parity];
      add_moments(integrals.of(first), groups_.firsts[parity + 1] - first,
                  parts_.data() + 3 * parity * quarter_.stride, quarter_.stride, quarter_.count,
                  sums_of(face, first));
    }
  }

  /// Adds all to the six faces' coefficients.
  void add_to(Coefficients& faces) {
    const std::size_t size = groups_.indices.size();
    for (std::size_t face = 0; face < 6; ++face) {
      for (std::size_t place = 0; place < size; ++place) {
        const double* sums = sums_of(face, place);
        RgbD& total = faces[face * size + groups_.indices[place]];
        for (int c = 0; c < 3; ++c) {
          for (std::size_t lane = 0; lane < kSumLanes; ++lane) total[c] += *sums++;
        }
      }
    }
  }

 private:
  [[nodiscard]] double* sums_of(std::size_t face, std::size_t place) {
    return sums_.data() + (face * groups_.indices.size() + place) * 3 * kSumLanes;
  }

  const Quarter& quarter_;
  const Groups& groups_;
  AlignedVector<double> parts_;
  AlignedVector<double> sums_;
};

}  // namespace

Coefficients project_cube_faces(const light::CubeMapSky& sky, const Matrix& rotation, int bands,
                                int gauss_nodes, int threads) {
  const Quarter quarter(sky.faces[0].width);
  const GaussLegendre rule = gauss_legendre(gauss_nodes);
  const BatchBasis<double> basis(bands);
  const Groups groups(bands);
  const auto size = static_cast<std::size_t>(coefficient_count(bands));
  const std::size_t rows_a_task = std::max<std::size_t>(1, quarter.half / 16);
  const std::size_t tasks = (quarter.half + rows_a_task - 1) / rows_a_task;
  const Coefficients faces =
      sum_in_blocks(tasks, 6 * size, threads, [&](std::size_t task, Coefficients& sum) {
        RowIntegrals integrals(quarter, rule, basis, groups);
        FaceSums sums(quarter, groups);
        for (std::size_t y = task * rows_a_task; y < std::min(quarter.half, (task + 1) * rows_a_task); ++y) {
          integrals.make(y);
          for (std::size_t face = 0; face < 6; ++face) sums.add_row(integrals, sky.faces[face], y, face);
        }
        sums.add_to(sum);
      });
  std::vector<TurnedPart> parts;
  for (std::size_t face = 0; face < 6; ++face) {
    const auto first = faces.begin() + static_cast<std::ptrdiff_t>(face * size);
    parts.push_back(
        {Coefficients(first, first + static_cast<std::ptrdiff_t>(size)), rotation * face_frame(face)});
  }
  return turned(parts, bands, threads);
}

}  // namespace plumbline::sh
