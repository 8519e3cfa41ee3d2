// reference/base/parallel.hpp: the one place that knows the threading library (oneTBB).
#pragma once

#include <cstddef>
#include <functional>

namespace plumbline {

/// Calls body(i) for i = 0 … count-1 on `threads` threads (0 = all the machine has). The body must write only
/// to what belongs to its index, so that the result does not depend on the number of threads.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t index)>& body);

}  // namespace plumbline
