// validation/app/csv_table.hpp: tables of numbers.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace plumbline::app {

struct CsvRow {
  std::vector<double> values;
  std::string where;  // "FILE: line N", for messages
};

/// The first `names.size()` columns of a comma-separated table; further ones are ignored. Empty lines, lines that
/// start with # and a first line that holds no number (the columns' names) are skipped.
/// @param rows  what the rows are, for the message where there are none: "points"
/// @throws InputError naming file and line: too few columns, not a number, not finite, no row
[[nodiscard]] std::vector<CsvRow> read_csv(const std::filesystem::path& path,
                                           const std::vector<std::string>& names, const std::string& rows);

}  // namespace plumbline::app
