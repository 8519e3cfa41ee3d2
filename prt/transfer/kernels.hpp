// prt/transfer/kernels.hpp: the vector code of the bake, chosen for the machine when the program runs.
#pragma once

#include <cstddef>

namespace plumbline::transfer {

/// Numbers in a row of `count` coefficients, padded with zeros to whole vectors of any machine.
inline constexpr std::size_t kRowLanes = 16;
[[nodiscard]] constexpr std::size_t padded_row(std::size_t count) {
  return (count + kRowLanes - 1) / kRowLanes * kRowLanes;
}

/// Orthonormal axes, the normal last, and the place in the lattice that a set starts at (directions.hpp).
struct LatticeFrame {
  float tangent[3];
  float bitangent[3];
  float normal[3];
  float start_cosine;  // cos and sin of the first point's azimuth
  float start_sine;
  float start_height;  // (i + shift.y)/n of the first point
};
/// Cosine-distributed unit directions of lattice points: azimuths are the table's turned by the start, u.y are the table's
/// steps plus the start's, folded. `count` is a multiple of sh::kBlockDirections.
void lattice_directions(const LatticeFrame& frame, const float* cosine, const float* sine,
                        const float* height, std::size_t count, float* x, float* y, float* z);

/// sums[(c size + i) 16 + u] += sum over blocks of weights[c stride + 16 block + u] times coefficient i of direction u of
/// the block, in the blocked layout of sh/batch.hpp; c < channels.
void add_weighted(const float* values, const float* weights, std::size_t stride, int channels,
                  std::size_t blocks, std::size_t size, float* sums);

/// sums[c row + i] += sum over hits h and corners k < 3 of weights[(3 h + k) channels + c] corners[3 h + k][c row + i]; row is
/// the length of a padded row.
void add_rows(const float* const* corners, const float* weights, std::size_t hits, int channels,
              std::size_t row, float* sums);

}  // namespace plumbline::transfer
