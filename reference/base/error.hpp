// reference/base/error.hpp: the exceptions for "cannot do the job".
// A failed check is data, never an exception; a ray that misses is std::optional.
#pragma once

#include <stdexcept>
#include <string>

namespace plumbline {

/// The input or the request cannot be used. The message is one line: where (file, field), the relation that
/// is violated, and the actual value. The command exits with 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A device library (Embree, OpenGL) refused to work.
struct DeviceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace plumbline
