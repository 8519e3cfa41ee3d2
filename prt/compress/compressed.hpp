// prt/compress/compressed.hpp: transfer vectors as clusters of affine subspaces with quantised weights.
// [1] Sloan, "Precomputed radiance transfer: theory and practice", SIGGRAPH 2005 course ("Practical issues").
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "prt/compress/clustering.hpp"
#include "prt/transfer/transfer.hpp"

namespace plumbline::compress {

/// vq: each vector is its cluster's mean; pca: one cluster; cpca: both.
enum class Method { vq, pca, cpca };
[[nodiscard]] std::string_view to_string(Method method);
/// @throws InputError listing the methods there are.
[[nodiscard]] Method method_from_string(std::string_view text);

/// Vector v is mean[c] + sum_k code_k(v) axis[c][k], c = labels[v]. The axes are those of the clustering times one step of the
/// weight, and what a code of 0 stands for is inside the mean: decoding and rendering need no scale.
struct Compressed {
  Method method = Method::cpca;
  bool is_iterative = false;  // how the clusters were found
  std::size_t vertices = 0;
  std::size_t dimension = 0;  // channels * bands^2
  int clusters = 1;
  std::vector<int> bits;     // of the codes, one number a component: 4, 8, 16 (integers) or 32 (float)
  std::vector<float> means;  // [cluster][dimension]
  std::vector<float> axes;   // [cluster][component][dimension]
  std::vector<std::uint16_t> labels;  // [vertex]
  std::vector<std::uint8_t> codes;    // planes, one a component; see plane_size
  double relative_error =
      0.0;  // root of: sum |x - decoded|^2 over sum |x|^2, all coefficients of all vertices
  double bake_relative_error = 0.0;        // the same of the bake's standard errors; 0: closed form
  double clustering_relative_error = 0.0;  // the part of relative_error that exact weights would leave

  [[nodiscard]] std::size_t components() const { return bits.size(); }
};

/// Bytes of one component's codes: two's complement, little-endian, vertex after vertex; of 4 bits two in a byte, the even vertex
/// in the low half.
[[nodiscard]] std::size_t plane_size(std::size_t vertices, int bits);
/// Bytes of one label: 0, 1 or 2.
[[nodiscard]] std::size_t label_size(int clusters);
/// The code of a vertex, as a number. `plane`: of this component alone.
[[nodiscard]] float code_of(std::span<const std::uint8_t> plane, int bits, std::size_t vertex);
/// One component's plane.
[[nodiscard]] std::span<const std::uint8_t> plane_of(const Compressed& compressed, std::size_t component);

/// Everything that has to be kept, cluster constants included, over the number of vertices.
[[nodiscard]] double bytes_per_vertex(const Compressed& compressed);
[[nodiscard]] double bytes_per_vertex(std::size_t vertices, std::size_t dimension, int clusters,
                                      const std::vector<int>& bits);

/// The vertices' vectors, rounded to float.
[[nodiscard]] std::vector<float> decode(const Compressed& compressed);

/// Shapes and ranges, and that nothing is NaN or infinite. @throws InputError ("<where>: ...")
void validate(const Compressed& compressed, const std::string& where);

/// The transfer's vectors: one a vertex.
[[nodiscard]] Vectors vectors_of(const transfer::Transfer& transfer);
/// Root of sum |x - y|^2 over sum |x|^2. 0 where both are all zeros.
[[nodiscard]] double relative_error(const Vectors& exact, const Vectors& other);
/// Root of the sum of squared standard errors over the sum of squared coefficients: what compression need not beat.
[[nodiscard]] double bake_relative_error(const transfer::Transfer& transfer);

}  // namespace plumbline::compress
