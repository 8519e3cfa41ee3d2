// reference/integrate/emitter_sample.hpp: a point of an emissive surface, drawn as seen from a receiver.
#pragma once

#include "reference/trace/surface_point.hpp"

namespace plumbline::integrate {

struct EmitterSample {
  Vec3 direction{0.0F};            // unit, from the receiver
  trace::SurfacePoint on_emitter;  // seen from the receiver's side
  double pdf = 0.0;                // per solid angle at the receiver [sr^-1]
  Rgb radiance{0.0F};
};

}  // namespace plumbline::integrate
