#include "prt/relight/gl/storage.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "prt/sh/basis.hpp"
#include "reference/base/error.hpp"

namespace plumbline::relight::gl {
namespace {

constexpr std::size_t kPerTexel = 4;

/// Calls put(place among all padded coefficients, place in its vector with the channel's row before it, value).
template <class Put>
void for_each_coefficient(const transfer::Transfer& transfer, std::size_t texels, const Put& put) {
  const auto count = static_cast<std::size_t>(sh::coefficient_count(transfer.bands));
  const auto channels = static_cast<std::size_t>(transfer.channels);
  const std::size_t row = kPerTexel * texels;
  for (std::size_t vector = 0; vector < transfer.vertices * channels; ++vector) {
    for (std::size_t i = 0; i < count; ++i)
      put(vector * row + i, vector % channels * row + i, transfer.coefficients[vector * count + i]);
  }
}

template <class Stored>
void store(std::vector<std::byte>& bytes, std::size_t place, Stored value) {
  std::memcpy(bytes.data() + place * sizeof(Stored), &value, sizeof(Stored));
}

void find_ranges(const transfer::Transfer& transfer, PackedTransfer& packed) {
  const std::size_t size = static_cast<std::size_t>(transfer.channels) * kPerTexel * packed.texels;
  std::vector<float> low(size, 0.0F);
  std::vector<float> high(size, 0.0F);
  std::vector<bool> seen(size, false);
  for_each_coefficient(transfer, packed.texels, [&](std::size_t, std::size_t i, float value) {
    low[i] = seen[i] ? std::min(low[i], value) : value;
    high[i] = seen[i] ? std::max(high[i], value) : value;
    seen[i] = true;
  });
  packed.offsets = low;
  packed.scales.resize(size);
  std::transform(high.begin(), high.end(), low.begin(), packed.scales.begin(), std::minus<>());
}

template <class Whole>
void store_unorm(const transfer::Transfer& transfer, PackedTransfer& packed) {
  constexpr double kLargest = static_cast<double>(static_cast<Whole>(-1));
  for_each_coefficient(transfer, packed.texels, [&](std::size_t place, std::size_t i, float value) {
    const double scale = static_cast<double>(packed.scales[i]);
    const double part =
        scale > 0.0 ? (static_cast<double>(value) - static_cast<double>(packed.offsets[i])) / scale : 0.0;
    store(packed.bytes, place, static_cast<Whole>(std::lround(std::clamp(part, 0.0, 1.0) * kLargest)));
  });
}

std::size_t bytes_of(Storage storage) {
  return storage == Storage::f32 ? 4 : storage == Storage::unorm8 ? 1 : 2;
}

GLenum format_of(Storage storage) {
  switch (storage) {
    case Storage::f32:
      return GL_RGBA32F;
    case Storage::f16:
      return GL_RGBA16F;
    case Storage::unorm16:
      return GL_RGBA16;
    case Storage::unorm8:
      return GL_RGBA8;
  }
  return GL_RGBA32F;
}

}  // namespace

std::string_view to_string(Storage storage) {
  switch (storage) {
    case Storage::f32:
      return "f32";
    case Storage::f16:
      return "f16";
    case Storage::unorm16:
      return "unorm16";
    case Storage::unorm8:
      return "unorm8";
  }
  return "?";
}

Storage storage_from_string(std::string_view text) {
  for (const Storage storage : kStorages) {
    if (text == to_string(storage)) return storage;
  }
  throw InputError(fmt::format("OpenGL storage: expected f32, f16, unorm16 or unorm8, got {}", text));
}

PackedTransfer pack(const transfer::Transfer& transfer, Storage storage) {
  PackedTransfer packed;
  packed.format = format_of(storage);
  packed.texels =
      (static_cast<std::size_t>(sh::coefficient_count(transfer.bands)) + kPerTexel - 1) / kPerTexel;
  packed.bytes.resize(transfer.vertices * static_cast<std::size_t>(transfer.channels) * packed.texels *
                      kPerTexel * bytes_of(storage));
  switch (storage) {
    case Storage::f32:
      for_each_coefficient(transfer, packed.texels, [&](std::size_t place, std::size_t, float value) {
        store(packed.bytes, place, value);
      });
      break;
    case Storage::f16:
      for_each_coefficient(transfer, packed.texels, [&](std::size_t place, std::size_t, float value) {
        const Eigen::half half(value);
        if (!(Eigen::numext::isfinite)(half))
          throw InputError(fmt::format("transfer: coefficient {} is beyond half precision's 65504", value));
        store(packed.bytes, place, half.x);
      });
      break;
    case Storage::unorm16:
      find_ranges(transfer, packed);
      store_unorm<std::uint16_t>(transfer, packed);
      break;
    case Storage::unorm8:
      find_ranges(transfer, packed);
      store_unorm<std::uint8_t>(transfer, packed);
      break;
  }
  return packed;
}

}  // namespace plumbline::relight::gl
