// validation/study/cycles.hpp: Blender's Cycles as one of the methods. The only code that knows Blender.
#pragma once

#include <string>

#include "validation/study/method.hpp"

namespace plumbline::study {

/// Empty when Cycles can render the task; else that no `blender` is on the PATH (Debian package blender), or what of the scene it
/// is not given: lights without extent.
[[nodiscard]] std::string reason_against_cycles(const Task& task);

/// One Blender process for the life of the method, stopped with it. The scene goes there as .glb, the environment as .exr, both in a
/// temporary folder that is removed at the end. `seconds` is Cycles' own "Path Tracing" time: without synchronisation, hierarchy
/// and importance map. @throws InputError when Blender cannot be started or ends before its time, with its last line.
[[nodiscard]] Method make_cycles(const Task& task);

}  // namespace plumbline::study
