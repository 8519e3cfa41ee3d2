// validation/app/numbers_json.hpp: coefficients as anybody writes them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace plumbline::app {

struct Numbers {
  std::vector<double> values;     // in the order of the file
  std::string stated_convention;  // the object's "convention", as it stands; empty when there is none
};

/// A JSON array of numbers, nested in any way (27 numbers, 9 rows of 3, 3 rows of 9), or an object with such an array
/// as "coefficients".
/// @throws InputError naming the file: missing, malformed, no such array, what is not a finite number and where
[[nodiscard]] Numbers read_numbers(const std::filesystem::path& path);

}  // namespace plumbline::app
