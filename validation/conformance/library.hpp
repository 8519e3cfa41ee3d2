// validation/conformance/library.hpp: loads an implementation and distrusts what it says about itself.
#pragma once

#include <string>

#include "validation/conformance/plumbline_conformance.h"

namespace plumbline::conformance {

struct Loaded {
  const plumbline_implementation* implementation = nullptr;  // null: `fault` says why
  std::string fault;
};
/// Loads the library (which stays loaded), calls its entry and checks the struct. Whatever is wrong is in `fault`. Its
/// initialisers and the entry run: only to be called in a child process.
[[nodiscard]] Loaded load_library(const std::string& path);

/// Empty for a struct that can be used; else what is wrong with it.
[[nodiscard]] std::string fault_of(const plumbline_implementation& implementation);

}  // namespace plumbline::conformance
