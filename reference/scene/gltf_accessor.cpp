#include "reference/scene/gltf_accessor.hpp"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "reference/base/error.hpp"
#include "reference/scene/finish.hpp"

namespace plumbline::scene {
namespace {

// An accessor without a buffer view is all zeros: a few bytes of JSON that ask for any amount of memory.
constexpr std::size_t kMostZeros = std::size_t{1} << 24U;

const tinygltf::Accessor& find_accessor(const tinygltf::Model& model, int index, const std::string& where) {
  if (index < 0 || static_cast<std::size_t>(index) >= model.accessors.size()) {
    throw InputError(
        fmt::format("{}: accessor {} does not exist, there are {}", where, index, model.accessors.size()));
  }
  return model.accessors[static_cast<std::size_t>(index)];
}

// Size in bytes of a component; 0 for what glTF does not have.
std::size_t component_size(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

std::size_t component_count(int type) {
  switch (type) {
    case TINYGLTF_TYPE_SCALAR:
      return 1;
    case TINYGLTF_TYPE_VEC2:
      return 2;
    case TINYGLTF_TYPE_VEC3:
      return 3;
    case TINYGLTF_TYPE_VEC4:
      return 4;
    default:
      return 0;  // matrices: no attribute or index is one
  }
}

template <class Number>
Number load(const char* bytes) {
  Number value{};
  std::memcpy(&value, bytes, sizeof(Number));
  return value;
}

template <class Integer>
double load_integer(const char* bytes, bool is_normalized) {
  const auto value = static_cast<double>(load<Integer>(bytes));
  if (!is_normalized) return value;
  return std::max(value / static_cast<double>(std::numeric_limits<Integer>::max()), -1.0);
}

double load_component(const char* bytes, int type, bool is_normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return load_integer<std::int8_t>(bytes, is_normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load_integer<std::uint8_t>(bytes, is_normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return load_integer<std::int16_t>(bytes, is_normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load_integer<std::uint16_t>(bytes, is_normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return load_integer<std::uint32_t>(bytes, is_normalized);
    default:
      return static_cast<double>(load<float>(bytes));
  }
}

// Elements that lie at a fixed stride in a buffer view, all inside.
struct Strided {
  std::string_view bytes;
  std::size_t stride;

  [[nodiscard]] const char* element(std::size_t i) const { return bytes.data() + i * stride; }
};

Strided strided(const tinygltf::Model& model, int view, std::size_t offset, std::size_t count,
                std::size_t element_size, const std::string& where) {
  const std::string_view bytes = view_bytes(model, view, where);
  const std::size_t declared = model.bufferViews[static_cast<std::size_t>(view)].byteStride;
  const std::size_t stride = declared == 0 ? element_size : declared;
  if (stride < element_size) {
    throw InputError(
        fmt::format("{}: byteStride {} is less than an element's {} bytes", where, stride, element_size));
  }
  const bool fits = offset <= bytes.size() && element_size <= bytes.size() - offset &&
                    (count - 1) <= (bytes.size() - offset - element_size) / stride;
  if (!fits) {
    throw InputError(
        fmt::format("{}: {} elements of {} bytes at byte {} exceed their buffer view of {} bytes", where,
                    count, element_size, offset, bytes.size()));
  }
  return {bytes.substr(offset), stride};
}

std::vector<double> read_dense(const tinygltf::Model& model, const tinygltf::Accessor& accessor,
                               std::size_t components, const std::string& where) {
  const std::size_t size = component_size(accessor.componentType);
  std::vector<double> values;
  if (accessor.bufferView < 0) {
    if (accessor.count > kMostZeros) {
      throw InputError(fmt::format("{}: {} elements without a buffer view, at most {} are taken", where,
                                   accessor.count, kMostZeros));
    }
    values.resize(accessor.count * components, 0.0);
    return values;
  }
  const Strided source =
      strided(model, accessor.bufferView, accessor.byteOffset, accessor.count, size * components, where);
  values.reserve(accessor.count * components);
  for (std::size_t i = 0; i < accessor.count; ++i) {
    for (std::size_t c = 0; c < components; ++c) {
      values.push_back(
          load_component(source.element(i) + c * size, accessor.componentType, accessor.normalized));
    }
  }
  return values;
}

void replace_sparse(const tinygltf::Model& model, const tinygltf::Accessor& accessor, std::size_t components,
                    std::vector<double>& values, const std::string& where) {
  const auto& sparse = accessor.sparse;
  if (sparse.count < 1 || static_cast<std::size_t>(sparse.count) > accessor.count) {
    throw InputError(
        fmt::format("{}: {} sparse values for {} elements", where, sparse.count, accessor.count));
  }
  const auto count = static_cast<std::size_t>(sparse.count);
  const int index_type = sparse.indices.componentType;
  if (index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
      index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
      index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
    throw InputError(fmt::format("{}: sparse indices have component type {}", where, index_type));
  }
  if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0) {
    throw InputError(where + ": a sparse byteOffset is negative");
  }
  const std::size_t size = component_size(accessor.componentType);
  const Strided indices =
      strided(model, sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset), count,
              component_size(index_type), where);
  const Strided replacements =
      strided(model, sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset), count,
              size * components, where);
  for (std::size_t i = 0; i < count; ++i) {
    const auto target = static_cast<std::size_t>(load_component(indices.element(i), index_type, false));
    if (target >= accessor.count) {
      throw InputError(
          fmt::format("{}: sparse index {} is out of range, there are {}", where, target, accessor.count));
    }
    for (std::size_t c = 0; c < components; ++c) {
      values[target * components + c] =
          load_component(replacements.element(i) + c * size, accessor.componentType, accessor.normalized);
    }
  }
}

struct Numbers {
  std::size_t components;
  std::vector<double> values;
};

Numbers read_numbers(const tinygltf::Model& model, int index, std::span<const std::size_t> allowed,
                     const std::string& where) {
  const tinygltf::Accessor& accessor = find_accessor(model, index, where);
  const std::size_t components = component_count(accessor.type);
  if (std::find(allowed.begin(), allowed.end(), components) == allowed.end()) {
    throw InputError(fmt::format("{}: accessor {} has elements of {} components", where, index, components));
  }
  if (component_size(accessor.componentType) == 0) {
    throw InputError(
        fmt::format("{}: accessor {} has component type {}", where, index, accessor.componentType));
  }
  if (accessor.count < 1 || accessor.count > kMostElements) {
    throw InputError(fmt::format("{}: accessor {} has {} elements, expected 1 to {}", where, index,
                                 accessor.count, kMostElements));
  }
  const std::string here = fmt::format("{}: accessor {}", where, index);
  std::vector<double> values = read_dense(model, accessor, components, here);
  if (accessor.sparse.isSparse) replace_sparse(model, accessor, components, values, here);
  return {components, std::move(values)};
}

}  // namespace

AccessorValues read_floats(const tinygltf::Model& model, int accessor, std::span<const std::size_t> allowed,
                           const std::string& where) {
  const Numbers numbers = read_numbers(model, accessor, allowed, where);
  const int type = model.accessors[static_cast<std::size_t>(accessor)].componentType;
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
    throw InputError(
        fmt::format("{}: accessor {} has component type {}, no attribute may", where, accessor, type));
  }
  AccessorValues result;
  result.components = numbers.components;
  result.count = numbers.values.size() / numbers.components;
  result.values.reserve(numbers.values.size());
  for (const double value : numbers.values) result.values.push_back(static_cast<float>(value));
  return result;
}

std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int accessor,
                                        const std::string& where) {
  constexpr std::size_t kScalar = 1;
  const tinygltf::Accessor& found = find_accessor(model, accessor, where);
  if (found.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
      found.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
      found.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
    throw InputError(fmt::format("{}: indices have component type {}", where, found.componentType));
  }
  if (found.normalized) throw InputError(where + ": indices are marked as normalized");
  const Numbers numbers = read_numbers(model, accessor, std::span(&kScalar, 1), where);
  std::vector<std::uint32_t> result;
  result.reserve(numbers.values.size());
  for (const double value : numbers.values) result.push_back(static_cast<std::uint32_t>(value));
  return result;
}

std::string_view view_bytes(const tinygltf::Model& model, int buffer_view, const std::string& where) {
  if (buffer_view < 0 || static_cast<std::size_t>(buffer_view) >= model.bufferViews.size()) {
    throw InputError(fmt::format("{}: buffer view {} does not exist, there are {}", where, buffer_view,
                                 model.bufferViews.size()));
  }
  const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(buffer_view)];
  if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model.buffers.size()) {
    throw InputError(fmt::format("{}: buffer view {} lies in buffer {}, there are {}", where, buffer_view,
                                 view.buffer, model.buffers.size()));
  }
  const std::vector<unsigned char>& data = model.buffers[static_cast<std::size_t>(view.buffer)].data;
  if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) {
    throw InputError(fmt::format("{}: buffer view {} ({} bytes at byte {}) exceeds its buffer of {} bytes",
                                 where, buffer_view, view.byteLength, view.byteOffset, data.size()));
  }
  return {reinterpret_cast<const char*>(data.data()) + view.byteOffset, view.byteLength};
}

}  // namespace plumbline::scene
