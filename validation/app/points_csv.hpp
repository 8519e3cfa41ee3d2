// validation/app/points_csv.hpp: points and normals from a table.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reference/base/vector.hpp"

namespace plumbline::app {

struct PointAndNormal {
  Vec3 position{0.0F};
  Vec3 normal{0.0F};  // unit
};

/// Comma-separated x,y,z,nx,ny,nz a line; empty lines, lines that start with # and a first line that holds no
/// number (the columns' names) are skipped; further columns are ignored. Normals are normalised.
/// @throws InputError naming file and line: too few columns, not a number, not finite, farther out than any
/// scene may be, zero normal.
[[nodiscard]] std::vector<PointAndNormal> read_points(const std::filesystem::path& path);

/// One line "x,y,z,nx,ny,nz,a_r,a_g,a_b,b_r,b_g,b_b": a point, its normal and two colours of it, with the
/// digits that bring every float back.
[[nodiscard]] std::string csv_line(const PointAndNormal& at, const RgbD& a, const RgbD& b);

}  // namespace plumbline::app
