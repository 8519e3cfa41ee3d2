#include "validation/app/points_csv.hpp"

#include <fmt/format.h>

#include <cmath>

#include "reference/base/error.hpp"
#include "reference/scene/scene.hpp"
#include "validation/app/csv_table.hpp"

namespace plumbline::app {
namespace {

PointAndNormal point_of(const CsvRow& row) {
  const std::vector<double>& v = row.values;
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (std::abs(v[i]) > static_cast<double>(scene::kLargestCoordinate)) {
      throw InputError(
          fmt::format("{}: column {}: not within {}: {}", row.where, i + 1, scene::kLargestCoordinate, v[i]));
    }
  }
  const Vec3d normal(v[3], v[4], v[5]);
  const double length = glm::length(normal);
  if (!(length > 0.0)) throw InputError(row.where + ": the normal is zero");
  return {Vec3(Vec3d(v[0], v[1], v[2])), Vec3(normal / length)};
}

}  // namespace

std::vector<PointAndNormal> read_points(const std::filesystem::path& path) {
  std::vector<PointAndNormal> points;
  for (const CsvRow& row : read_csv(path, {"x", "y", "z", "nx", "ny", "nz"}, "points")) {
    points.push_back(point_of(row));
  }
  return points;
}

std::string csv_line(const PointAndNormal& at, const RgbD& a, const RgbD& b) {
  return fmt::format("{},{},{},{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", at.position.x,
                     at.position.y, at.position.z, at.normal.x, at.normal.y, at.normal.z, a.x, a.y, a.z, b.x,
                     b.y, b.z);
}

}  // namespace plumbline::app
