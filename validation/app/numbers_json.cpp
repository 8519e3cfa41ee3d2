#include "validation/app/numbers_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/base/text.hpp"

namespace plumbline::app {
namespace {

using nlohmann::json;

/// Deeper nesting than anybody's, and far from what a stack holds.
constexpr int kDeepest = 8;

std::string shown(const json& value) {
  constexpr std::size_t kLongest = 60;
  return one_line(value.dump(-1, ' ', true, json::error_handler_t::replace), kLongest);
}

void append_numbers(const json& value, const std::string& where, int depth, std::vector<double>& numbers) {
  if (value.is_number()) {
    numbers.push_back(value.get<double>());
    if (std::isfinite(numbers.back())) return;
  }
  if (!value.is_array() || depth > kDeepest) {
    throw InputError(fmt::format("{}: expected finite numbers, got {}", where, shown(value)));
  }
  for (std::size_t i = 0; i < value.size(); ++i) {
    append_numbers(value[i], fmt::format("{}[{}]", where, i), depth + 1, numbers);
  }
}

json parse(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  try {
    return json::parse(text);
  } catch (const json::exception& error) {
    throw InputError(path.string() + ": not valid JSON: " + one_line(error.what()));
  }
}

}  // namespace

Numbers read_numbers(const std::filesystem::path& path) {
  const json document = parse(path);
  Numbers numbers;
  if (document.is_array()) {
    append_numbers(document, path.string() + ": ", 0, numbers.values);
  } else if (document.is_object() && document.contains("coefficients")) {
    append_numbers(document["coefficients"], path.string() + ": coefficients", 0, numbers.values);
    if (document.contains("convention") && document["convention"].is_string()) {
      numbers.stated_convention = one_line(document["convention"].get<std::string>());
    }
  } else {
    throw InputError(
        fmt::format("{}: expected an array of numbers, or an object with \"coefficients\", got {}",
                    path.string(), shown(document)));
  }
  if (numbers.values.empty()) throw InputError(path.string() + ": holds no numbers");
  return numbers;
}

}  // namespace plumbline::app
