// validation/app/compressed_json.hpp: what the command says of a compressed transfer.
#pragma once

#include <nlohmann/json.hpp>

#include "prt/compress/compressed.hpp"

namespace plumbline::app {

[[nodiscard]] nlohmann::json compressed_json(const compress::Compressed& compressed);

}  // namespace plumbline::app
