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

/// Sums and differences of pixel k and pixel count + k, for k < count.
void fold_pixels(const float* rgb, std::size_t count, double* sums, double* differences, std::size_t stride);

/// out[3 r + c] = sum over k < count of weights[r][k] channels[c][k], for r < rows; count a multiple of kMomentLanes.
void channel_moments(const double* const* weights, std::size_t rows, const double* channels,
                     std::size_t stride, std::size_t count, double* out);

/// Unit directions of (s[k], t, 1) and ds[k] dt / |(s[k], t, 1)|^3; count a multiple of kMomentLanes.
void face_nodes(const double* s, const double* ds, double t, double dt, std::size_t count, double* x,
                double* y, double* z, double* weight);

}  // namespace plumbline::sh
