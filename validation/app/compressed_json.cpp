#include "validation/app/compressed_json.hpp"

namespace plumbline::app {

nlohmann::json compressed_json(const compress::Compressed& compressed) {
  return {{"compression", std::string(to_string(compressed.method))},
          {"clustering", compressed.is_iterative ? "iterative" : "static"},
          {"clusters", compressed.clusters},
          {"components", compressed.components()},
          {"bits", compressed.bits},
          {"error", compressed.relative_error},
          {"clustering_error", compressed.clustering_relative_error},
          {"bake_error", compressed.bake_relative_error},
          {"bytes_per_vertex", compress::bytes_per_vertex(compressed)}};
}

}  // namespace plumbline::app
