#include <utility>

#include "validation/metrics/compare.hpp"
#include "validation/report/report.hpp"

namespace plumbline::report {

Gallery::ErrorMap error_map(std::string label, const image::Image& reference, const image::Image& test,
                            double scale, std::string unit) {
  constexpr int kRampColours = 64;
  const image::Image zero = image::make_image(kRampColours, 1);
  image::Image rising = zero;
  for (int x = 0; x < kRampColours; ++x) {
    rising.at(x, 0) = Rgb(static_cast<float>(scale * x / (kRampColours - 1)));
  }
  return {std::move(label), metrics::heat_map(reference, test, scale), scale, std::move(unit),
          metrics::heat_map(zero, rising, scale)};
}

}  // namespace plumbline::report
