#include "validation/app/points_csv.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <sstream>
#include <string>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"

namespace plumbline::app {
namespace {

bool is_blank(const std::string& line) {
  return line.find_first_not_of(" \t\r") == std::string::npos;
}

bool has_letters(const std::string& line) {
  return line.find_first_of("xyzXYZ") != std::string::npos && line.find("inf") == std::string::npos;
}

PointAndNormal parse_line(const std::string& line, const std::string& where) {
  std::array<float, 6> values{};
  std::stringstream cells(line);
  std::string cell;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::getline(cells, cell, ','))
      throw InputError(fmt::format("{}: expected x,y,z,nx,ny,nz, got {} columns", where, i));
    char* end = nullptr;
    values[i] = std::strtof(cell.c_str(), &end);
    if (end == cell.c_str() || !is_blank(end))
      throw InputError(fmt::format("{}: column {}: not a number: {}", where, i + 1, cell));
    if (!std::isfinite(values[i]))
      throw InputError(fmt::format("{}: column {}: not finite: {}", where, i + 1, cell));
  }
  PointAndNormal point{{values[0], values[1], values[2]}, {values[3], values[4], values[5]}};
  const float length = glm::length(point.normal);
  if (!(length > 0.0F)) throw InputError(where + ": the normal is zero");
  point.normal /= length;
  return point;
}

}  // namespace

std::vector<PointAndNormal> read_points(const std::filesystem::path& path) {
  std::stringstream lines(read_file(path));
  std::vector<PointAndNormal> points;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (is_blank(line) || line[0] == '#' || (number == 1 && has_letters(line))) continue;
    points.push_back(parse_line(line, fmt::format("{}: line {}", path.string(), number)));
  }
  if (points.empty()) throw InputError(path.string() + ": holds no points");
  return points;
}

}  // namespace plumbline::app
