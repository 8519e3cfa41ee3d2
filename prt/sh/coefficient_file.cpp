// Coefficient files: to_json and read_coefficients of lighting.hpp.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "prt/sh/convention.hpp"
#include "prt/sh/lighting.hpp"
#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/base/text.hpp"

namespace plumbline::sh {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& reason) {
  throw InputError(path.string() + ": " + reason);
}

json parse(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  try {
    return json::parse(text);
  } catch (const json::exception& error) {
    refuse(path, std::string("not valid JSON: ") + one_line(error.what()));
  }
}

/// A short value for an error message, whatever it is.
std::string shown(const json& value) {
  constexpr std::size_t kLongest = 60;
  std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

int read_bands(const std::filesystem::path& path, const json& document) {
  if (!document.contains("bands")) refuse(path, "bands: missing");
  const json& bands = document["bands"];
  const bool is_usable =
      bands.is_number_integer() && bands.get<double>() >= 1.0 && bands.get<double>() <= kMaxBands;
  if (!is_usable) {
    refuse(path, fmt::format("bands: expected an integer from 1 to {}, got {}", kMaxBands, shown(bands)));
  }
  return bands.get<int>();
}

void require_convention(const std::filesystem::path& path, const json& document) {
  if (!document.contains("convention")) refuse(path, "convention: missing");
  const json& convention = document["convention"];
  if (convention != kConventionName) {
    refuse(path, fmt::format("convention: expected \"{}\", got {}", kConventionName, shown(convention)));
  }
}

RgbD read_row(const std::filesystem::path& path, const json& row, std::size_t i) {
  bool is_usable = row.is_array() && row.size() == 3;
  RgbD value(0.0);
  for (std::size_t channel = 0; is_usable && channel < 3; ++channel) {
    is_usable = row[channel].is_number() && std::isfinite(row[channel].get<double>());
    if (is_usable) value[static_cast<glm::length_t>(channel)] = row[channel].get<double>();
  }
  if (!is_usable) {
    refuse(path, fmt::format("coefficients[{}]: expected three finite numbers, got {}", i, shown(row)));
  }
  return value;
}

/// How many numbers stand on a line: what belongs together.
std::size_t row_length(Layout layout, std::size_t count) {
  if (layout == Layout::interleaved) return 3;
  if (layout == Layout::planar || layout == Layout::cosine_sine) return count / 3;
  return layout == Layout::splat ? count : 4;
}

}  // namespace

std::string to_json(const ShRgb& lighting) {
  require_bands(lighting.bands);
  const auto expected = static_cast<std::size_t>(coefficient_count(lighting.bands));
  if (lighting.coefficients.size() != expected) {
    throw InputError(fmt::format("sh::to_json: expected {} coefficients for {} bands, got {}", expected,
                                 lighting.bands, lighting.coefficients.size()));
  }
  std::string text = fmt::format("{{\n  \"bands\": {},\n  \"convention\": \"{}\",\n  \"coefficients\": [\n",
                                 lighting.bands, kConventionName);
  for (std::size_t i = 0; i < expected; ++i) {
    const RgbD& c = lighting.coefficients[i];
    if (!(std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b))) {
      throw InputError(fmt::format("sh::to_json: coefficients[{}]: not finite: {} {} {}", i, c.r, c.g, c.b));
    }
    text += fmt::format("    [{:.17g}, {:.17g}, {:.17g}]{}\n", c.r, c.g, c.b, i + 1 < expected ? "," : "");
  }
  return text + "  ]\n}\n";
}

std::string to_json(const ShRgb& lighting, const KnownConvention& known) {
  if (known.name == known_conventions().front().name) return to_json(lighting);
  if (lighting.bands > known.max_bands) {
    throw InputError(fmt::format("convention {}: expected at most {} bands, got {}", known.name,
                                 known.max_bands, lighting.bands));
  }
  const std::vector<double> values = from_ours(lighting, known.convention);
  const std::size_t length = row_length(known.convention.layout, values.size());
  std::string text = fmt::format("{{\n  \"bands\": {},\n  \"convention\": \"{}\",\n  \"coefficients\": [\n",
                                 lighting.bands, known.name);
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += i % length == 0 ? "    [" : ", ";
    text += fmt::format("{:.17g}", values[i]);
    if (i % length == length - 1) text += i + 1 < values.size() ? "],\n" : "]\n";
  }
  return text + "  ]\n}\n";
}

ShRgb read_coefficients(const std::filesystem::path& path) {
  const json document = parse(path);
  if (!document.is_object()) refuse(path, "expected a JSON object, got " + shown(document));
  ShRgb result;
  result.bands = read_bands(path, document);
  require_convention(path, document);
  if (!document.contains("coefficients")) refuse(path, "coefficients: missing");
  const json& rows = document["coefficients"];
  const auto expected = static_cast<std::size_t>(coefficient_count(result.bands));
  if (!rows.is_array() || rows.size() != expected) {
    refuse(path,
           fmt::format("coefficients: expected an array of {} rows for {} bands, got {}", expected,
                       result.bands, rows.is_array() ? std::to_string(rows.size()) + " rows" : shown(rows)));
  }
  for (std::size_t i = 0; i < expected; ++i) result.coefficients.push_back(read_row(path, rows[i], i));
  return result;
}

}  // namespace plumbline::sh
