// validation/study/agreement.hpp: do two renderers make the same image?
#pragma once

#include <string>
#include <vector>

#include "reference/image/image.hpp"
#include "validation/checks/finding.hpp"
#include "validation/metrics/compare.hpp"
#include "validation/study/reference_image.hpp"

namespace plumbline::study {

struct Agreement {
  std::vector<checks::Finding> findings;
  metrics::TileZ tiles;  // z of every 16 x 16 tile
  image::Image8
      z_map;  // of the image's size: blue = `test` is darker, red = brighter, white = equal; full colour at kFullZ
};
inline constexpr double kFullZ = 5.0;

/// Findings of the family "agreement", named "<names> / …":
///   mean difference  mean of test - base over the mean of base, +- 0.5 %: what two right renderers are held to in this project
///   tiles            largest |z| of the mean differences of 16 x 16 tiles, against the bound that even one of them passes by
///                    chance with probability 1e-4 (Sidak)
///   block median     median over tiles of test / base, within 1 % of 1
///   block 1 %, 99 %  1 % and 99 % quantile of the same, within 3 % of 1 (two independent renderers of public standing were measured
///                    at -1.4 % and +2.5 %)
/// Tiles whose mean is below 1e-3 of the image's mean have no ratio. Noise is taken from the halves; where it alone could break a
/// bound or hide a breach, the verdict is `inconclusive`.
/// @throws InputError for different sizes.
[[nodiscard]] Agreement compare_renderers(const std::string& names, const Halved& base, const Halved& test);

}  // namespace plumbline::study
