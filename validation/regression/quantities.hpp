// validation/regression/quantities.hpp: the numbers by which a change of scene, light or code is recognised.
#pragma once

#include <vector>

#include "validation/checks/case.hpp"
#include "validation/regression/baseline.hpp"

namespace plumbline::regression {

/// Of every light: its SH coefficients. Of every scene under every light and band count: the mean radiance of the
/// image by unshadowed transfer (exact), by shadowed transfer (16 independent bakes of budget.bake_samples / 16
/// directions), and path traced with all bounces (16 independent renders of budget.image_samples / 16 paths a pixel,
/// at least 2). Red, green and blue apart. Images are 96 pixels wide.
[[nodiscard]] std::vector<Quantity> measure_quantities(const checks::Suite& suite);

/// Times of the inner loops, each of about 5 ms and repeated 15 times in turn with the others, on one thread.
[[nodiscard]] std::vector<KernelTimes> measure_kernels();

}  // namespace plumbline::regression
