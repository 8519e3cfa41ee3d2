#include "prt/sh/basis.hpp"

#include <string>

#include "reference/base/error.hpp"

namespace plumbline::sh {

void require_bands(int bands) {
  if (bands < 1 || bands > kMaxBands) {
    throw InputError("bands: expected 1 to " + std::to_string(kMaxBands) + ", got " + std::to_string(bands));
  }
}

}  // namespace plumbline::sh
