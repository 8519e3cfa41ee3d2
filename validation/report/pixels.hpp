// validation/report/pixels.hpp: radiance small enough to travel inside a page.
//
// A component v becomes a 16-bit code: the sign in bit 15 and below it
//   0               v = 0, or |v| < 2^-32
//   1 ... 32765     |v| = 2^((code - 16384) / 512)
//   32766, 32767    infinite, not a number
// so every component is kept to one part in 1477 (half a step: 2^(1/1024)) over 64 stops, negative values of
// band-limited light and broken pixels included. Half floats would spend more bits on the same and end at
// 65504.
#pragma once

#include <cstdint>

#include "reference/image/image.hpp"

namespace plumbline::report {

[[nodiscard]] std::uint16_t log_code(float value);
[[nodiscard]] float value_of_log_code(std::uint16_t code);

/// The codes as an 8-bit picture of the same width and twice the height, made to compress well: the upper
/// half holds high bytes, the lower half low bytes, of code(R), code(G) - code(R) + 128, code(B) - code(R) +
/// 128 (modulo 2^16): noise is mostly common to the three channels and cancels in the differences. Not sRGB:
/// to be read as bytes.
[[nodiscard]] image::Image8 pack_radiance(const image::Image& image);
/// The inverse, up to the rounding of the codes.
[[nodiscard]] image::Image unpack_radiance(const image::Image8& packed);

/// Box filter by the smallest whole factor that brings the longer side to at most `longest` pixels.
[[nodiscard]] image::Image shrink(const image::Image& image, int longest);

}  // namespace plumbline::report
