// SSE4 would give what SSSE3 does: the kernels use nothing but +, *, comparisons and loads.
#define HWY_DISABLED_TARGETS HWY_SSE4
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prt/sh/blocks.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "prt/sh/exponential_kernel-inl.hpp"
#include "prt/sh/product_kernel-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace plumbline::sh::HWY_NAMESPACE {

template <int kBands, bool kIsSquare>
void multiply_blocks_of(std::size_t blocks, const float* a, const float* b, float* out) {
  constexpr int kLanes = 16;
  const hn::CappedTag<float, kLanes> d;
  const std::size_t step = hn::Lanes(d);
  for (std::size_t block = 0; block < blocks; ++block) {
    const std::size_t start = block * kBands * kBands * kLanes;
    for (std::size_t lane = start; lane < start + kLanes; lane += step) {
      multiply_lanes<kBands, kLanes, kIsSquare>(d, a + lane, b + lane, out + lane);
    }
  }
}

template <bool kIsSquare>
void multiply_some_blocks(int bands, std::size_t blocks, const float* a, const float* b, float* out) {
  switch (bands) {
    case 2:
      return multiply_blocks_of<2, kIsSquare>(blocks, a, b, out);
    case 3:
      return multiply_blocks_of<3, kIsSquare>(blocks, a, b, out);
    case 4:
      return multiply_blocks_of<4, kIsSquare>(blocks, a, b, out);
    case 5:
      return multiply_blocks_of<5, kIsSquare>(blocks, a, b, out);
    default:
      return multiply_blocks_of<6, kIsSquare>(blocks, a, b, out);
  }
}

void multiply_unrolled(int bands, std::size_t blocks, const float* a, const float* b, float* out) {
  multiply_some_blocks<false>(bands, blocks, a, b, out);
}

void square_unrolled(int bands, std::size_t blocks, const float* a, float* out) {
  multiply_some_blocks<true>(bands, blocks, a, a, out);
}

}  // namespace plumbline::sh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <string>

#include "prt/sh/exponential.hpp"
#include "prt/sh/product.hpp"
#include "prt/sh/product_table.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {

HWY_EXPORT(multiply_unrolled);
HWY_EXPORT(square_unrolled);
HWY_EXPORT(exponential_unrolled);

namespace {

constexpr int kUnrolledBands = 6;

std::size_t block_count(int bands, std::size_t a, std::size_t b, std::size_t out) {
  if (bands < 1 || bands > kMaxProductBands) {
    throw InputError("sh::multiply_blocks: expected 1 to " + std::to_string(kMaxProductBands) +
                     " bands, got " + std::to_string(bands));
  }
  const auto block = static_cast<std::size_t>(bands * bands * kProductLanes);
  if (a != b || a != out || a % block != 0) {
    throw InputError("sh::multiply_blocks: expected equal sizes, multiples of " + std::to_string(block) +
                     ", got " + std::to_string(a) + ", " + std::to_string(b) + " and " + std::to_string(out));
  }
  return a / block;
}

void multiply_by_table(int bands, std::size_t blocks, const float* a, const float* b, float* out) {
  const auto block = static_cast<std::size_t>(bands * bands * kProductLanes);
  for (std::size_t start = 0; start < blocks * block; start += block) {
    detail::multiply_table<float, kProductLanes>(bands, a + start, b + start, out + start);
  }
}

bool is_unrolled(int bands) {
  return bands >= 2 && bands <= kUnrolledBands;
}

int require_unrolled(int bands) {
  if (!is_unrolled(bands)) {
    throw InputError("sh::exponential_blocks: expected 2 to " + std::to_string(kUnrolledBands) +
                     " bands, got " + std::to_string(bands));
  }
  return bands;
}

std::size_t exponential_of_any(int bands, std::span<const float> f, const LinearTable* table,
                               std::span<float> out) {
  const std::size_t blocks = block_count(bands, f.size(), f.size(), out.size());
  return HWY_DYNAMIC_DISPATCH(exponential_unrolled)(bands, blocks, f.data(), table, out.data());
}

}  // namespace

void multiply_blocks(int bands, std::span<const float> a, std::span<const float> b, std::span<float> out) {
  const std::size_t blocks = block_count(bands, a.size(), b.size(), out.size());
  if (!is_unrolled(bands)) return multiply_by_table(bands, blocks, a.data(), b.data(), out.data());
  HWY_DYNAMIC_DISPATCH(multiply_unrolled)(bands, blocks, a.data(), b.data(), out.data());
}

void square_blocks(int bands, std::span<const float> a, std::span<float> out) {
  const std::size_t blocks = block_count(bands, a.size(), a.size(), out.size());
  if (!is_unrolled(bands)) return multiply_by_table(bands, blocks, a.data(), a.data(), out.data());
  HWY_DYNAMIC_DISPATCH(square_unrolled)(bands, blocks, a.data(), out.data());
}

std::size_t exponential_hybrid_blocks(int bands, std::span<const float> f, std::span<float> out) {
  return exponential_of_any(bands, f, &linear_table(require_unrolled(bands)), out);
}

std::size_t exponential_blocks(int bands, std::span<const float> f, std::span<float> out) {
  return exponential_of_any(require_unrolled(bands), f, nullptr, out);
}

}  // namespace plumbline::sh

#endif  // HWY_ONCE
