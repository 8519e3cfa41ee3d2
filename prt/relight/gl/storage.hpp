// prt/relight/gl/storage.hpp: transfer as texture buffers hold it.
#pragma once

#include <GL/glcorearb.h>

#include <cstddef>
#include <string_view>
#include <vector>

#include "prt/transfer/transfer.hpp"

namespace plumbline::relight::gl {

/// How a coefficient is stored. f16: half precision, rounded to nearest. unorm16, unorm8: a whole number u of 16 or 8 bits that
/// stands for offset + scale u / (2^bits - 1); each coefficient of each channel has its own offset and scale, from its least
/// to its largest value over all vertices.
enum class Storage { f32, f16, unorm16, unorm8 };
[[nodiscard]] std::string_view to_string(Storage storage);
/// @throws InputError listing the storages there are.
[[nodiscard]] Storage storage_from_string(std::string_view text);
inline constexpr Storage kStorages[] = {Storage::f32, Storage::f16, Storage::unorm16, Storage::unorm8};

/// A transfer vector fills `texels` texels of four coefficients each, the last padded with 0; vectors follow each other as
/// in Transfer::coefficients.
struct PackedTransfer {
  GLenum format = GL_RGBA32F;
  std::size_t texels = 0;
  std::vector<std::byte> bytes;
  std::vector<float> offsets;  // [channel][4 texels]; empty unless unorm
  std::vector<float> scales;
};
/// @throws InputError when a coefficient overflows half precision: its largest number is 65504.
[[nodiscard]] PackedTransfer pack(const transfer::Transfer& transfer, Storage storage);

}  // namespace plumbline::relight::gl
