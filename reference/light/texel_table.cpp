#include "reference/light/texel_table.hpp"

#include <algorithm>
#include <bit>

#include "reference/base/parallel.hpp"

namespace plumbline::light {
namespace {

// The unit interval is cut into kUnits equal parts; entry i owns [bounds[i], bounds[i + 1]).
constexpr std::uint32_t kUnits = 0xFFFFFFFFU;

// A guide of 2^k intervals, about one for four entries: guide[j] is the entry that owns the first unit of
// interval j, so that a unit of interval j belongs to one of guide[j] … guide[j + 1].
std::size_t guide_size(int entries) {
  return std::max(std::size_t{1}, std::bit_ceil(static_cast<std::size_t>(entries)) / 4);
}
int guide_shift(std::size_t intervals) {
  return 32 - std::countr_zero(intervals);
}

void fill_guide(std::span<const std::uint32_t> bounds, std::span<std::uint32_t> guide) {
  const std::size_t intervals = guide.size() - 1;
  const auto last_entry = static_cast<std::uint32_t>(bounds.size() - 2);
  std::uint32_t entry = 0;
  for (std::size_t j = 0; j <= intervals; ++j) {
    const std::uint64_t first_unit = static_cast<std::uint64_t>(j) << guide_shift(intervals);
    while (entry < last_entry && bounds[entry + 1] <= first_unit) ++entry;
    guide[j] = entry;
  }
}

struct Found {
  int entry = 0;
  double rest = 0.0;  // [0, 1)
};

// `number` in [0, 1). Entries of no width are never found: the search takes the last of equal bounds.
Found entry_at(std::span<const std::uint32_t> bounds, std::span<const std::uint32_t> guide, double number) {
  const double position = number * static_cast<double>(kUnits);
  const auto unit = static_cast<std::uint32_t>(position);
  const std::size_t interval = static_cast<std::uint64_t>(unit) >> guide_shift(guide.size() - 1);
  const auto begin = bounds.begin() + guide[interval] + 1;
  const auto end = bounds.begin() + guide[interval + 1] + 1;
  const auto above = std::upper_bound(begin, end, unit);
  const auto entry = static_cast<std::size_t>(above - bounds.begin()) - 1;
  const auto width = static_cast<double>(bounds[entry + 1] - bounds[entry]);
  return {static_cast<int>(entry), (position - static_cast<double>(bounds[entry])) / width};
}

double probability_of(std::span<const std::uint32_t> bounds, int entry) {
  const auto i = static_cast<std::size_t>(entry);
  return static_cast<double>(bounds[i + 1] - bounds[i]) / static_cast<double>(kUnits);
}

}  // namespace

double fill_bounds(std::span<const double> weights, std::span<std::uint32_t> bounds) {
  double total = 0.0;
  std::uint32_t positive = 0;
  for (const double weight : weights) {
    total += weight;
    positive += weight > 0.0 ? 1U : 0U;
  }
  const double shared = static_cast<double>(kUnits - positive);
  double running = 0.0;  // the same additions as total's: ends on it exactly
  std::uint32_t given = 0;
  bounds[0] = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    running += weights[i];
    given += weights[i] > 0.0 ? 1U : 0U;
    bounds[i + 1] = total > 0.0 ? given + static_cast<std::uint32_t>(running / total * shared) : 0U;
  }
  return total;
}

TexelTable::TexelTable(int rows, int columns, const RowWeights& row_weights)
    : rows_(rows), columns_(columns) {
  const auto row_count = static_cast<std::size_t>(rows);
  const std::size_t bound_count = static_cast<std::size_t>(columns) + 1;
  const std::size_t guide_count = guide_size(columns) + 1;
  column_bounds_.resize(row_count * bound_count);
  column_guide_.resize(row_count * guide_count);
  std::vector<double> row_totals(row_count);
  parallel_for(row_count, 0, [&](std::size_t row) {
    std::vector<double> weights(static_cast<std::size_t>(columns));
    row_weights(static_cast<int>(row), weights);
    const auto bounds = std::span(column_bounds_).subspan(row * bound_count, bound_count);
    row_totals[row] = fill_bounds(weights, bounds);
    fill_guide(bounds, std::span(column_guide_).subspan(row * guide_count, guide_count));
  });
  row_bounds_.resize(row_count + 1);
  row_guide_.resize(guide_size(rows) + 1);
  total_ = fill_bounds(row_totals, row_bounds_);
  fill_guide(row_bounds_, row_guide_);
}

std::span<const std::uint32_t> TexelTable::column_bounds(int row) const {
  const std::size_t count = static_cast<std::size_t>(columns_) + 1;
  return std::span(column_bounds_).subspan(static_cast<std::size_t>(row) * count, count);
}

TexelTable::Pick TexelTable::pick(double x, double y) const {
  const Found row = entry_at(row_bounds_, row_guide_, y);
  const std::size_t guide_count = guide_size(columns_) + 1;
  const auto guide =
      std::span(column_guide_).subspan(static_cast<std::size_t>(row.entry) * guide_count, guide_count);
  const Found column = entry_at(column_bounds(row.entry), guide, x);
  return {row.entry, column.entry, column.rest, row.rest};
}

double TexelTable::row_probability(int row) const {
  return probability_of(row_bounds_, row);
}

double TexelTable::probability(int row, int column) const {
  return row_probability(row) * probability_of(column_bounds(row), column);
}

}  // namespace plumbline::light
