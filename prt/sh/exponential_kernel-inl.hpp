// prt/sh/exponential_kernel-inl.hpp: 16 exponentials side by side, for any vector width.
// Inside the library only; included once for every instruction set, hence no include guard of the usual kind.
#if defined(PLUMBLINE_SH_EXPONENTIAL_KERNEL) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMBLINE_SH_EXPONENTIAL_KERNEL
#undef PLUMBLINE_SH_EXPONENTIAL_KERNEL
#else
#define PLUMBLINE_SH_EXPONENTIAL_KERNEL
#endif

#include <hwy/highway.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "prt/sh/exponential_steps.hpp"
#include "prt/sh/product_kernel-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace plumbline::sh::HWY_NAMESPACE {

/// What each of 16 vectors needs before its squarings: exp(f / 2^p) ~ unit 1 + slope f^ (+ curve f^ * f^).
struct LanePlan {
  alignas(64) std::array<float, kProductLanes> unit{};
  alignas(64) std::array<float, kProductLanes> slope{};
  alignas(64) std::array<float, kProductLanes> curve{};
  alignas(64) std::array<float, kProductLanes> squarings{};
  int most_squarings = 0;
};

using BlockVector = hn::CappedTag<float, kProductLanes>;

/// |f^|^2 of each lane.
template <int kBands>
HWY_INLINE void squared_magnitudes(const float* f, float* result) {
  const BlockVector d;
  for (int lane = 0; lane < kProductLanes; lane += static_cast<int>(hn::Lanes(d))) {
    auto sum = hn::Zero(d);
    for (int i = 1; i < kBands * kBands; ++i) {
      const auto value = hn::LoadU(d, f + i * kProductLanes + lane);
      sum = hn::Add(sum, hn::Mul(value, value));
    }
    hn::StoreU(sum, d, result + lane);
  }
}

/// @param table  of the hybrid method; nullptr = 1 + f^ + f^ * f^ / 2
template <int kBands>
HWY_INLINE void plan_lanes(const float* f, const LinearTable* table, LanePlan& plan) {
  alignas(64) std::array<float, kProductLanes> squares;
  squared_magnitudes<kBands>(f, squares.data());
  for (std::size_t p = 0; p < squares.size(); ++p) {
    const double magnitude = std::sqrt(static_cast<double>(squares[p]));
    const double mean = static_cast<double>(f[p]) * detail::kInverseRootFourPi;
    if (!(magnitude <= kLargestMagnitude) || !std::isfinite(mean)) {
      plan.unit[p] = plan.slope[p] = plan.curve[p] = std::numeric_limits<float>::quiet_NaN();
      plan.squarings[p] = 0.0F;
      continue;
    }
    const int squarings = detail::squarings_for(magnitude);
    const double factor = std::ldexp(1.0, -squarings);
    const double height = std::exp(mean * factor);
    const detail::LinearFactors linear =
        table != nullptr ? detail::linear_factors(*table, magnitude * factor) : detail::LinearFactors{};
    plan.unit[p] = static_cast<float>(height * linear.a / detail::kInverseRootFourPi);
    plan.slope[p] = static_cast<float>(height * linear.b * factor);
    plan.curve[p] = static_cast<float>(height * 0.5 * factor * factor);
    plan.squarings[p] = static_cast<float>(squarings);
    plan.most_squarings = std::max(plan.most_squarings, squarings);
  }
}

/// values = unit 1 + slope f^ (+ curve square, where there is one) for all lanes.
template <int kBands>
HWY_INLINE void start_lanes(const float* f, const float* square, const LanePlan& plan, float* values) {
  const BlockVector d;
  for (int lane = 0; lane < kProductLanes; lane += static_cast<int>(hn::Lanes(d))) {
    const auto slope = hn::LoadU(d, plan.slope.data() + lane);
    const auto curve = hn::LoadU(d, plan.curve.data() + lane);
    for (int i = 0; i < kBands * kBands; ++i) {
      const int at = i * kProductLanes + lane;
      auto value = i == 0 ? hn::LoadU(d, plan.unit.data() + lane) : hn::Mul(slope, hn::LoadU(d, f + at));
      if (square != nullptr) value = hn::Add(value, hn::Mul(curve, hn::LoadU(d, square + at)));
      hn::StoreU(value, d, values + at);
    }
  }
}

template <int kBands>
HWY_INLINE void square_lanes(const float* a, float* out) {
  const BlockVector d;
  for (int lane = 0; lane < kProductLanes; lane += static_cast<int>(hn::Lanes(d))) {
    multiply_lanes<kBands, kProductLanes, true>(d, a + lane, a + lane, out + lane);
  }
}

/// values = squared in the lanes that have squarings left.
template <int kBands>
HWY_INLINE void take_squares(const float* squared, const LanePlan& plan, int done, float* values) {
  const BlockVector d;
  for (int lane = 0; lane < kProductLanes; lane += static_cast<int>(hn::Lanes(d))) {
    const auto is_left =
        hn::Gt(hn::LoadU(d, plan.squarings.data() + lane), hn::Set(d, static_cast<float>(done)));
    for (int i = 0; i < kBands * kBands; ++i) {
      const int at = i * kProductLanes + lane;
      const auto kept = hn::LoadU(d, values + at);
      hn::StoreU(hn::IfThenElse(is_left, hn::LoadU(d, squared + at), kept), d, values + at);
    }
  }
}

/// How many lanes hold something not finite: x 0 is NaN for those, and a NaN does not equal itself.
template <int kBands>
HWY_INLINE std::size_t count_not_finite(const float* values) {
  const BlockVector d;
  std::size_t count = 0;
  for (int lane = 0; lane < kProductLanes; lane += static_cast<int>(hn::Lanes(d))) {
    auto sum = hn::Zero(d);
    for (int i = 0; i < kBands * kBands; ++i) {
      sum = hn::Add(sum, hn::Mul(hn::LoadU(d, values + i * kProductLanes + lane), hn::Zero(d)));
    }
    count += hn::Lanes(d) - hn::CountTrue(d, hn::Eq(sum, sum));
  }
  return count;
}

template <int kBands>
std::size_t exponential_of_block(const float* f, const LinearTable* table, float* out) {
  constexpr std::size_t kSize = static_cast<std::size_t>(kBands * kBands * kProductLanes);
  alignas(64) std::array<float, kSize> scratch;
  LanePlan plan;
  plan_lanes<kBands>(f, table, plan);
  if (table == nullptr) {
    // f^ * f^ by way of `out`, which is free until the end.
    std::copy_n(f, kSize, out);
    std::fill_n(out, kProductLanes, 0.0F);
    square_lanes<kBands>(out, scratch.data());
  }
  start_lanes<kBands>(f, table == nullptr ? scratch.data() : nullptr, plan, out);
  for (int k = 0; k < plan.most_squarings; ++k) {
    square_lanes<kBands>(out, scratch.data());
    take_squares<kBands>(scratch.data(), plan, k, out);
  }
  return count_not_finite<kBands>(out);
}

template <int kBands>
std::size_t exponential_of_blocks(std::size_t blocks, const float* f, const LinearTable* table, float* out) {
  std::size_t count = 0;
  for (std::size_t block = 0; block < blocks; ++block) {
    const std::size_t start = block * kBands * kBands * kProductLanes;
    count += exponential_of_block<kBands>(f + start, table, out + start);
  }
  return count;
}

inline std::size_t exponential_unrolled(int bands, std::size_t blocks, const float* f,
                                        const LinearTable* table, float* out) {
  switch (bands) {
    case 2:
      return exponential_of_blocks<2>(blocks, f, table, out);
    case 3:
      return exponential_of_blocks<3>(blocks, f, table, out);
    case 4:
      return exponential_of_blocks<4>(blocks, f, table, out);
    case 5:
      return exponential_of_blocks<5>(blocks, f, table, out);
    default:
      return exponential_of_blocks<6>(blocks, f, table, out);
  }
}

}  // namespace plumbline::sh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // once for every instruction set
