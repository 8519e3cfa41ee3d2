#include "prt/compress/seams.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace plumbline::compress {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

std::vector<Edge> edges_of(std::span<const glm::uvec3> triangles) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (const glm::uvec3& t : triangles) {
    for (const auto& [a, b] : {Edge{t.x, t.y}, Edge{t.y, t.z}, Edge{t.z, t.x}})
      edges.push_back(std::minmax(a, b));
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

struct Jump {
  double exact = 0.0;
  double compressed = 0.0;
  double added = 0.0;
};

Jump squared_jump(const Edge& edge, const Vectors& exact, const Vectors& compressed) {
  Jump sum;
  for (std::size_t i = 0; i < exact.dimension; ++i) {
    const double before =
        static_cast<double>(exact[edge.first][i]) - static_cast<double>(exact[edge.second][i]);
    const double after =
        static_cast<double>(compressed[edge.first][i]) - static_cast<double>(compressed[edge.second][i]);
    sum.exact += before * before;
    sum.compressed += after * after;
    sum.added += (after - before) * (after - before);
  }
  return sum;
}

double root_mean(double sum, std::size_t count) {
  return count == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(count));
}

}  // namespace

Seams measure_seams(std::span<const glm::uvec3> triangles, std::span<const std::uint16_t> labels,
                    const Vectors& exact, const Vectors& compressed) {
  Seams seams;
  Jump border;
  double inner = 0.0;
  for (const Edge& edge : edges_of(triangles)) {
    const Jump jump = squared_jump(edge, exact, compressed);
    if (labels[edge.first] == labels[edge.second]) {
      ++seams.inner_edges;
      inner += jump.added;
      continue;
    }
    ++seams.border_edges;
    border.exact += jump.exact;
    border.compressed += jump.compressed;
    border.added += jump.added;
  }
  seams.exact_jump = root_mean(border.exact, seams.border_edges);
  seams.border_jump = root_mean(border.compressed, seams.border_edges);
  seams.border_added = root_mean(border.added, seams.border_edges);
  seams.inner_added = root_mean(inner, seams.inner_edges);
  return seams;
}

}  // namespace plumbline::compress
