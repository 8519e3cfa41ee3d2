#include "validation/truth/require.hpp"

#include <fmt/format.h>

namespace plumbline::truth {

void require(bool holds, const char* function, const char* relation, double value) {
  if (!holds) throw InputError(fmt::format("truth::{}: needs {}, got {}", function, relation, value));
}

}  // namespace plumbline::truth
