// prt/relight/gl/library.hpp: a shared library opened at run time.
#pragma once

#include <string>

namespace plumbline::relight::gl {

/// Stays open to the end of the process: drivers leave threads and exit handlers behind, which must still find their code.
class Library {
 public:
  /// `names` separated by spaces, tried in turn. @throws DeviceError "<what>: <the loader's reason for the first>".
  Library(const std::string& what, const std::string& names);

  /// nullptr when there is no such symbol.
  [[nodiscard]] void* find(const char* symbol) const;
  /// The same. @throws DeviceError "<what>: <library> has no <symbol>".
  template <class Function>
  [[nodiscard]] Function require(const char* symbol) const {
    return reinterpret_cast<Function>(require_address(symbol));
  }

 private:
  [[nodiscard]] void* require_address(const char* symbol) const;

  std::string what_;
  std::string name_;
  void* handle_ = nullptr;
};

}  // namespace plumbline::relight::gl
