// prt/sh/half_functions.hpp: weights on the hemisphere about +z, as light maps use them.
#pragma once

#include <cstddef>
#include <vector>

#include "prt/sh/convention.hpp"

namespace plumbline::sh {

/// How many rows of red, green, blue they make. @throws InputError for Functions::sphere
[[nodiscard]] std::size_t half_function_count(Functions functions);

/// The rows for a light given in the frame whose +z is the hemisphere's axis, exactly for the bands that are there.
/// Sign::condon_shortley turns the sign of the functions y and x.
/// @throws InputError for Functions::sphere, or where cosine_lightmap would divide by zero
[[nodiscard]] std::vector<RgbD> half_function_values(const ShRgb& light, Functions functions, Sign sign);

}  // namespace plumbline::sh
