#include "validation/app/gather_output.hpp"

#include <fmt/format.h>

#include <memory>
#include <sstream>

#include "prt/sh/basis.hpp"
#include "prt/sh/lighting.hpp"
#include "validation/app/common.hpp"

namespace plumbline::app {

std::vector<RgbColumn> bounce_columns(const std::vector<integrate::BouncesEstimate>& estimates) {
  std::vector<RgbColumn> columns;
  const std::size_t bounces = estimates.empty() ? 0 : estimates.front().bounces.size();
  for (std::size_t k = 0; k < bounces; ++k) {
    RgbColumn mean{fmt::format("E{}", k), {}};
    RgbColumn error{fmt::format("stderr{}", k), {}};
    for (const integrate::BouncesEstimate& estimate : estimates) {
      mean.values.push_back(estimate.bounces[k].mean);
      error.values.push_back(estimate.bounces[k].standard_error);
    }
    columns.push_back(std::move(mean));
    columns.push_back(std::move(error));
  }
  return columns;
}

RgbColumn reflected_column(const std::vector<Rgb>& albedos,
                           const std::vector<integrate::RgbEstimate>& irradiance) {
  RgbColumn column{"L", {}};
  for (std::size_t v = 0; v < albedos.size(); ++v)
    column.values.push_back(RgbD(albedos[v]) * irradiance[v].mean / kPi);
  return column;
}

std::string with_columns(const std::string& csv, const std::vector<RgbColumn>& columns) {
  std::stringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  std::string text = line;
  for (const RgbColumn& column : columns) text += fmt::format(",{0}_r,{0}_g,{0}_b", column.name);
  text += '\n';
  for (std::size_t i = 0; std::getline(lines, line); ++i) {
    text += line;
    for (const RgbColumn& column : columns) {
      const RgbD& value = column.values.at(i);
      text += fmt::format(",{:.9g},{:.9g},{:.9g}", value.x, value.y, value.z);
    }
    text += '\n';
  }
  return text;
}

integrate::SphereFunctions sh_functions(int bands) {
  const auto basis = std::make_shared<const sh::Basis<double>>(bands);
  return {static_cast<std::size_t>(sh::coefficient_count(bands)),
          [basis](const Vec3d& direction, std::span<double> values) {
            basis->evaluate(direction.x, direction.y, direction.z, values);
          }};
}

nlohmann::json probes_json(int bands, const std::vector<PointAndNormal>& points,
                           const std::vector<std::vector<integrate::RgbEstimate>>& probes) {
  const auto row = [](const RgbD& value) {
    return nlohmann::json::array({number(value.x), number(value.y), number(value.z)});
  };
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t i = 0; i < probes.size(); ++i) {
    nlohmann::json coefficients = nlohmann::json::array();
    nlohmann::json errors = nlohmann::json::array();
    for (const integrate::RgbEstimate& coefficient : probes[i]) {
      coefficients.push_back(row(coefficient.mean));
      errors.push_back(row(coefficient.standard_error));
    }
    const Vec3 at = points[i].position;
    list.push_back({{"position", {at.x, at.y, at.z}},
                    {"coefficients", std::move(coefficients)},
                    {"stderr", std::move(errors)}});
  }
  return {{"bands", bands}, {"convention", sh::kConventionName}, {"points", std::move(list)}};
}

}  // namespace plumbline::app
