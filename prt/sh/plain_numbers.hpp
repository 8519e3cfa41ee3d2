// prt/sh/plain_numbers.hpp: the few vector operations of product_kernel-inl.hpp on single numbers.
// Inside the library only. Highway's own form for machines without vectors keeps them in arrays and is three times slower.
#pragma once

namespace plumbline::sh::plain {

/// Stands where Highway has its tag of a vector type.
template <class T>
struct Number {
  using type = T;
};
template <class D>
using TFromD = typename D::type;
template <class D>
using Vec = typename D::type;

template <class D>
inline Vec<D> Zero(D) {
  return 0;
}
template <class D>
inline Vec<D> Set(D, typename D::type value) {
  return value;
}
template <class D>
inline Vec<D> LoadU(D, const typename D::type* from) {
  return *from;
}
template <class T, class D>
inline void StoreU(T value, D, typename D::type* to) {
  *to = value;
}
template <class T>
inline T Add(T a, T b) {
  return a + b;
}
template <class T>
inline T Mul(T a, T b) {
  return a * b;
}

}  // namespace plumbline::sh::plain
