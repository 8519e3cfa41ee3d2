// validation/app/gather_output.hpp: what `plumbline gather` writes beside the irradiance.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "reference/integrate/gather.hpp"
#include "reference/integrate/probe.hpp"
#include "validation/app/points_csv.hpp"

namespace plumbline::app {

/// A colour a line: NAME_r,NAME_g,NAME_b.
struct RgbColumn {
  std::string name;
  std::vector<RgbD> values;
};

/// E0, stderr0, E1, stderr1, …: irradiance by number of bounces, with its standard error.
[[nodiscard]] std::vector<RgbColumn> bounce_columns(const std::vector<integrate::BouncesEstimate>& estimates);
/// L = albedo E / pi: the light a vertex reflects (what it emits is not in it).
[[nodiscard]] RgbColumn reflected_column(const std::vector<Rgb>& albedos,
                                         const std::vector<integrate::RgbEstimate>& irradiance);
/// The table with further columns at its right. One value for each line after the first, which holds names.
[[nodiscard]] std::string with_columns(const std::string& csv, const std::vector<RgbColumn>& columns);

/// Bands that --sh takes.
inline constexpr int kMaxProbeBands = 64;
/// Spherical harmonics (CONVENTIONS.md#spherical-harmonics) as the path tracer takes them.
[[nodiscard]] integrate::SphereFunctions sh_functions(int bands);
/// {"bands", "convention", "points": [{"position", "coefficients", "stderr"}]}: n^2 rows [r, g, b] each.
[[nodiscard]] nlohmann::json probes_json(int bands, const std::vector<PointAndNormal>& points,
                                         const std::vector<std::vector<integrate::RgbEstimate>>& probes);

}  // namespace plumbline::app
