// prt/transfer/bundle.hpp: directions that leave one point, in the layout that the vector code wants.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "prt/sh/aligned.hpp"
#include "prt/sh/batch.hpp"

namespace plumbline::transfer {

/// Unit directions with one weight a channel, as arrays that start on cache lines. Room for `capacity`, `count` of them used.
struct Bundle {
  std::size_t capacity = 0;  // a multiple of sh::kBlockDirections
  int channels = 1;
  std::size_t count = 0;
  sh::AlignedVector<float> x;
  sh::AlignedVector<float> y;
  sh::AlignedVector<float> z;
  sh::AlignedVector<float> weights;  // [channel][capacity]

  Bundle(std::size_t room, int channel_count)
      : capacity((room + sh::kBlockDirections - 1) / sh::kBlockDirections * sh::kBlockDirections),
        channels(channel_count),
        x(capacity),
        y(capacity),
        z(capacity),
        weights(capacity * static_cast<std::size_t>(channel_count)) {}

  [[nodiscard]] float* weight(int channel) {
    return weights.data() + static_cast<std::size_t>(channel) * capacity;
  }
  [[nodiscard]] const float* weight(int channel) const {
    return weights.data() + static_cast<std::size_t>(channel) * capacity;
  }
};

/// Where the directions of a set end in a bundle of several.
struct Piece {
  std::uint32_t set = 0;
  std::size_t end = 0;
};

/// Adds one bundle's directions, with their weights, behind another's; there must be room.
inline void append(const Bundle& from, Bundle& to) {
  std::copy_n(from.x.data(), from.count, to.x.data() + to.count);
  std::copy_n(from.y.data(), from.count, to.y.data() + to.count);
  std::copy_n(from.z.data(), from.count, to.z.data() + to.count);
  for (int c = 0; c < to.channels; ++c) std::copy_n(from.weight(c), from.count, to.weight(c) + to.count);
  to.count += from.count;
}

}  // namespace plumbline::transfer
