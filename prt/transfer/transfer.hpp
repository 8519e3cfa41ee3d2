// prt/transfer/transfer.hpp: what a baked scene knows about light.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "prt/transfer/method.hpp"
#include "reference/base/vector.hpp"

namespace plumbline::transfer {

/// unshadowed: nothing blocks; shadowed: the scene blocks; interreflected: and reflects.
enum class Kind { unshadowed, shadowed, interreflected };
[[nodiscard]] std::string_view to_string(Kind kind);
/// @throws InputError listing the kinds there are.
[[nodiscard]] Kind kind_from_string(std::string_view text);

/// What light that bounced k times adds to every vector of a Transfer, in the shape of its arrays.
struct Term {
  std::vector<float> coefficients;
  std::vector<float> standard_errors;

  friend bool operator==(const Term&, const Term&) = default;
};

/// One transfer vector a vertex: exit radiance for unit albedo at the vertex, per unit coefficient of the
/// lighting (CONVENTIONS.md#radiometry). Exit radiance = albedo * sum_i T_i l_i.
struct Transfer {
  int bands = 0;
  Kind kind = Kind::unshadowed;
  int bounces = 0;   // of light between surfaces: 0 unless interreflected; kAllBounces: no limit
  int channels = 1;  // 1: the same for r, g, b; 3: one vector each, in this order
  std::size_t vertices = 0;
  std::vector<float> coefficients;     // [vertex][channel][bands^2]
  std::vector<float> standard_errors;  // the same shape, or empty: exact
  std::vector<Term> terms;             // k = 0 … : bounce k apart, as many as were asked for; often none
  std::int64_t samples =
      0;  // directions a vertex; the most that one drew, where an error was asked for; 0: closed form
  std::uint64_t seed = 0;
  Method method;
  double target_error = 0.0;     // that was asked for (bake.hpp); 0: none
  std::size_t above_target = 0;  // vertices that did not reach it
  double mean_samples = 0.0;     // directions a vertex, the mean of all; not kept in files
  double remainder = 0.0;        // no coefficient misses more than this for bounces left out of kAllBounces

  /// The bands^2 coefficients of a vertex; a gray transfer gives the same vector for every channel.
  [[nodiscard]] std::span<const float> vector(std::size_t vertex, int channel) const;
  /// The same of another array of that shape: standard errors, a term.
  [[nodiscard]] std::span<const float> row_of(const std::vector<float>& values, std::size_t vertex,
                                              int channel) const;
};

/// Shape check, terms included. @throws InputError ("<where>: ...") when sizes do not agree or a value is not finite.
void validate(const Transfer& transfer, const std::string& where);

}  // namespace plumbline::transfer
