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

/// Splits `count` RGB pixels into channels, in double.
void split_pixels(const float* rgb, std::size_t count, double* channels, std::size_t stride);

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

/// out[3 r + c] = sum over k < count of weights[r][k] channels[c][k], for r < rows; count a multiple of kMomentLanes.
void channel_moments(const double* const* weights, std::size_t rows, const double* channels,
                     std::size_t stride, std::size_t count, double* out);

/// Unit directions of (s[k], t, 1) and ds[k] dt / |(s[k], t, 1)|^3; count a multiple of kMomentLanes.
void face_nodes(const double* s, const double* ds, double t, double dt, std::size_t count, double* x,
                double* y, double* z, double* weight);

}  // namespace plumbline::sh
