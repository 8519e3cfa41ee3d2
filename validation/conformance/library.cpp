#include "validation/conformance/library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstring>
#include <filesystem>

#include "validation/conformance/border.hpp"

namespace plumbline::conformance {

std::string fault_of(const plumbline_implementation& implementation) {
  if (implementation.struct_size != sizeof(plumbline_implementation))
    return fmt::format("struct_size is {}, expected {} (compiled against another plumbline_conformance.h?)",
                       implementation.struct_size, sizeof(plumbline_implementation));
  if (implementation.abi_version != PLUMBLINE_CONFORMANCE_VERSION)
    return fmt::format("abi_version is {}, expected {}", implementation.abi_version,
                       PLUMBLINE_CONFORMANCE_VERSION);
  if (implementation.name == nullptr) return "name is NULL";
  if (::strnlen(implementation.name, 1000) == 1000) return "name is longer than 999 bytes";
  if (implementation.precision != PLUMBLINE_PRECISION_DOUBLE &&
      implementation.precision != PLUMBLINE_PRECISION_FLOAT)
    return fmt::format("precision is {}, expected 1 (double) or 2 (float)", implementation.precision);
  if (implementation.max_bands < 1 || implementation.max_bands > 100'000)
    return fmt::format("max_bands is {}, expected 1 to 100000", implementation.max_bands);
  if (implementation.light_unit != PLUMBLINE_LIGHT_PHYSICAL &&
      implementation.light_unit != PLUMBLINE_LIGHT_FACING_ONE)
    return fmt::format("light_unit is {}, expected 0 or 1", implementation.light_unit);
  if (implementation.reserved != 0) return fmt::format("reserved is {}, expected 0", implementation.reserved);
  return fault_of(implementation.convention);
}

Loaded load_library(const std::string& path) {
  // A name without a slash would be searched for in the system's folders.
  const std::string file = std::filesystem::absolute(path).string();
  void* const library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return {nullptr, fmt::format("cannot be loaded: {}", ::dlerror())};
  void* const symbol = ::dlsym(library, PLUMBLINE_CONFORMANCE_ENTRY);
  if (symbol == nullptr) return {nullptr, fmt::format("does not export {}", PLUMBLINE_CONFORMANCE_ENTRY)};
  using Entry = const plumbline_implementation* (*)(std::uint32_t);
  Entry entry = nullptr;
  static_assert(sizeof(entry) == sizeof(symbol));
  std::memcpy(&entry, &symbol, sizeof(entry));
  const plumbline_implementation* const implementation = entry(PLUMBLINE_CONFORMANCE_VERSION);
  if (implementation == nullptr)
    return {nullptr, fmt::format("{} returns NULL for version {}", PLUMBLINE_CONFORMANCE_ENTRY,
                                 PLUMBLINE_CONFORMANCE_VERSION)};
  const std::string fault = fault_of(*implementation);
  return {fault.empty() ? implementation : nullptr, fault};
}

}  // namespace plumbline::conformance
