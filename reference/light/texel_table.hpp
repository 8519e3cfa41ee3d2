// reference/light/texel_table.hpp: texels of a grid drawn in proportion to their weights.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace plumbline::light {

/// 2^32 - 1 units dealt to entries in proportion to their weights, at least one to every positive weight: entry i owns
/// [bounds[i], bounds[i + 1]). Returns the sum of the weights; all bounds are 0 when it is.
double fill_bounds(std::span<const double> weights, std::span<std::uint32_t> bounds);

/// A discrete distribution over rows x columns: first a row by its sum, then a column within it.
/// Probabilities are integers over 2^32 - 1, at least 1 for every positive weight, so that probability() is
/// exactly how often pick() gives a texel, and no texel that has a weight is ever out of reach. 4 to 6 bytes
/// a texel; pick() takes constant expected time (guide tables).
class TexelTable {
 public:
  /// Writes the weights of one row, each finite and >= 0. Called once a row, from several threads.
  using RowWeights = std::function<void(int row, std::span<double> weights)>;

  TexelTable() = default;
  /// @throws whatever row_weights throws
  TexelTable(int rows, int columns, const RowWeights& row_weights);

  /// Sum of all weights; 0 when there is nothing to pick.
  [[nodiscard]] double total() const { return total_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] int columns() const { return columns_; }

  struct Pick {
    int row = 0;
    int column = 0;
    double x = 0.0;  // what is left of the random numbers: uniform in [0, 1)
    double y = 0.0;
  };
  /// y chooses the row and x the column, both in [0, 1). Needs total() > 0.
  [[nodiscard]] Pick pick(double x, double y) const;

  /// Probability with which pick() gives this texel.
  [[nodiscard]] double probability(int row, int column) const;
  /// The parts of it: of a row, and the columns + 1 bounds between the columns of a row.
  [[nodiscard]] double row_probability(int row) const;
  [[nodiscard]] std::span<const std::uint32_t> column_bounds(int row) const;

 private:
  int rows_ = 0;
  int columns_ = 0;
  double total_ = 0.0;
  std::vector<std::uint32_t> row_bounds_;     // rows + 1, from 0 to 2^32 - 1
  std::vector<std::uint32_t> row_guide_;      // a power of two + 1
  std::vector<std::uint32_t> column_bounds_;  // rows x (columns + 1)
  std::vector<std::uint32_t> column_guide_;   // rows x (a power of two + 1)
};

}  // namespace plumbline::light
