// prt/transfer/bundle.hpp: directions that leave one point, in the layout that the vector code wants.
#pragma once

#include <cstddef>

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

}  // namespace plumbline::transfer
