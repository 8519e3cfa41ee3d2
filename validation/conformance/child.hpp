// validation/conformance/child.hpp: work that may crash, hang or leave, in a process of its own.
#pragma once

#include <functional>
#include <string>

namespace plumbline::conformance {

struct ChildResult {
  bool is_complete = false;  // the work returned and its text arrived whole
  std::string text;          // what it returned
  std::string fate;  // else what happened: "crashes (SIGSEGV)", "hangs: no answer within 10 s", "ends the
                     // process with exit code 0", ...
};

/// Forks; the child runs `work` with standard output and error thrown away, no core file and limited memory, and sends
/// what it returns. A child that is not done in time is killed. Call from a process without other threads.
[[nodiscard]] ChildResult run_in_child(const std::function<std::string()>& work, double seconds);

}  // namespace plumbline::conformance
