#include "prt/sh/batch.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "prt/sh/batch_kernels.hpp"
#include "prt/sh/recurrence.hpp"
#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"

namespace plumbline::sh {
namespace {

std::size_t size_of(int bands) {
  return static_cast<std::size_t>(coefficient_count(bands));
}

template <class Real>
bool has_kernel(int bands) {
  return sizeof(Real) == sizeof(double) || bands <= kFloatRecurrenceBands;
}

template <class Real>
RecurrenceTable<Real> make_table(int bands) {
  require_bands(bands);
  RecurrenceTable<Real> table;
  table.bands = bands;
  if (bands <= kBatchClosedBands || !has_kernel<Real>(bands)) return table;
  table.scale = recurrence_scale<Real>(bands);
  table.starts = recurrence_starts<Real>(bands);
  for (int m = 0; m < bands; ++m) {
    for (int l = m + 1; l < bands; ++l) {
      const RecurrenceStep<Real> step = recurrence_step<Real>(l, m);
      table.steps.insert(table.steps.end(), {step.alpha, step.beta, step.gamma});
    }
  }
  return table;
}

template <class Real>
std::size_t require_same_length(const Directions<Real>& directions, const char* where) {
  const std::size_t count = directions.x.size();
  if (directions.y.size() != count || directions.z.size() != count) {
    throw InputError(std::string(where) + ": expected x, y and z of one length, got " +
                     std::to_string(count) + ", " + std::to_string(directions.y.size()) + " and " +
                     std::to_string(directions.z.size()));
  }
  return count;
}

void require_room(std::size_t size, std::size_t needed, const char* where) {
  if (size >= needed) return;
  throw InputError(std::string(where) + ": expected room for " + std::to_string(needed) + " values, got " +
                   std::to_string(size));
}

/// Up to 16 directions, the last of them repeated to fill the block.
template <class Real>
struct PaddedBlock {
  std::array<Real, kBlockDirections> x;
  std::array<Real, kBlockDirections> y;
  std::array<Real, kBlockDirections> z;

  PaddedBlock(const Directions<Real>& directions, std::size_t first) {
    for (std::size_t k = 0; k < kBlockDirections; ++k) {
      const std::size_t from = std::min(first + k, directions.x.size() - 1);
      x[k] = directions.x[from];
      y[k] = directions.y[from];
      z[k] = directions.z[from];
    }
  }
  [[nodiscard]] DirectionBlocks<Real> blocks() const {
    return {x.data(), y.data(), z.data(), kBlockDirections};
  }
};

/// Calls body(first direction, blocks) for groups of whole blocks, the last one padded. Which direction is computed with
/// which others is of no consequence to its bits.
template <class Real, class Body>
void for_blocks(const Directions<Real>& directions, std::size_t group_directions, int threads,
                const Body& body) {
  const std::size_t count = directions.x.size();
  const std::size_t whole = count / kBlockDirections * kBlockDirections;
  const std::size_t groups = (whole + group_directions - 1) / group_directions;
  const auto run = [&](std::size_t group) {
    const std::size_t first = group * group_directions;
    const std::size_t length = std::min(group_directions, whole - first);
    body(first, DirectionBlocks<Real>{directions.x.data() + first, directions.y.data() + first,
                                      directions.z.data() + first, length});
  };
  if (threads == 1) {
    for (std::size_t group = 0; group < groups; ++group) run(group);
  } else {
    parallel_for(groups, threads, run);
  }
  if (whole == count) return;
  const PaddedBlock<Real> last(directions, whole);
  body(whole, last.blocks());
}

constexpr std::size_t kGroup = 4096;

/// One direction after the other, where there is no kernel.
template <class Real, class Write>
void for_each_direction(int bands, const Directions<Real>& directions, const Write& write) {
  const Basis<Real> basis(bands);
  std::vector<Real> values(size_of(bands));
  for (std::size_t k = 0; k < directions.x.size(); ++k) {
    basis.evaluate(directions.x[k], directions.y[k], directions.z[k], values);
    write(k, values);
  }
}

}  // namespace

std::size_t blocked_size(int bands, std::size_t count) {
  return (count + kBlockDirections - 1) / kBlockDirections * kBlockDirections * size_of(bands);
}

template <class Real>
BatchBasis<Real>::BatchBasis(int bands) : table_(make_table<Real>(bands)) {}

template <class Real>
void BatchBasis<Real>::evaluate_blocked(const Directions<Real>& directions, std::span<Real> values,
                                        int threads) const {
  constexpr const char* kWhere = "sh::BatchBasis::evaluate_blocked";
  const std::size_t count = require_same_length(directions, kWhere);
  require_room(values.size(), blocked_size(bands(), count), kWhere);
  if (!has_kernel<Real>(bands())) {
    return for_each_direction(bands(), directions, [&](std::size_t k, const std::vector<Real>& y) {
      for (std::size_t i = 0; i < y.size(); ++i) values[blocked_index(bands(), k, i)] = y[i];
    });
  }
  for_blocks(directions, kGroup, threads, [&](std::size_t first, const DirectionBlocks<Real>& in) {
    evaluate_blocks(table_, in, values.data() + first * size_of(bands()));
  });
}

template <class Real>
void BatchBasis<Real>::evaluate(const Directions<Real>& directions, std::span<Real> values,
                                int threads) const {
  constexpr const char* kWhere = "sh::BatchBasis::evaluate";
  const std::size_t count = require_same_length(directions, kWhere);
  const std::size_t size = size_of(bands());
  require_room(values.size(), count * size, kWhere);
  if (!has_kernel<Real>(bands())) {
    return for_each_direction(bands(), directions, [&](std::size_t k, const std::vector<Real>& y) {
      std::copy(y.begin(), y.end(), values.begin() + static_cast<std::ptrdiff_t>(k * size));
    });
  }
  // A few blocks at a time stay in the first-level cache on their way to being turned.
  for_blocks(directions, kGroup, threads, [&](std::size_t first, const DirectionBlocks<Real>& in) {
    const std::size_t together =
        std::max<std::size_t>(1, 4096 / (kBlockDirections * size)) * kBlockDirections;
    std::vector<Real> blocks(together * size);
    for (std::size_t k = 0; k < in.count; k += together) {
      const std::size_t length = std::min(together, in.count - k);
      evaluate_blocks(table_, {in.x + k, in.y + k, in.z + k, length}, blocks.data());
      for (std::size_t b = 0; b < length; b += kBlockDirections) {
        const std::size_t row = first + k + b;
        transpose_block(blocks.data() + b * size, size, std::min(kBlockDirections, count - row),
                        values.data() + row * size);
      }
    }
  });
}

template class BatchBasis<float>;
template class BatchBasis<double>;

namespace {

/// In the order that sum_blocks() states.
template <class Real>
std::vector<Real> packed(const ShRgb& function) {
  std::vector<Real> result;
  const auto append = [&](int l, int m) {
    const RgbD& c = function.coefficients[static_cast<std::size_t>(index(l, m))];
    result.insert(result.end(), {static_cast<Real>(c.r), static_cast<Real>(c.g), static_cast<Real>(c.b)});
  };
  if (function.bands <= kBatchClosedBands) {
    for (int l = 0; l < function.bands; ++l) {
      for (int m = -l; m <= l; ++m) append(l, m);
    }
    return result;
  }
  for (int m = 0; m < function.bands; ++m) {
    for (int l = m; l < function.bands; ++l) {
      append(l, m);
      if (m > 0) append(l, -m);
    }
  }
  return result;
}

}  // namespace

template <class Real>
BatchFunction<Real>::BatchFunction(const ShRgb& function) : table_(make_table<Real>(function.bands)) {
  if (function.coefficients.size() != size_of(function.bands)) {
    throw InputError("sh::BatchFunction: expected " + std::to_string(size_of(function.bands)) +
                     " coefficients for " + std::to_string(function.bands) + " bands, got " +
                     std::to_string(function.coefficients.size()));
  }
  if (has_kernel<Real>(function.bands)) {
    coefficients_ = packed<Real>(function);
  } else {
    function_ = function;
  }
}

template <class Real>
void BatchFunction<Real>::evaluate(const Directions<Real>& directions, const RgbArrays<Real>& values,
                                   int threads) const {
  constexpr const char* kWhere = "sh::BatchFunction::evaluate";
  const std::size_t count = require_same_length(directions, kWhere);
  if (values.r.size() != count || values.g.size() != count || values.b.size() != count) {
    throw InputError(std::string(kWhere) + ": expected room for " + std::to_string(count) +
                     " values a channel, got " + std::to_string(values.r.size()) + ", " +
                     std::to_string(values.g.size()) + " and " + std::to_string(values.b.size()));
  }
  const std::array<std::span<Real>, 3> channels{values.r, values.g, values.b};
  if (!has_kernel<Real>(bands())) {
    return for_each_direction(bands(), directions, [&](std::size_t k, const std::vector<Real>& y) {
      RgbD sum(0.0);
      for (std::size_t i = 0; i < y.size(); ++i) sum += static_cast<double>(y[i]) * function_.coefficients[i];
      for (int c = 0; c < 3; ++c) channels[static_cast<std::size_t>(c)][k] = static_cast<Real>(sum[c]);
    });
  }
  for_blocks(directions, kGroup, threads, [&](std::size_t first, const DirectionBlocks<Real>& in) {
    if (first + in.count <= count) {
      const std::array<Real*, 3> out{values.r.data() + first, values.g.data() + first,
                                     values.b.data() + first};
      return sum_blocks(table_, coefficients_.data(), in, out.data());
    }
    std::array<std::array<Real, kBlockDirections>, 3> block;
    const std::array<Real*, 3> out{block[0].data(), block[1].data(), block[2].data()};
    sum_blocks(table_, coefficients_.data(), in, out.data());
    for (std::size_t c = 0; c < 3; ++c) {
      std::copy_n(block[c].begin(), count - first, channels[c].begin() + static_cast<std::ptrdiff_t>(first));
    }
  });
}

template class BatchFunction<float>;
template class BatchFunction<double>;

}  // namespace plumbline::sh
