// prt/sh/product_kernel-inl.hpp: straight-line products from product_plan.hpp, for any vector width.
// Inside the library only; included once for every instruction set, hence no include guard of the usual kind. With
// PLUMBLINE_SH_PLAIN_NUMBERS it takes plain_numbers.hpp in place of Highway.
#if defined(PLUMBLINE_SH_PRODUCT_KERNEL) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMBLINE_SH_PRODUCT_KERNEL
#undef PLUMBLINE_SH_PRODUCT_KERNEL
#else
#define PLUMBLINE_SH_PRODUCT_KERNEL
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <type_traits>
#include <utility>

#include "prt/sh/product_plan.hpp"

#ifdef PLUMBLINE_SH_PLAIN_NUMBERS
namespace plumbline::sh::plain {
namespace hn = plumbline::sh::plain;
#else
HWY_BEFORE_NAMESPACE();
namespace plumbline::sh::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
#endif

// Multiplications and additions stay apart (no fused multiply-add), so that every instruction set gives the
// same bits.

/// Coefficient i of the lanes at `values`, coefficients kStride apart.
template <int kStride, class D>
HWY_INLINE hn::Vec<D> coefficient(D d, const hn::TFromD<D>* values, int i) {
  return hn::LoadU(d, values + i * kStride);
}

template <class D>
HWY_INLINE hn::Vec<D> constant(D d, double value, float value_f) {
  if constexpr (std::is_same_v<hn::TFromD<D>, float>) {
    return hn::Set(d, value_f);
  } else {
    return hn::Set(d, value);
  }
}

/// Whether the group has coefficients other than (i, i, i) before `entry`.
template <int kBands, int kGroup>
[[nodiscard]] constexpr bool has_linear_before(int entry) {
  for (int n = detail::kPlan<kBands>.groups[kGroup].begin; n < entry; ++n) {
    if (!detail::kPlan<kBands>.entries[static_cast<std::size_t>(n)].is_cube) return true;
  }
  return false;
}

/// One tripling coefficient of a group: c_k += G u, s += G a_k, t += G b_k (t is unused in a square).
template <int kBands, int kGroup, int kEntry, int kStride, bool kIsSquare, class D>
HWY_INLINE void add_entry(D d, const hn::TFromD<D>* a, const hn::TFromD<D>* b, hn::Vec<D> u, hn::Vec<D>& s,
                          hn::Vec<D>& t, hn::Vec<D>* c) {
  constexpr detail::PlanEntry kTerm = detail::kPlan<kBands>.entries[static_cast<std::size_t>(kEntry)];
  const hn::Vec<D> g = constant(d, kTerm.value, kTerm.value_f);
  c[kTerm.k] = hn::Add(c[kTerm.k], hn::Mul(g, u));
  if constexpr (!kTerm.is_cube) {
    constexpr bool kIsFirst = !has_linear_before<kBands, kGroup>(kEntry);
    const hn::Vec<D> from_a = hn::Mul(g, coefficient<kStride>(d, a, kTerm.k));
    s = kIsFirst ? from_a : hn::Add(s, from_a);
    if constexpr (!kIsSquare) {
      const hn::Vec<D> from_b = hn::Mul(g, coefficient<kStride>(d, b, kTerm.k));
      t = kIsFirst ? from_b : hn::Add(t, from_b);
    }
  }
}

template <int kBands, int kGroup, int kStride, bool kIsSquare, class D, int... kOffset>
HWY_INLINE void add_group(D d, const hn::TFromD<D>* a, const hn::TFromD<D>* b, hn::Vec<D>* c,
                          std::integer_sequence<int, kOffset...>) {
  using V = hn::Vec<D>;
  constexpr detail::PlanGroup kPair = detail::kPlan<kBands>.groups[static_cast<std::size_t>(kGroup)];
  constexpr bool kIsDiagonal = kPair.i == kPair.j;
  const V a_i = coefficient<kStride>(d, a, kPair.i);
  const V a_j = coefficient<kStride>(d, a, kPair.j);
  const V b_i = kIsSquare ? a_i : coefficient<kStride>(d, b, kPair.i);
  const V b_j = kIsSquare ? a_j : coefficient<kStride>(d, b, kPair.j);
  V u = hn::Mul(a_i, b_j);
  if constexpr (!kIsDiagonal) u = hn::Add(u, kIsSquare ? u : hn::Mul(a_j, b_i));
  V s = hn::Zero(d);
  V t = hn::Zero(d);
  (add_entry<kBands, kGroup, kPair.begin + kOffset, kStride, kIsSquare>(d, a, b, u, s, t, c), ...);
  if constexpr (has_linear_before<kBands, kGroup>(kPair.end)) {
    const V s_j = hn::Mul(s, b_j);
    c[kPair.i] = hn::Add(c[kPair.i], hn::Add(s_j, kIsSquare ? s_j : hn::Mul(t, a_j)));
    if constexpr (!kIsDiagonal) {
      const V s_i = hn::Mul(s, b_i);
      c[kPair.j] = hn::Add(c[kPair.j], hn::Add(s_i, kIsSquare ? s_i : hn::Mul(t, a_i)));
    }
  }
}

/// The part of coefficient 0: c_i = G (a_0 b_i + a_i b_0), c_0 = G sum a_i b_i.
template <int kBands, int kStride, bool kIsSquare, class D>
HWY_INLINE void start_with_constant(D d, const hn::TFromD<D>* a, const hn::TFromD<D>* b, hn::Vec<D>* c) {
  using V = hn::Vec<D>;
  const V g = constant(d, detail::kInverseRootFourPi, static_cast<float>(detail::kInverseRootFourPi));
  const V a_0 = coefficient<kStride>(d, a, 0);
  const V b_0 = kIsSquare ? a_0 : coefficient<kStride>(d, b, 0);
  V sum = hn::Mul(a_0, b_0);
  HWY_UNROLL(36)
  for (int i = 1; i < kBands * kBands; ++i) {
    const V a_i = coefficient<kStride>(d, a, i);
    const V b_i = kIsSquare ? a_i : coefficient<kStride>(d, b, i);
    const V left = hn::Mul(a_0, b_i);
    c[i] = hn::Mul(g, hn::Add(left, kIsSquare ? left : hn::Mul(a_i, b_0)));
    sum = hn::Add(sum, hn::Mul(a_i, b_i));
  }
  c[0] = hn::Mul(g, sum);
}

template <int kBands, int kStride, bool kIsSquare, class D, int... kGroup>
HWY_INLINE void add_groups([[maybe_unused]] D d, [[maybe_unused]] const hn::TFromD<D>* a,
                           [[maybe_unused]] const hn::TFromD<D>* b, [[maybe_unused]] hn::Vec<D>* c,
                           std::integer_sequence<int, kGroup...>) {
  (add_group<kBands, kGroup, kStride, kIsSquare>(
       d, a, b, c,
       std::make_integer_sequence<int, detail::kPlan<kBands>.groups[kGroup].end -
                                           detail::kPlan<kBands>.groups[kGroup].begin>()),
   ...);
}

/// Lanes(d) products side by side; b is not read in a square. `out` may overlap nothing.
template <int kBands, int kStride, bool kIsSquare, class D>
HWY_NOINLINE void multiply_lanes(D d, const hn::TFromD<D>* HWY_RESTRICT a,
                                 const hn::TFromD<D>* HWY_RESTRICT b, hn::TFromD<D>* HWY_RESTRICT out) {
  constexpr int kCount = kBands * kBands;
  hn::Vec<D> c[kCount];
  start_with_constant<kBands, kStride, kIsSquare>(d, a, b, c);
  add_groups<kBands, kStride, kIsSquare>(
      d, a, b, c, std::make_integer_sequence<int, detail::kPlan<kBands>.group_count>());
  HWY_UNROLL(36)
  for (int i = 0; i < kCount; ++i) hn::StoreU(c[i], d, out + i * kStride);
}

#ifdef PLUMBLINE_SH_PLAIN_NUMBERS
}  // namespace plumbline::sh::plain
#else
}  // namespace plumbline::sh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif  // once for every instruction set
