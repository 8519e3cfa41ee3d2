// validation/tests/report/sample_report.hpp: a made-up but plausible report, for tests and for looking at the
// page.
#pragma once

#include "validation/report/report.hpp"

namespace plumbline::report {

/// 3 pictures of 256 x 256 and an error map, 2 charts, a table, 12 findings of which one fails and one is
/// undecided.
[[nodiscard]] Report sample_report();

}  // namespace plumbline::report
