// validation/app/points_csv.hpp: points and normals from a table.
#pragma once

#include <filesystem>
#include <vector>

#include "reference/base/vector.hpp"

namespace plumbline::app {

struct PointAndNormal {
  Vec3 position{0.0F};
  Vec3 normal{0.0F};  // unit
};

/// Comma-separated x,y,z,nx,ny,nz a line; a first line that holds names, empty lines and lines that start
/// with # are skipped; further columns are ignored. Normals are normalised. @throws InputError naming file
/// and line: too few columns, not a number, not finite, zero normal.
[[nodiscard]] std::vector<PointAndNormal> read_points(const std::filesystem::path& path);

}  // namespace plumbline::app
