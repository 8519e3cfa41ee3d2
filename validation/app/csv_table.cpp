#include "validation/app/csv_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/base/text.hpp"
#include "reference/scene/text.hpp"

namespace plumbline::app {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells = split(line, ',');
  for (std::string_view& cell : cells) cell = trimmed(cell);
  return cells;
}

bool holds_no_number(const std::vector<std::string_view>& cells) {
  return std::none_of(cells.begin(), cells.end(),
                      [](std::string_view cell) { return scene::parse_number(cell).has_value(); });
}

double parse_cell(std::string_view cell, const std::string& where) {
  const std::optional<double> value = scene::parse_number(cell);
  if (!value) throw InputError(fmt::format("{}: not a number: \"{}\"", where, one_line(cell)));
  if (!std::isfinite(*value)) throw InputError(fmt::format("{}: not finite: {}", where, cell));
  return *value;
}

CsvRow parse_row(const std::vector<std::string_view>& cells, const std::vector<std::string>& names,
                 const std::string& where) {
  if (cells.size() < names.size()) {
    throw InputError(
        fmt::format("{}: expected {}, got {} columns", where, fmt::join(names, ","), cells.size()));
  }
  CsvRow row{{}, where};
  for (std::size_t i = 0; i < names.size(); ++i) {
    row.values.push_back(parse_cell(cells[i], fmt::format("{}: column {}", where, i + 1)));
  }
  return row;
}

}  // namespace

std::vector<CsvRow> read_csv(const std::filesystem::path& path, const std::vector<std::string>& names,
                             const std::string& rows) {
  const std::string text = read_file(path);
  std::string_view rest = text;
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (rest.starts_with(kByteOrderMark)) rest.remove_prefix(kByteOrderMark.size());
  std::vector<CsvRow> table;
  bool is_first = true;
  for (int number = 1; const auto line = scene::next_line(rest); ++number) {
    if (trimmed(*line).empty() || line->starts_with('#')) continue;
    const std::vector<std::string_view> cells = cells_of(*line);
    const bool is_header = is_first && holds_no_number(cells);
    is_first = false;
    if (!is_header)
      table.push_back(parse_row(cells, names, fmt::format("{}: line {}", path.string(), number)));
  }
  if (table.empty()) throw InputError(path.string() + ": holds no " + rows);
  return table;
}

}  // namespace plumbline::app
