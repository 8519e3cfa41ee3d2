// The inner loops of the projection of images. This file is compiled once for each instruction set (foreach_target.h).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prt/sh/moment_kernels.cpp"
// SSE4 adds nothing to SSSE3 here; vectors without a fixed size fit in no array.
#define HWY_DISABLED_TARGETS (HWY_SSE4 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#include <hwy/foreach_target.h>
// foreach_target.h comes first
#include <hwy/highway.h>

#include "prt/sh/moment_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace plumbline::sh {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Wide = hn::CappedTag<double, 8>;
using Narrow = hn::Rebind<float, Wide>;
using Numbers = hn::Vec<Wide>;
constexpr std::size_t kLanes = hn::MaxLanes(Wide());

struct Pixels {
  Numbers channel[3];
};

HWY_INLINE Pixels load_pixels(const float* rgb) {
  const Wide d;
  hn::Vec<Narrow> r, g, b;
  hn::LoadInterleaved3(Narrow(), rgb, r, g, b);
  return {{hn::PromoteTo(d, r), hn::PromoteTo(d, g), hn::PromoteTo(d, b)}};
}

void split(const float* rgb, std::size_t count, double* channels, std::size_t stride) {
  const Wide d;
  std::size_t k = 0;
  for (; k + kLanes <= count; k += kLanes) {
    const Pixels pixels = load_pixels(rgb + 3 * k);
    for (std::size_t c = 0; c < 3; ++c) hn::StoreU(pixels.channel[c], d, channels + c * stride + k);
  }
  for (; k < count; ++k) {
    for (std::size_t c = 0; c < 3; ++c) channels[c * stride + k] = static_cast<double>(rgb[3 * k + c]);
  }
}

void fold(const float* rgb, std::size_t count, double* sums, double* differences, std::size_t stride) {
  const Wide d;
  const float* second = rgb + 3 * count;
  std::size_t k = 0;
  for (; k + kLanes <= count; k += kLanes) {
    const Pixels a = load_pixels(rgb + 3 * k);
    const Pixels b = load_pixels(second + 3 * k);
    for (std::size_t c = 0; c < 3; ++c) {
      hn::StoreU(hn::Add(a.channel[c], b.channel[c]), d, sums + c * stride + k);
      hn::StoreU(hn::Sub(a.channel[c], b.channel[c]), d, differences + c * stride + k);
    }
  }
  for (; k < count; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto a = static_cast<double>(rgb[3 * k + c]);
      const auto b = static_cast<double>(second[3 * k + c]);
      sums[c * stride + k] = a + b;
      differences[c * stride + k] = a - b;
    }
  }
}

/// kRows rows of weights at once; two vectors at a time, so that the sums do not wait for themselves.
template <std::size_t kRows>
HWY_INLINE void moments_of(const double* const* weights, const double* channels, std::size_t stride,
                           std::size_t count, double* out) {
  const Wide d;
  Numbers even[3 * kRows];
  Numbers odd[3 * kRows];
  for (std::size_t i = 0; i < 3 * kRows; ++i) even[i] = odd[i] = hn::Zero(d);
  for (std::size_t k = 0; k < count; k += 2 * kLanes) {
    for (std::size_t r = 0; r < kRows; ++r) {
      const auto w0 = hn::LoadU(d, weights[r] + k);
      const auto w1 = hn::LoadU(d, weights[r] + k + kLanes);
      for (std::size_t c = 0; c < 3; ++c) {
        even[3 * r + c] = hn::MulAdd(w0, hn::LoadU(d, channels + c * stride + k), even[3 * r + c]);
        odd[3 * r + c] = hn::MulAdd(w1, hn::LoadU(d, channels + c * stride + k + kLanes), odd[3 * r + c]);
      }
    }
  }
  for (std::size_t i = 0; i < 3 * kRows; ++i)
    out[i] = hn::GetLane(hn::SumOfLanes(d, hn::Add(even[i], odd[i])));
}

void moments(const double* const* weights, std::size_t rows, const double* channels, std::size_t stride,
             std::size_t count, double* out) {
  std::size_t r = 0;
  for (; r + 2 <= rows; r += 2) moments_of<2>(weights + r, channels, stride, count, out + 3 * r);
  if (r < rows) moments_of<1>(weights + r, channels, stride, count, out + 3 * r);
}

void nodes(const double* s, const double* ds, double t, double dt, std::size_t count, double* x, double* y,
           double* z, double* weight) {
  const Wide d;
  const auto one = hn::Set(d, 1.0);
  const auto vt = hn::Set(d, t);
  const auto vdt = hn::Set(d, dt);
  const auto base = hn::Set(d, 1.0 + t * t);
  for (std::size_t k = 0; k < count; k += kLanes) {
    const auto vs = hn::LoadU(d, s + k);
    const auto inverse = hn::Div(one, hn::Sqrt(hn::MulAdd(vs, vs, base)));
    hn::StoreU(hn::Mul(vs, inverse), d, x + k);
    hn::StoreU(hn::Mul(vt, inverse), d, y + k);
    hn::StoreU(inverse, d, z + k);
    const auto cube = hn::Mul(hn::Mul(inverse, inverse), inverse);
    hn::StoreU(hn::Mul(hn::Mul(hn::LoadU(d, ds + k), vdt), cube), d, weight + k);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace plumbline::sh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plumbline::sh {
namespace {

HWY_EXPORT(split);
HWY_EXPORT(fold);
HWY_EXPORT(moments);
HWY_EXPORT(nodes);

}  // namespace

void split_pixels(const float* rgb, std::size_t count, double* channels, std::size_t stride) {
  HWY_DYNAMIC_DISPATCH(split)(rgb, count, channels, stride);
}
void fold_pixels(const float* rgb, std::size_t count, double* sums, double* differences, std::size_t stride) {
  HWY_DYNAMIC_DISPATCH(fold)(rgb, count, sums, differences, stride);
}
void channel_moments(const double* const* weights, std::size_t rows, const double* channels,
                     std::size_t stride, std::size_t count, double* out) {
  HWY_DYNAMIC_DISPATCH(moments)(weights, rows, channels, stride, count, out);
}
void face_nodes(const double* s, const double* ds, double t, double dt, std::size_t count, double* x,
                double* y, double* z, double* weight) {
  HWY_DYNAMIC_DISPATCH(nodes)(s, ds, t, dt, count, x, y, z, weight);
}

}  // namespace plumbline::sh
#endif  // HWY_ONCE
