// prt/compress/seams.hpp: what one sees of the borders between clusters.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "prt/compress/vectors.hpp"

namespace plumbline::compress {

/// Differences across the edges of triangles (each edge once), as root mean squares of the vectors' lengths. `border` edges join
/// vertices of different clusters, `inner` ones of the same. Neighbours in one cluster err alike, neighbours in two
/// independently of each other: that is the seam.
struct Seams {
  std::size_t border_edges = 0;
  std::size_t inner_edges = 0;
  double exact_jump = 0.0;    // |a - b| of border edges, uncompressed
  double border_jump = 0.0;   // |a' - b'| of border edges, compressed
  double border_added = 0.0;  // |(a' - b') - (a - b)| of border edges
  double inner_added = 0.0;   // the same of inner edges: what compression does away from seams
};

/// @param exact, compressed  one vector a vertex: transfer, or the exit radiance under a light (dimension 3)
[[nodiscard]] Seams measure_seams(std::span<const glm::uvec3> triangles,
                                  std::span<const std::uint16_t> labels, const Vectors& exact,
                                  const Vectors& compressed);

}  // namespace plumbline::compress
