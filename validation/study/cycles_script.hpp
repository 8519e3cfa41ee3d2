// validation/study/cycles_script.hpp: cycles.py, embedded at build time.
#pragma once

#include <string_view>

namespace plumbline::study {

[[nodiscard]] std::string_view cycles_script();

}  // namespace plumbline::study
