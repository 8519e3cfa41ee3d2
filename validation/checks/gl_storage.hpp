// validation/checks/gl_storage.hpp: what short numbers cost in OpenGL, and where they end.
#pragma once

#include <cstddef>
#include <vector>

#include "prt/relight/gl/renderer.hpp"
#include "prt/transfer/baked_file.hpp"

namespace plumbline::checks {

/// Exit radiance for unit albedo at the vertices, by a transfer stored in few bits against the same stored as f32.
struct StorageError {
  relight::gl::Storage storage = relight::gl::Storage::f32;
  std::size_t bytes_per_vertex = 0;
  double relative_rmse = 0.0;  // over the mean magnitude
  double of_terms = 0.0;       // largest |difference| / sum_i |T_i l_i|
};
[[nodiscard]] std::vector<StorageError> storage_errors(const relight::gl::Context& context,
                                                       const transfer::Baked& baked,
                                                       const sh::ShRgb& lighting);

/// The brightest image that a target still holds: the scene's light is made brighter until a sample is Inf, NaN, or the
/// brightest one is off by more than half precision's 2^-10.
struct TargetRange {
  relight::gl::Target target = relight::gl::Target::f32;
  double largest_radiance = 0.0;  // of any sample, to a relative 1e-5
  double light_scale = 0.0;       // of the light there
  bool saturates = false;         // a little beyond there is no Inf, but the wrong finite number
};
/// @throws InputError when the light, or the image of the scene, is black.
[[nodiscard]] std::vector<TargetRange> target_ranges(const relight::gl::Context& context,
                                                     const transfer::Baked& baked, const sh::ShRgb& lighting,
                                                     const scene::Camera& camera);

}  // namespace plumbline::checks
