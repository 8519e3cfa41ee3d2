#include "prt/sh/recurrence.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace plumbline::sh {

template <class Real>
std::vector<Real> recurrence_starts(int bands) {
  std::vector<Real> starts(static_cast<std::size_t>(bands));
  long double square = 1.0L / (4.0L * std::numbers::pi_v<long double>);  // without the 2 of m > 0
  for (int m = 0; m < bands; ++m) {
    if (m > 0) square *= (2.0L * m + 1.0L) / (2.0L * m);
    const long double start = std::sqrt(m > 0 ? 2.0L * square : square);
    starts[static_cast<std::size_t>(m)] = static_cast<Real>(start / recurrence_scale<Real>(bands));
  }
  return starts;
}

template <class Real>
RecurrenceStep<Real> recurrence_step(int l, int m) {
  const long double sum = static_cast<long double>(l) + m;
  const long double gap = static_cast<long double>(l) - m;
  const long double twice = 2.0L * l;
  const long double gamma = std::sqrt((twice + 1.0L) * sum / ((twice - 1.0L) * gap));
  return {static_cast<Real>(gamma * (gap - 1.0L) / sum), static_cast<Real>(gamma * (twice - 1.0L) / sum),
          static_cast<Real>(gamma)};
}

template std::vector<float> recurrence_starts<float>(int);
template std::vector<double> recurrence_starts<double>(int);
template RecurrenceStep<float> recurrence_step<float>(int, int);
template RecurrenceStep<double> recurrence_step<double>(int, int);

}  // namespace plumbline::sh
