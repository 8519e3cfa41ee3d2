// prt/sh/convention_layout.hpp: rows of red, green, blue as one list of numbers, in the layouts of others.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "prt/sh/convention.hpp"

namespace plumbline::sh {

/// Whether that many rows fit the layout: packed ones take 9, SHTOOLS' a square number.
[[nodiscard]] bool is_packable(Layout layout, std::size_t rows);
/// @throws InputError unless is_packable
[[nodiscard]] std::size_t packed_count(Layout layout, std::size_t rows);
/// @throws InputError unless is_packable
[[nodiscard]] std::vector<double> packed_values(const std::vector<RgbD>& rows, Layout layout);
/// @throws InputError unless is_packable and there are packed_count(layout, rows) values
[[nodiscard]] std::vector<RgbD> unpacked_rows(std::span<const double> values, Layout layout,
                                              std::size_t rows);

}  // namespace plumbline::sh
