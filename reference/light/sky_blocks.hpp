// reference/light/sky_blocks.hpp: texels drawn in proportion to radiance times the cosine about a normal.
// Internal to reference/light; EnvironmentSampler is the interface.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "reference/base/vector.hpp"
#include "reference/light/texel_table.hpp"

namespace plumbline::light {

/// A two-level tree over the cells of a TexelTable: groups of 4 x 8 blocks of cells. For a normal, a group is drawn, then one
/// of its blocks, each in proportion to its power times its mean clamped cosine (exact where all of it is above the horizon,
/// estimated where the horizon cuts it, never 0 there); within the block a cell in proportion to power. So an unblocked
/// diffuse surface meets nearly the same radiance times cosine over density in every direction: what is left of the noise is
/// visibility. Constant time (about 100 products), no table that depends on the normal.
class SkyBlocks {
 public:
  SkyBlocks() = default;
  /// @param centre       unit direction of the middle of a cell
  /// @param cell_radius  no point of a cell is farther from its middle than this angle [rad]
  SkyBlocks(const TexelTable& table, const std::function<Vec3d(int row, int column)>& centre,
            double cell_radius);

  static constexpr int kBlockRows = 4;     // blocks of one group
  static constexpr int kBlockColumns = 8;  //
  static constexpr int kPerGroup = kBlockRows * kBlockColumns;
  static constexpr int kMostGroups = 64;

  /// What depends on the normal, made once for all samples of a point.
  struct Lobe {
    Vec3 normal{0.0F};
    std::array<float, kMostGroups> weights{};
    std::array<float, kMostGroups> row_sums{};
    /// Estimate of the unblocked irradiance's magnitude over the sky's power (the table's total).
    float total = 0.0F;
  };
  [[nodiscard]] Lobe lobe(const Vec3& normal) const;

  /// A draw in the making: a block, then a row of it, then a cell. The parts are separate so that several draws can wait for
  /// memory together: each part names the memory that the next one reads.
  struct Pick {
    TexelTable::Pick cell;     // x and y: what is left of the random numbers
    double probability = 0.0;  // 0: what was drawn turns out to lie below the horizon wholly
    int column_end = 0;        // of the block
    const std::uint32_t* rows = nullptr;
  };
  [[nodiscard]] Pick pick_block(const Lobe& lobe, double x, double y) const;
  void pick_row(const TexelTable& table, Pick& pick) const;
  void pick_column(const TexelTable& table, Pick& pick) const;
  /// All three: a cell for two numbers in [0, 1).
  [[nodiscard]] Pick pick(const TexelTable& table, const Lobe& lobe, double x, double y) const;
  /// Probability with which pick() gives this cell.
  [[nodiscard]] double probability(const TexelTable& table, const Lobe& lobe, int row, int column) const;

 private:
  /// Weight of a node about a normal n, with t = n.V and V the integral of |L| w over the node (derivation in the .cpp).
  struct Nodes {
    std::vector<float> x, y, z;  // V
    std::vector<float> reach;    // |V| times the sine of the angle from V to the node's farthest point
    std::vector<float> blend;    // 1 / (4 reach)
    std::vector<float> least;    // of what may be above the horizon
    void resize(std::size_t count);
    void set(std::size_t node, const Vec3d& vector, double power, double sine);
    void weigh(std::size_t first, std::span<float> weights, const Vec3& normal) const;
  };
  struct Children {
    std::array<float, kPerGroup> weights;
    std::array<float, kBlockRows> row_sums;
    float total = 0.0F;
  };
  [[nodiscard]] Children children(int group, const Vec3& normal) const;
  struct Cells {
    int row0, row1, column0, column1;
  };
  [[nodiscard]] Cells cells_of(int block_row, int block_column) const;
  void add_blocks(const TexelTable& table, const std::function<Vec3d(int, int)>& centre, double cell_radius);
  void fill_rows(const TexelTable& table);
  [[nodiscard]] std::span<const std::uint32_t> rows_of(int block_row, int block_column) const;

  int rows_ = 0;  // of cells
  int columns_ = 0;
  int block_height_ = 1;  // in cells
  int block_width_ = 1;
  int group_rows_ = 0;
  int group_columns_ = 0;
  Nodes groups_;
  Nodes blocks_;                           // kBlockRows x kBlockColumns for each group
  std::vector<std::uint32_t> row_bounds_;  // block_height + 1 for each block, from 0 to 2^32 - 1
};

}  // namespace plumbline::light
