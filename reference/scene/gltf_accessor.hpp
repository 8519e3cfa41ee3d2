// reference/scene/gltf_accessor.hpp: arrays out of a parsed glTF file, with every range checked.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tinygltf {
class Model;
}

namespace plumbline::scene {

/// `count` elements of `components` numbers each.
struct AccessorValues {
  std::size_t count = 0;
  std::size_t components = 0;
  std::vector<float> values;  // count * components
};

/// Floats of an accessor: float or 8- and 16-bit integer components (scaled to [0, 1] or [-1, 1] when
/// "normalized"), sparse or not, interleaved or not.
/// @param allowed  the numbers of components that are right here
/// @throws InputError when the accessor, a buffer view or a buffer is missing, too small or of another type
[[nodiscard]] AccessorValues read_floats(const tinygltf::Model& model, int accessor,
                                         std::span<const std::size_t> allowed, const std::string& where);

/// Unsigned integers of a scalar accessor. @throws InputError as above.
[[nodiscard]] std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int accessor,
                                                      const std::string& where);

/// The bytes of a buffer view. @throws InputError when they do not lie in their buffer.
[[nodiscard]] std::string_view view_bytes(const tinygltf::Model& model, int buffer_view,
                                          const std::string& where);

}  // namespace plumbline::scene
