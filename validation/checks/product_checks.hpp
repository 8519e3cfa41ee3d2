// validation/checks/product_checks.hpp: how far products, exponentials and logarithms of an implementation are from
// the truth. Like sh_checks.hpp: the implementation is a callable, 0 is perfect, a NaN makes the result NaN.
#pragma once

#include <functional>
#include <vector>

namespace plumbline::checks {

/// Both factors and the result hold n^2 coefficients.
using ProductUnderTest =
    std::function<std::vector<double>(const std::vector<double>& a, const std::vector<double>& b)>;
/// From n^2 coefficients to n^2.
using FunctionUnderTest = std::function<std::vector<double>(const std::vector<double>& f)>;

/// Largest |product - projection of the pointwise product| over fixed pairs of vectors with coefficients in [-1, 1],
/// and over (1 + z)^2. The quadrature is exact for the degree. Sees wrong constants, signs and mixed-up terms.
[[nodiscard]] double product_deviation(const ProductUnderTest& product, int bands);

/// Largest relative |exp(a) - e^a|, a constant from -20 to 10. Sees a wrong factor between f_0 and the mean.
[[nodiscard]] double constant_exponential_deviation(const FunctionUnderTest& exponential, int bands);

/// Largest |log(e^a) - a| / max(1, |a|), a constant from -2.5 to 5.
[[nodiscard]] double constant_logarithm_deviation(const FunctionUnderTest& logarithm, int bands);

/// Largest |exponential - exp(M_f) 1| / |exp(M_f) 1| over fixed f with |f^| = 1, what a product series tends to.
[[nodiscard]] double series_limit_deviation(const FunctionUnderTest& exponential, int bands);

}  // namespace plumbline::checks
