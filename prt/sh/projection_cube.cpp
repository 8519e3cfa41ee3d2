// Projection of cube maps with constant texels: project_cube_faces of projection_parts.hpp.
#include <algorithm>
#include <array>
#include <cmath>

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
  std::size_t stride = 0;       // half, padded
  std::vector<double> corners;  // solid angle between the face's centre and corner (x, y), symmetric: [y][x]

  explicit Quarter(int face_size)
      : size(face_size), half((static_cast<std::size_t>(face_size) + 1) / 2), stride(padded(half)) {
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

/// integrals[i][x] over the texels of row y of a quarter; what is beside the row is 0.
class RowIntegrals {
 public:
  RowIntegrals(const Quarter& quarter, const GaussLegendre& rule, const BatchBasis<double>& basis)
      : quarter_(quarter),
        rule_(rule),
        basis_(basis),
        size_(static_cast<std::size_t>(basis.bands() * basis.bands())) {
    const std::size_t count = rule.nodes.size() * quarter.stride;
    for (auto* values : {&s_, &ds_, &x_, &y_, &z_, &weight_}) values->resize(count);
    values_.resize(blocked_size(basis.bands(), count));
    table_.resize(size_ * quarter.stride);
    total_.resize(quarter.stride);
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      for (std::size_t x = 0; x < quarter.half; ++x) {
        s_[i * quarter.stride + x] = quarter.edge(x) + (1.0 + rule.nodes[i]) / quarter.size;
        ds_[i * quarter.stride + x] = rule.weights[i];
      }
    }
  }

  void make(std::size_t row) {
    std::fill(table_.begin(), table_.end(), 0.0);
    std::fill(total_.begin(), total_.end(), 0.0);
    for (std::size_t j = 0; j < rule_.nodes.size(); ++j) {
      const double t = quarter_.edge(row) + (1.0 + rule_.nodes[j]) / quarter_.size;
      face_nodes(s_.data(), ds_.data(), t, rule_.weights[j], s_.size(), x_.data(), y_.data(), z_.data(),
                 weight_.data());
      basis_.evaluate_blocked({x_, y_, z_}, values_);
      for (std::size_t k = 0; k < s_.size(); k += kBlockDirections) add_block(k);
    }
    for (std::size_t x = 0; x < quarter_.half; ++x) total_[x] = quarter_.solid_angle(x, row) / total_[x];
    for (std::size_t i = 0; i < size_; ++i) {
      double* integrals = table_.data() + i * quarter_.stride;
      for (std::size_t x = 0; x < quarter_.stride; ++x) integrals[x] *= total_[x];
    }
  }
  [[nodiscard]] const double* of(std::size_t i) const { return table_.data() + i * quarter_.stride; }

 private:
  void add_block(std::size_t k) {
    const std::size_t x = k % quarter_.stride;
    const double* weight = weight_.data() + k;
    const double* values = values_.data() + k * size_;
    for (std::size_t u = 0; u < kBlockDirections; ++u) total_[x + u] += weight[u];
    for (std::size_t i = 0; i < size_; ++i, values += kBlockDirections) {
      double* integrals = table_.data() + i * quarter_.stride + x;
      for (std::size_t u = 0; u < kBlockDirections; ++u) integrals[u] += weight[u] * values[u];
    }
  }

  const Quarter& quarter_;
  const GaussLegendre& rule_;
  const BatchBasis<double>& basis_;
  std::size_t size_;
  std::vector<double> s_, ds_, x_, y_, z_, weight_, values_, table_, total_;
};

/// Even and odd parts of the mirror images of row y's texels, three channels each.
class FoldedRow {
 public:
  explicit FoldedRow(const Quarter& quarter) : quarter_(quarter), rows_(2), parts_(4) {
    for (auto& row : rows_) row.assign(3 * padded(static_cast<std::size_t>(quarter.size)), 0.0);
    for (auto& part : parts_) part.assign(3 * quarter.stride, 0.0);
  }

  void make(const image::Image& face, std::size_t y) {
    const auto width = static_cast<std::size_t>(quarter_.size);
    const std::size_t stride = padded(width);
    const std::size_t mirror = width - 1 - y;
    split_pixels(&face.pixels[y * width].x, width, rows_[0].data(), stride);
    if (mirror != y) {
      split_pixels(&face.pixels[mirror * width].x, width, rows_[1].data(), stride);
    } else {
      std::fill(rows_[1].begin(), rows_[1].end(), 0.0);  // its own mirror image counts once
    }
    for (std::size_t c = 0; c < 3; ++c) fold(rows_[0].data() + c * stride, rows_[1].data() + c * stride, c);
  }
  [[nodiscard]] const double* part(std::size_t parity) const { return parts_[parity].data(); }

 private:
  void fold(const double* top, const double* bottom, std::size_t channel) {
    const auto width = static_cast<std::size_t>(quarter_.size);
    for (std::size_t x = 0; x < quarter_.half; ++x) {
      const std::size_t mirror = width - 1 - x;
      const double keep = mirror != x ? 1.0 : 0.0;
      const double b = keep * top[mirror];
      const double d = keep * bottom[mirror];
      const double even_top = top[x] + b;
      const double odd_top = top[x] - b;
      const double even_bottom = bottom[x] + d;
      const double odd_bottom = bottom[x] - d;
      const std::size_t at = channel * quarter_.stride + x;
      parts_[0][at] = even_top + even_bottom;
      parts_[1][at] = odd_top + odd_bottom;
      parts_[2][at] = even_top - even_bottom;
      parts_[3][at] = odd_top - odd_bottom;
    }
  }

  const Quarter& quarter_;
  std::vector<std::vector<double>> rows_;
  std::vector<std::vector<double>> parts_;
};

/// Coefficients by parity, and back.
struct Groups {
  std::array<std::vector<std::size_t>, 4> indices;
  explicit Groups(int bands) {
    for (int l = 0; l < bands; ++l) {
      for (int m = -l; m <= l; ++m) indices[parity_of(m)].push_back(static_cast<std::size_t>(index(l, m)));
    }
  }
};

void add_face_row(const RowIntegrals& integrals, const FoldedRow& row, const Quarter& quarter,
                  const Groups& groups, RgbD* sum) {
  std::vector<const double*> weights;
  std::vector<double> moments;
  for (std::size_t parity = 0; parity < 4; ++parity) {
    const std::vector<std::size_t>& group = groups.indices[parity];
    weights.clear();
    for (const std::size_t i : group) weights.push_back(integrals.of(i));
    moments.resize(3 * group.size());
    channel_moments(weights.data(), group.size(), row.part(parity), quarter.stride, quarter.stride,
                    moments.data());
    for (std::size_t k = 0; k < group.size(); ++k) {
      sum[group[k]] += RgbD(moments[3 * k], moments[3 * k + 1], moments[3 * k + 2]);
    }
  }
}

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
        RowIntegrals integrals(quarter, rule, basis);
        FoldedRow row(quarter);
        for (std::size_t y = task * rows_a_task; y < std::min(quarter.half, (task + 1) * rows_a_task); ++y) {
          integrals.make(y);
          for (std::size_t face = 0; face < 6; ++face) {
            row.make(sky.faces[face], y);
            add_face_row(integrals, row, quarter, groups, sum.data() + face * size);
          }
        }
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
