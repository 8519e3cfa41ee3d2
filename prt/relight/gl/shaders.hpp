// prt/relight/gl/shaders.hpp: the shaders of relighting.
#pragma once

#include "prt/relight/gl/object.hpp"

namespace plumbline::relight::gl {

/// Light times transfer, one vertex an invocation, captured by transform feedback as `unit_radiance`.
/// `sums_in_double`: the driver has GL_ARB_gpu_shader_fp64. `has_ranges`: the transfer is stored as unorm.
[[nodiscard]] ProgramSource vertex_pass_source(bool sums_in_double, bool has_ranges);

/// The scene through a camera: barycentric interpolation, albedo, nearest triangle.
[[nodiscard]] ProgramSource view_source();

}  // namespace plumbline::relight::gl
