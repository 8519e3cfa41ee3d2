// prt/transfer/transfer.hpp: what a baked scene knows about light.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "reference/base/vector.hpp"

namespace plumbline::transfer {

/// unshadowed: nothing blocks; shadowed: the scene blocks; interreflected: and reflects.
enum class Kind { unshadowed, shadowed, interreflected };
[[nodiscard]] std::string_view to_string(Kind kind);
/// @throws InputError listing the kinds there are.
[[nodiscard]] Kind kind_from_string(std::string_view text);

/// One transfer vector a vertex: exit radiance for unit albedo at the vertex, per unit coefficient of the
/// lighting (CONVENTIONS.md#radiometry). Exit radiance = albedo * sum_i T_i l_i.
struct Transfer {
  int bands = 0;
  Kind kind = Kind::unshadowed;
  int bounces = 0;   // of light between surfaces: 0 unless interreflected
  int channels = 1;  // 1: the same for r, g, b; 3: one vector each, in this order
  std::size_t vertices = 0;
  std::vector<float> coefficients;     // [vertex][channel][bands^2]
  std::vector<float> standard_errors;  // the same shape, or empty: exact
  std::int64_t samples = 0;            // directions a vertex; 0: closed form
  std::uint64_t seed = 0;

  /// The bands^2 coefficients of a vertex; a gray transfer gives the same vector for every channel.
  [[nodiscard]] std::span<const float> vector(std::size_t vertex, int channel) const;
};

/// Shape check. @throws InputError ("<where>: ...") when sizes do not agree or a value is not finite.
void validate(const Transfer& transfer, const std::string& where);

}  // namespace plumbline::transfer
