// prt/sh/moment_kernels.hpp: the vector code behind the projection of images, chosen for the machine when the program
// runs. Arrays of three channels are three arrays of `stride` numbers one after the other; counts are padded with zeros
// to a multiple of kMomentLanes.
#pragma once

#include <cstddef>

namespace plumbline::sh {

inline constexpr std::size_t kMomentLanes = 16;
[[nodiscard]] constexpr std::size_t padded(std::size_t count) {
  return (count + kMomentLanes - 1) / kMomentLanes * kMomentLanes;
}

/// How many rows row_moments() takes at a time.
inline constexpr std::size_t kRowsTogether = 4;

/// What row_moments() sums with.
struct RowWeights {
  const double* weights =
      nullptr;             // rows of `stride` numbers, one for each channel of each pixel; 0 beyond 3 pixels
  std::size_t rows = 0;    // an even number: cos 0, sin 0, cos 1, …
  std::size_t stride = 0;  // a multiple of 3 kMomentLanes
  std::size_t pixels = 0;
  bool is_folded = false;  // pixel k goes with pixel k + pixels: added for even m, subtracted for odd
};
/// Numbers of room that row_moments() wants.
[[nodiscard]] constexpr std::size_t row_moments_room(std::size_t weight_rows) {
  return weight_rows * 3 * kRowsTogether * 8;
}
/// Moments of kRowsTogether rows of RGB pixels: out[(row weights.rows + r) 3 + channel].
void row_moments(const float* const* rows, const RowWeights& weights, double* room, double* out);

/// Folds two rows of `width` RGB pixels that are each other's mirror images: with the four pixels at +-x and +-y
/// around the middle, parts[(3 p + c) stride + x] is their sum over +-x and +-y (p = 0), with the sign of x (1; left is +),
/// of y (2; top is +) or of both (3), for x < (width + 1) / 2. A pixel in the middle counts once; `bottom` is null for the
/// row in the middle.
void fold_rows(const float* top, const float* bottom, std::size_t width, double* parts, std::size_t stride);

/// Sums that add_moments() keeps for each moment and channel, to be added at the end.
inline constexpr std::size_t kSumLanes = 8;
/// sums[(3 r + c) kSumLanes …] += parts of the sum over k < count of weights[r stride + k] channels[c stride + k], for
/// r < rows; count a multiple of kMomentLanes.
void add_moments(const double* weights, std::size_t rows, const double* channels, std::size_t stride,
                 std::size_t count, double* sums);

/// Scales the weights of blocks of 16 so that those at place u of all blocks sum to sums[u]; zeros stay.
void scale_weights(double* weight, std::size_t blocks, const double* sums);

/// table[place[i] stride + u] = (is_first ? 0 : itself) + sum over blocks of weight[16 block + u] times value i of
/// direction u of the block, in the blocked layout of batch.hpp, for u < 16 and i < size.
void add_weighted_blocks(const double* weight, const double* values, std::size_t blocks,
                         const std::size_t* place, std::size_t size, bool is_first, double* table,
                         std::size_t stride);

/// Unit directions of (s[k], t, 1) and ds[k] dt / |(s[k], t, 1)|^3; count a multiple of kMomentLanes.
void face_nodes(const double* s, const double* ds, double t, double dt, std::size_t count, double* x,
                double* y, double* z, double* weight);

}  // namespace plumbline::sh
