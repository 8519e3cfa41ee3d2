// prt/sh/batch_closed-inl.hpp: the polynomials of up to five bands on vectors of directions. Included once for each
// instruction set: no ordinary include guard.
#if defined(PLUMBLINE_PRT_SH_BATCH_CLOSED_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMBLINE_PRT_SH_BATCH_CLOSED_INL
#undef PLUMBLINE_PRT_SH_BATCH_CLOSED_INL
#else
#define PLUMBLINE_PRT_SH_BATCH_CLOSED_INL
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace plumbline::sh {
namespace HWY_NAMESPACE {

// The constants are those of basis.cpp (evaluate_closed): y_lm is a polynomial in z times Re or Im (x + iy)^|m|.

/// Gives value i of `kBands` bands at unit (x, y, z) to sink(i, value).
template <int kBands, class D, class V = hwy::HWY_NAMESPACE::Vec<D>, class Sink>
HWY_INLINE void evaluate_closed(D d, V x, V y, V z, const Sink& sink) {
  namespace hn = hwy::HWY_NAMESPACE;
  using T = hn::TFromD<D>;
  const auto k = [d](double value) HWY_ATTR { return hn::Set(d, static_cast<T>(value)); };
  sink(0, k(0.282094791773878143474));
  if constexpr (kBands > 1) {
    const V minus_k1 = k(-0.4886025119029199215864);
    sink(1, hn::Mul(minus_k1, y));
    sink(2, hn::Mul(k(0.4886025119029199215864), z));
    sink(3, hn::Mul(minus_k1, x));
  }
  if constexpr (kBands > 2) {
    const V zz = hn::Mul(z, z);
    const V re2 = hn::MulSub(x, x, hn::Mul(y, y));
    const V half_im2 = hn::Mul(x, y);
    const V q21 = hn::Mul(k(-1.092548430592079070543), z);
    sink(4, hn::Mul(k(1.092548430592079070543), half_im2));
    sink(5, hn::Mul(q21, y));
    sink(6, hn::MulSub(k(0.9461746957575600180927), zz, k(0.3153915652525200060309)));
    sink(7, hn::Mul(q21, x));
    sink(8, hn::Mul(k(0.5462742152960395352717), re2));
    if constexpr (kBands > 3) {
      const V im2 = hn::Add(half_im2, half_im2);
      const V re3 = hn::MulSub(x, re2, hn::Mul(y, im2));
      const V im3 = hn::MulAdd(x, im2, hn::Mul(y, re2));
      const V q31 = hn::NegMulAdd(k(2.285228997322328680790), zz, k(0.4570457994644657361580));
      const V q32 = hn::Mul(k(1.445305721320277027695), z);
      const V minus_k33 = k(-0.5900435899266435103456);
      sink(9, hn::Mul(minus_k33, im3));
      sink(10, hn::Mul(q32, im2));
      sink(11, hn::Mul(q31, y));
      sink(12, hn::Mul(z, hn::MulSub(k(1.865881662950576957072), zz, k(1.119528997770346174243))));
      sink(13, hn::Mul(q31, x));
      sink(14, hn::Mul(q32, re2));
      sink(15, hn::Mul(minus_k33, re3));
      if constexpr (kBands > 4) {
        const V q41 = hn::Mul(z, hn::NegMulAdd(k(4.683325804901024175665), zz, k(2.007139630671867503856)));
        const V q42 = hn::MulSub(k(3.311611435151460063324), zz, k(0.4730873478787800090463));
        const V q43 = hn::Mul(k(-1.770130769779930531037), z);
        const V k44 = k(0.6258357354491761345866);
        sink(16, hn::Mul(hn::Mul(k(1.2516714708983522691732), re2), im2));
        sink(17, hn::Mul(q43, im3));
        sink(18, hn::Mul(q42, im2));
        sink(19, hn::Mul(q41, y));
        const V inner = hn::MulSub(k(3.702494142032150633097), zz, k(3.173566407456129114083));
        sink(20, hn::MulAdd(zz, inner, k(0.3173566407456129114083)));
        sink(21, hn::Mul(q41, x));
        sink(22, hn::Mul(q42, re2));
        sink(23, hn::Mul(q43, re3));
        sink(24, hn::Mul(k44, hn::MulSub(re2, re2, hn::Mul(im2, im2))));
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace plumbline::sh
HWY_AFTER_NAMESPACE();

#endif
