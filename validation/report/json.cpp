#include <cmath>
#include <string>

#include "validation/report/report.hpp"
#include "validation/report/text.hpp"

namespace plumbline::report {
namespace {

using nlohmann::json;

// JSON has no NaN and no infinity; nlohmann would write null, which reads as "not measured".
json number(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return value;
}

json numbers(const std::vector<double>& values) {
  json result = json::array();
  for (const double value : values) result.push_back(number(value));
  return result;
}

// The caller's own numbers, made writable: non-finite numbers as words, text as UTF-8.
json cleaned(const json& value) {
  if (value.is_number_float()) return number(value.get<double>());
  if (value.is_string()) return clean_text(value.get_ref<const std::string&>());
  if (value.is_array()) {
    json result = json::array();
    for (const json& element : value) result.push_back(cleaned(element));
    return result;
  }
  if (!value.is_object()) return value;
  json result = json::object();
  for (const auto& [key, element] : value.items()) result[clean_text(key)] = cleaned(element);
  return result;
}

json to_json(const checks::Finding& finding) {
  return {{"family", finding.family},     {"name", finding.name},
          {"measured", finding.measured}, {"uncertainty", finding.uncertainty},
          {"bound", finding.bound},       {"expected", finding.expected},
          {"unit", finding.unit},         {"verdict", checks::to_string(verdict(finding))},
          {"source", finding.source},     {"detail", finding.detail},
          {"seconds", finding.seconds},   {"seed", finding.seed}};
}

json to_json(const Series& series) {
  return {{"name", series.name},
          {"x", numbers(series.x)},
          {"y", numbers(series.y)},
          {"y_low", numbers(series.y_low)},
          {"y_high", numbers(series.y_high)},
          {"is_reference", series.is_reference},
          {"is_bars", series.is_bars}};
}

json to_json(const Chart& chart) {
  json result = {{"title", chart.title},     {"caption", chart.caption},   {"x_label", chart.x_label},
                 {"y_label", chart.y_label}, {"is_x_log", chart.is_x_log}, {"is_y_log", chart.is_y_log},
                 {"series", json::array()}};
  for (const Series& series : chart.series) result["series"].push_back(to_json(series));
  return result;
}

json to_json(const Forest& forest) {
  json result = {{"title", forest.title},
                 {"caption", forest.caption},
                 {"unit", forest.unit},
                 {"band", number(forest.band)},
                 {"rows", json::array()}};
  for (const Forest::Row& row : forest.rows) {
    result["rows"].push_back({{"name", row.name},
                              {"value", number(row.value)},
                              {"low", number(row.low)},
                              {"high", number(row.high)},
                              {"verdict", checks::to_string(row.verdict)}});
  }
  return result;
}

json to_json(const Gallery& gallery) {
  json result = {{"title", gallery.title},
                 {"caption", gallery.caption},
                 {"entries", json::array()},
                 {"errors", json::array()}};
  for (const Gallery::Entry& entry : gallery.entries) {
    result["entries"].push_back(
        {{"label", entry.label}, {"width", entry.image.width}, {"height", entry.image.height}});
  }
  for (const Gallery::ErrorMap& error : gallery.errors) {
    result["errors"].push_back({{"label", error.label}, {"scale", error.scale}, {"unit", error.unit}});
  }
  return result;
}

json to_json(const Table& table) {
  return {
      {"title", table.title}, {"caption", table.caption}, {"columns", table.columns}, {"rows", table.rows}};
}

json to_json(const Headline& headline) {
  return {{"label", headline.label}, {"value", headline.value}, {"caption", headline.caption}};
}

template <class T>
json each(const std::vector<T>& values) {
  json result = json::array();
  for (const T& value : values) result.push_back(to_json(value));
  return result;
}

json named(const std::vector<std::pair<std::string, std::string>>& settings) {
  json result = json::object();
  for (const auto& [name, value] : settings) {
    const auto earlier = result.find(name);
    result[name] = earlier == result.end() ? value : earlier->get<std::string>() + ", " + value;
  }
  return result;
}

}  // namespace

json to_json(const Report& report) {
  return cleaned({{"title", report.title},
                  {"summary", report.summary},
                  {"verdict", checks::to_string(verdict(report))},
                  {"date", report.date},
                  {"version", report.version},
                  {"command", report.command},
                  {"machine", report.machine},
                  {"settings", named(report.settings)},
                  {"headlines", each(report.headlines)},
                  {"galleries", each(report.galleries)},
                  {"forests", each(report.forests)},
                  {"charts", each(report.charts)},
                  {"tables", each(report.tables)},
                  {"findings", each(report.findings)},
                  {"data", report.data}});
}

}  // namespace plumbline::report
