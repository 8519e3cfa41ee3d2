#include "reference/light/sky_blocks.hpp"

#include <algorithm>
#include <cmath>

#include "reference/base/parallel.hpp"

namespace plumbline::light {
namespace {

// The lowest weight of a node that the horizon may cut, in parts of its power. Its cosine is estimated there: too low a guess
// would be rare samples of great weight.
constexpr double kLeastCosine = 0.03;
// A node that reaches so far that "about the direction V" means little is weighed by its power alone.
constexpr double kWidestSine = 0.97;
constexpr double kWideCosine = 0.25;  // mean of the clamped cosine over the sphere

// One of `count` entries in proportion to its weight; `number` in [0, 1) becomes what is left of it. None where all are 0.
struct Drawn {
  int entry = -1;
  float weight = 0.0F;
};
Drawn draw(const float* weights, int count, float total, double& number) {
  const double target = number * static_cast<double>(total);
  double below = 0.0;
  double last_below = 0.0;
  Drawn last;
  for (int i = 0; i < count; ++i) {
    if (!(weights[i] > 0.0F)) continue;
    last = {i, weights[i]};
    last_below = below;
    below += static_cast<double>(weights[i]);
    if (target < below) break;
  }
  if (last.entry >= 0)
    number = std::clamp((target - last_below) / static_cast<double>(last.weight), 0.0, 1.0 - 0x1p-53);
  return last;
}

float sum_of(const float* weights, int count) {
  float sum = 0.0F;
  for (int i = 0; i < count; ++i) sum += weights[i];
  return sum;
}

struct DrawnCell {
  int row = -1;
  int column = -1;
  double probability = 0.0;
};
/// A row by its sum and y, then a column by x.
DrawnCell draw_2d(const float* weights, const float* row_sums, int rows, int columns, float total, double& x,
                  double& y) {
  const Drawn row = draw(row_sums, rows, total, y);
  if (row.entry < 0) return {};
  const Drawn column = draw(weights + row.entry * columns, columns, row.weight, x);
  if (column.entry < 0) return {};
  return {row.entry, column.entry, static_cast<double>(column.weight) / static_cast<double>(total)};
}

// The interval of `bounds` (ascending integers) that holds a number in [0, 1) of the whole. A search without branches: which
// way it goes is random, and a processor that guesses wrong every other time is slower than one that does not guess.
struct Interval {
  int entry = -1;
  double probability = 0.0;
};
Interval draw_interval(std::span<const std::uint32_t> bounds, double& number) {
  const double begin = bounds.front();
  const double range = static_cast<double>(bounds.back()) - begin;
  const double position = begin + number * range;
  const auto unit = static_cast<std::uint32_t>(position);
  const std::uint32_t* base = bounds.data();
  for (std::size_t left = bounds.size() - 1; left > 1;) {
    const std::size_t half = left / 2;
    base += base[half] <= unit ? half : 0;
    left -= half;
  }
  const double width = static_cast<double>(base[1]) - static_cast<double>(base[0]);
  if (!(width > 0.0)) return {};
  number = std::clamp((position - static_cast<double>(base[0])) / width, 0.0, 1.0 - 0x1p-53);
  return {static_cast<int>(base - bounds.data()), width / range};
}

double interval_probability(std::span<const std::uint32_t> bounds, int entry) {
  const auto i = static_cast<std::size_t>(entry);
  const double range = static_cast<double>(bounds.back()) - static_cast<double>(bounds.front());
  return range > 0.0 ? (static_cast<double>(bounds[i + 1]) - static_cast<double>(bounds[i])) / range : 0.0;
}

struct Sum {
  Vec3d vector{0.0};
  double power = 0.0;
};

int ceil_div(int a, int b) {
  return (a + b - 1) / b;
}

}  // namespace

void SkyBlocks::Nodes::resize(std::size_t count) {
  for (std::vector<float>* values : {&x, &y, &z, &reach, &blend, &least}) values->assign(count, 0.0F);
}

void SkyBlocks::Nodes::set(std::size_t node, const Vec3d& vector, double power, double sine) {
  if (sine > kWidestSine) {
    least[node] = static_cast<float>(kWideCosine * power);
    return;
  }
  const double far = glm::length(vector) * sine;
  x[node] = static_cast<float>(vector.x);
  y[node] = static_cast<float>(vector.y);
  z[node] = static_cast<float>(vector.z);
  reach[node] = static_cast<float>(far);
  blend[node] = far > 0.0 ? static_cast<float>(0.25 / far) : 0.0F;
  least[node] = static_cast<float>(kLeastCosine * power);
}

// Let V = integral of |L| w dw over a node (in units of the whole sky's power), all of it within an angle R of V. With t = n.V:
//   t >=  |V| sin R   the whole node is above the horizon, and t = integral of |L| n.w is exactly what is wanted;
//   t <= -|V| sin R   all of it is below: 0;
//   between           the horizon cuts it: (t + s)^2 / 4 s with s = |V| sin R joins both ends with equal slopes.
void SkyBlocks::Nodes::weigh(std::size_t first, std::span<float> weights, const Vec3& normal) const {
  const float* __restrict vx = x.data() + first;
  const float* __restrict vy = y.data() + first;
  const float* __restrict vz = z.data() + first;
  const float* __restrict far = reach.data() + first;
  const float* __restrict curve = blend.data() + first;
  const float* __restrict floor = least.data() + first;
  float* __restrict out = weights.data();
  const std::size_t count = weights.size();
  for (std::size_t i = 0; i < count; ++i) {
    const float t = normal.x * vx[i] + normal.y * vy[i] + normal.z * vz[i];
    const float above = t + far[i];
    const float cut = above * above * curve[i];
    const float weight = std::max(t >= far[i] ? t : cut, floor[i]);
    out[i] = above < 0.0F ? 0.0F : weight;
  }
}

SkyBlocks::SkyBlocks(const TexelTable& table, const std::function<Vec3d(int, int)>& centre,
                     double cell_radius)
    : rows_(table.rows()), columns_(table.columns()) {
  // 32 x 64 blocks for a lat-long image, 96 x 16 for the six faces of a cube: at most 64 groups either way.
  const bool is_tall = rows_ >= 4 * columns_;
  block_height_ = ceil_div(rows_, is_tall ? 96 : 32);
  block_width_ = ceil_div(columns_, is_tall ? 16 : 64);
  group_rows_ = ceil_div(ceil_div(rows_, block_height_), kBlockRows);
  group_columns_ = ceil_div(ceil_div(columns_, block_width_), kBlockColumns);
  add_blocks(table, centre, cell_radius);
  fill_rows(table);
}

SkyBlocks::Cells SkyBlocks::cells_of(int block_row, int block_column) const {
  return {std::min(block_row * block_height_, rows_), std::min((block_row + 1) * block_height_, rows_),
          std::min(block_column * block_width_, columns_),
          std::min((block_column + 1) * block_width_, columns_)};
}

void SkyBlocks::add_blocks(const TexelTable& table, const std::function<Vec3d(int, int)>& centre,
                           double cell_radius) {
  const std::size_t groups = static_cast<std::size_t>(group_rows_) * static_cast<std::size_t>(group_columns_);
  groups_.resize(groups);
  blocks_.resize(groups * kPerGroup);
  const auto for_cells = [&](const Cells& cells, const auto& visit) {
    for (int row = cells.row0; row < cells.row1; ++row) {
      for (int column = cells.column0; column < cells.column1; ++column) {
        const double power = table.probability(row, column);
        if (power > 0.0) visit(centre(row, column), power);
      }
    }
  };
  const auto sum_over = [&](const Cells& cells) {
    Sum sum;
    for_cells(cells, [&](const Vec3d& w, double power) {
      sum.vector += power * w;
      sum.power += power;
    });
    return sum;
  };
  const auto sine_about = [&](const Cells& cells, const Sum& sum) {
    const double length = glm::length(sum.vector);
    if (!(length > 0.0)) return 1.0;
    double least_cosine = 1.0;
    for_cells(cells, [&](const Vec3d& w, double) {
      least_cosine = std::min(least_cosine, glm::dot(w, sum.vector) / length);
    });
    const double angle = std::acos(std::clamp(least_cosine, -1.0, 1.0)) + cell_radius;
    return angle < 0.5 * kPi ? std::sin(angle) : 1.0;
  };
  parallel_for(groups, 0, [&](std::size_t g) {
    const int row = static_cast<int>(g) / group_columns_ * kBlockRows;
    const int column = static_cast<int>(g) % group_columns_ * kBlockColumns;
    for (int k = 0; k < kPerGroup; ++k) {
      const Cells cells = cells_of(row + k / kBlockColumns, column + k % kBlockColumns);
      const Sum sum = sum_over(cells);
      blocks_.set(g * kPerGroup + static_cast<std::size_t>(k), sum.vector, sum.power, sine_about(cells, sum));
    }
    Cells all = cells_of(row, column);
    const Cells last = cells_of(row + kBlockRows - 1, column + kBlockColumns - 1);
    all.row1 = last.row1;
    all.column1 = last.column1;
    const Sum sum = sum_over(all);
    groups_.set(g, sum.vector, sum.power, sine_about(all, sum));
  });
}

// Rows of a block in proportion to their power in it: one unit of 2^32 - 1 for every row that has any, as in TexelTable.
void SkyBlocks::fill_rows(const TexelTable& table) {
  const int block_rows = group_rows_ * kBlockRows;
  const int block_columns = group_columns_ * kBlockColumns;
  const auto stride = static_cast<std::size_t>(block_height_) + 1;
  row_bounds_.assign(stride * static_cast<std::size_t>(block_rows) * static_cast<std::size_t>(block_columns),
                     0U);
  std::vector<double> weights(static_cast<std::size_t>(block_height_));
  for (int block = 0; block < block_rows * block_columns; ++block) {
    const Cells cells = cells_of(block / block_columns, block % block_columns);
    std::fill(weights.begin(), weights.end(), 0.0);
    for (int row = cells.row0; row < cells.row1; ++row) {
      const auto bounds = table.column_bounds(row);
      weights[static_cast<std::size_t>(row - cells.row0)] =
          table.row_probability(row) * (static_cast<double>(bounds[static_cast<std::size_t>(cells.column1)]) -
                                        static_cast<double>(bounds[static_cast<std::size_t>(cells.column0)]));
    }
    fill_bounds(weights, std::span(row_bounds_).subspan(static_cast<std::size_t>(block) * stride, stride));
  }
}

std::span<const std::uint32_t> SkyBlocks::rows_of(int block_row, int block_column) const {
  const auto stride = static_cast<std::size_t>(block_height_) + 1;
  const auto block = static_cast<std::size_t>(block_row * group_columns_ * kBlockColumns + block_column);
  return std::span(row_bounds_).subspan(block * stride, stride);
}

SkyBlocks::Lobe SkyBlocks::lobe(const Vec3& normal) const {
  Lobe result;
  result.normal = normal;
  groups_.weigh(0, std::span(result.weights).first(groups_.x.size()), normal);
  for (int row = 0; row < group_rows_; ++row) {
    float& sum = result.row_sums[static_cast<std::size_t>(row)];
    sum = sum_of(result.weights.data() + row * group_columns_, group_columns_);
    result.total += sum;
  }
  return result;
}

SkyBlocks::Children SkyBlocks::children(int group, const Vec3& normal) const {
  Children result;
  blocks_.weigh(static_cast<std::size_t>(group) * kPerGroup, result.weights, normal);
  for (int row = 0; row < kBlockRows; ++row) {
    float& sum = result.row_sums[static_cast<std::size_t>(row)];
    sum = sum_of(result.weights.data() + row * kBlockColumns, kBlockColumns);
    result.total += sum;
  }
  return result;
}

SkyBlocks::Pick SkyBlocks::pick_block(const Lobe& lobe, double x, double y) const {
  const DrawnCell group =
      draw_2d(lobe.weights.data(), lobe.row_sums.data(), group_rows_, group_columns_, lobe.total, x, y);
  if (group.row < 0) return {};
  const Children inside = children(group.row * group_columns_ + group.column, lobe.normal);
  const DrawnCell block =
      draw_2d(inside.weights.data(), inside.row_sums.data(), kBlockRows, kBlockColumns, inside.total, x, y);
  if (block.row < 0) return {};
  const int block_row = group.row * kBlockRows + block.row;
  const int block_column = group.column * kBlockColumns + block.column;
  const Cells cells = cells_of(block_row, block_column);
  const std::uint32_t* rows = rows_of(block_row, block_column).data();
  __builtin_prefetch(rows);
  return {{cells.row0, cells.column0, x, y}, group.probability * block.probability, cells.column1, rows};
}

void SkyBlocks::pick_row(const TexelTable& table, Pick& pick) const {
  if (!(pick.probability > 0.0)) return;
  const Interval row = draw_interval({pick.rows, static_cast<std::size_t>(block_height_) + 1}, pick.cell.y);
  pick.cell.row += std::max(row.entry, 0);
  pick.probability *= row.probability;
  __builtin_prefetch(&table.column_bounds(pick.cell.row)[static_cast<std::size_t>(pick.cell.column)]);
}

void SkyBlocks::pick_column(const TexelTable& table, Pick& pick) const {
  if (!(pick.probability > 0.0)) return;
  const auto columns = table.column_bounds(pick.cell.row)
                           .subspan(static_cast<std::size_t>(pick.cell.column),
                                    static_cast<std::size_t>(pick.column_end - pick.cell.column) + 1);
  const Interval column = draw_interval(columns, pick.cell.x);
  pick.cell.column += std::max(column.entry, 0);
  pick.probability *= column.probability;
}

SkyBlocks::Pick SkyBlocks::pick(const TexelTable& table, const Lobe& lobe, double x, double y) const {
  Pick result = pick_block(lobe, x, y);
  pick_row(table, result);
  pick_column(table, result);
  return result;
}

double SkyBlocks::probability(const TexelTable& table, const Lobe& lobe, int row, int column) const {
  const int block_row = row / block_height_;
  const int block_column = column / block_width_;
  const int group_row = block_row / kBlockRows;
  const int group_column = block_column / kBlockColumns;
  const int group = group_row * group_columns_ + group_column;
  const Children inside = children(group, lobe.normal);
  const Cells cells = cells_of(block_row, block_column);
  const auto columns = table.column_bounds(row).subspan(
      static_cast<std::size_t>(cells.column0), static_cast<std::size_t>(cells.column1 - cells.column0) + 1);
  const auto share = [](float weight, float total) {
    return total > 0.0F ? static_cast<double>(weight) / static_cast<double>(total) : 0.0;
  };
  const int child = block_row % kBlockRows * kBlockColumns + block_column % kBlockColumns;
  return share(lobe.weights[static_cast<std::size_t>(group)], lobe.total) *
         share(inside.weights[static_cast<std::size_t>(child)], inside.total) *
         interval_probability(rows_of(block_row, block_column), row - cells.row0) *
         interval_probability(columns, column - cells.column0);
}

}  // namespace plumbline::light
