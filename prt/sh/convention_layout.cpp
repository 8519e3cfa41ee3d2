#include "prt/sh/convention_layout.hpp"

#include <fmt/format.h>

#include <limits>

#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

constexpr std::size_t kPackedRows = 9;
constexpr std::size_t kPackedCount = 28;  // seven vectors of four
constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();

/// The largest n with n^2 <= value: the degree of a row, or the bands of a number of rows.
std::size_t root_of(std::size_t value) {
  std::size_t n = 0;
  while ((n + 1) * (n + 1) <= value) ++n;
  return n;
}

/// In which order the rows' numbers stand: place p of the list holds channel order[p] % 3 of row order[p] / 3,
/// or 0 for kNowhere.
std::vector<std::size_t> order_of(Layout layout, std::size_t rows) {
  std::vector<std::size_t> order(packed_count(layout, rows), kNowhere);
  const std::size_t n = root_of(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t l = root_of(row);
    const std::size_t centre = l * (l + 1);
    for (std::size_t c = 0; c < 3; ++c) {
      std::size_t place = 3 * row + c;
      if (layout == Layout::planar) place = c * rows + row;
      if (layout == Layout::rgba) place = 4 * row + c;
      if (layout == Layout::splat && row > 0) place = 3 + c * (rows - 1) + row - 1;
      if (layout == Layout::cosine_sine) {
        place =
            row >= centre ? ((2 * c) * n + l) * n + row - centre : ((2 * c + 1) * n + l) * n + centre - row;
      }
      order[place] = 3 * row + c;
    }
  }
  return order;
}

// The polynomial c0 + c1 y + c2 z + c3 x + c4 xy + c5 yz + c6 (3z^2 - 1) + c7 xz + c8 (x^2 - y^2) as
// dot(A, (x, y, z, 1)) + dot(B, (xy, yz, z^2, xz)) + C (x^2 - y^2): Sloan, "Efficient evaluation of irradiance
// environment maps"; Unity's SHAr ... SHC and Unreal's sky irradiance. With `packed_square` the third number of B
// belongs to 3z^2 - 1 itself.
std::vector<double> shader_vectors(const std::vector<RgbD>& c, Layout layout) {
  const bool is_split = layout == Layout::packed;
  std::vector<double> values(kPackedCount, 0.0);
  for (glm::length_t k = 0; k < 3; ++k) {
    const auto a = static_cast<std::size_t>(4 * k);
    const std::size_t b = 12 + a;
    values[a] = c[3][k];
    values[a + 1] = c[1][k];
    values[a + 2] = c[2][k];
    values[a + 3] = is_split ? c[0][k] - c[6][k] : c[0][k];
    values[b] = c[4][k];
    values[b + 1] = c[5][k];
    values[b + 2] = is_split ? 3.0 * c[6][k] : c[6][k];
    values[b + 3] = c[7][k];
    values[24 + static_cast<std::size_t>(k)] = c[8][k];
  }
  values[27] = 1.0;
  return values;
}

std::vector<RgbD> rows_of_shader_vectors(std::span<const double> values, Layout layout) {
  const bool is_split = layout == Layout::packed;
  std::vector<RgbD> c(kPackedRows);
  for (glm::length_t k = 0; k < 3; ++k) {
    const auto a = static_cast<std::size_t>(4 * k);
    const std::size_t b = 12 + a;
    c[3][k] = values[a];
    c[1][k] = values[a + 1];
    c[2][k] = values[a + 2];
    c[4][k] = values[b];
    c[5][k] = values[b + 1];
    c[6][k] = is_split ? values[b + 2] / 3.0 : values[b + 2];
    c[0][k] = is_split ? values[a + 3] + c[6][k] : values[a + 3];
    c[7][k] = values[b + 3];
    c[8][k] = values[24 + static_cast<std::size_t>(k)];
  }
  return c;
}

bool is_for_shaders(Layout layout) {
  return layout == Layout::packed || layout == Layout::packed_square;
}

}  // namespace

bool is_packable(Layout layout, std::size_t rows) {
  if (is_for_shaders(layout)) return rows == kPackedRows;
  if (layout == Layout::cosine_sine) return root_of(rows) * root_of(rows) == rows;
  return true;
}

std::size_t packed_count(Layout layout, std::size_t rows) {
  if (!is_packable(layout, rows)) {
    throw InputError(fmt::format("sh::Convention: layout \"{}\": expected {}, got {} rows", to_string(layout),
                                 is_for_shaders(layout) ? "3 bands, 9 rows" : "all rows of some bands",
                                 rows));
  }
  if (is_for_shaders(layout)) return kPackedCount;
  if (layout == Layout::rgba) return 4 * rows;
  return layout == Layout::cosine_sine ? 6 * rows : 3 * rows;
}

std::vector<double> packed_values(const std::vector<RgbD>& rows, Layout layout) {
  const std::vector<std::size_t> order = order_of(layout, rows.size());
  if (is_for_shaders(layout)) return shader_vectors(rows, layout);
  std::vector<double> values(order.size(), 0.0);
  for (std::size_t p = 0; p < order.size(); ++p) {
    if (order[p] != kNowhere) values[p] = rows[order[p] / 3][static_cast<glm::length_t>(order[p] % 3)];
  }
  return values;
}

std::vector<RgbD> unpacked_rows(std::span<const double> values, Layout layout, std::size_t rows) {
  const std::size_t expected = packed_count(layout, rows);
  if (values.size() != expected) {
    throw InputError(fmt::format("sh::to_ours: layout \"{}\": expected {} numbers for {} rows, got {}",
                                 to_string(layout), expected, rows, values.size()));
  }
  if (is_for_shaders(layout)) return rows_of_shader_vectors(values, layout);
  const std::vector<std::size_t> order = order_of(layout, rows);
  std::vector<RgbD> result(rows, RgbD(0.0));
  for (std::size_t p = 0; p < order.size(); ++p) {
    if (order[p] != kNowhere) result[order[p] / 3][static_cast<glm::length_t>(order[p] % 3)] = values[p];
  }
  return result;
}

}  // namespace plumbline::sh
