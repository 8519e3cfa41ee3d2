#include "validation/app/points_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/base/text.hpp"
#include "reference/scene/scene.hpp"
#include "reference/scene/text.hpp"

namespace plumbline::app {
namespace {

constexpr std::size_t kColumns = 6;

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
  if (std::abs(*value) > static_cast<double>(scene::kLargestCoordinate)) {
    throw InputError(fmt::format("{}: not within {}: {}", where, scene::kLargestCoordinate, cell));
  }
  return *value;
}

PointAndNormal parse_point(const std::vector<std::string_view>& cells, const std::string& where) {
  if (cells.size() < kColumns) {
    throw InputError(fmt::format("{}: expected x,y,z,nx,ny,nz, got {} columns", where, cells.size()));
  }
  std::array<double, kColumns> v{};
  for (std::size_t i = 0; i < kColumns; ++i) {
    v[i] = parse_cell(cells[i], fmt::format("{}: column {}", where, i + 1));
  }
  const Vec3d normal(v[3], v[4], v[5]);
  const double length = glm::length(normal);
  if (!(length > 0.0)) throw InputError(where + ": the normal is zero");
  return {Vec3(Vec3d(v[0], v[1], v[2])), Vec3(normal / length)};
}

}  // namespace

std::vector<PointAndNormal> read_points(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  std::string_view rest = text;
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (rest.starts_with(kByteOrderMark)) rest.remove_prefix(kByteOrderMark.size());
  std::vector<PointAndNormal> points;
  bool is_first = true;
  for (int number = 1; const auto line = scene::next_line(rest); ++number) {
    if (trimmed(*line).empty() || line->starts_with('#')) continue;
    const std::vector<std::string_view> cells = cells_of(*line);
    const bool is_header = is_first && holds_no_number(cells);
    is_first = false;
    if (!is_header) points.push_back(parse_point(cells, fmt::format("{}: line {}", path.string(), number)));
  }
  if (points.empty()) throw InputError(path.string() + ": holds no points");
  return points;
}

std::string csv_line(const PointAndNormal& at, const RgbD& a, const RgbD& b) {
  return fmt::format("{},{},{},{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", at.position.x,
                     at.position.y, at.position.z, at.normal.x, at.normal.y, at.normal.z, a.x, a.y, a.z, b.x,
                     b.y, b.z);
}

}  // namespace plumbline::app
