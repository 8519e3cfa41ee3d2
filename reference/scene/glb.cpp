#include "reference/scene/glb.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <limits>

#include "reference/base/error.hpp"

namespace plumbline::scene {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67;        // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E4942;  // "BIN"
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;

std::uint32_t read_u32(std::string_view bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[offset + i])) << (8 * i);
  }
  return value;
}

void append_u32(std::string& bytes, std::size_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes.push_back(static_cast<char>((value >> (8 * i)) & 0xFFU));
}

struct Chunk {
  std::uint32_t type;
  std::string_view data;
};

// The chunk at `offset` of a file whose declared length has been checked.
Chunk read_chunk(std::string_view bytes, std::size_t offset, const std::string& where) {
  if (bytes.size() - offset < kChunkHeaderBytes) {
    throw InputError(
        fmt::format("{}: is truncated: a chunk header at byte {} of {}", where, offset, bytes.size()));
  }
  const std::size_t length = read_u32(bytes, offset);
  const std::size_t available = bytes.size() - offset - kChunkHeaderBytes;
  if (length > available) {
    throw InputError(
        fmt::format("{}: is truncated: a chunk of {} bytes, {} are left", where, length, available));
  }
  return {read_u32(bytes, offset + 4), bytes.substr(offset + kChunkHeaderBytes, length)};
}

void pad(std::string& bytes, char filler) {
  while (bytes.size() % 4 != 0) bytes.push_back(filler);
}

}  // namespace

bool is_glb(std::string_view bytes) {
  return bytes.size() >= 4 && read_u32(bytes, 0) == kMagic;
}

GlbChunks split_glb(std::string_view bytes, const std::string& where) {
  if (!is_glb(bytes)) throw InputError(where + ": is not binary glTF");
  if (bytes.size() < kHeaderBytes) throw InputError(where + ": is truncated: shorter than the glTF header");
  const std::uint32_t version = read_u32(bytes, 4);
  if (version != 2)
    throw InputError(fmt::format("{}: binary glTF version is {}, expected 2", where, version));
  const std::size_t length = read_u32(bytes, 8);
  if (length > bytes.size() || length < kHeaderBytes) {
    throw InputError(
        fmt::format("{}: is truncated: {} bytes, its header says {}", where, bytes.size(), length));
  }
  const std::string_view file = bytes.substr(0, length);
  const Chunk json = read_chunk(file, kHeaderBytes, where);
  if (json.type != kJsonChunk) throw InputError(where + ": the first chunk is not JSON");
  GlbChunks chunks{json.data, {}};
  const std::size_t after_json = kHeaderBytes + kChunkHeaderBytes + json.data.size();
  if (after_json < file.size()) {
    const Chunk binary = read_chunk(file, after_json, where);
    if (binary.type == kBinaryChunk) chunks.binary = binary.data;
  }
  return chunks;
}

std::string join_glb(std::string json, std::string binary) {
  pad(json, ' ');
  pad(binary, '\0');
  const std::size_t binary_bytes = binary.empty() ? 0 : kChunkHeaderBytes + binary.size();
  const std::size_t length = kHeaderBytes + kChunkHeaderBytes + json.size() + binary_bytes;
  if (length > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError(fmt::format("binary glTF holds at most 4 GiB, this scene needs {} bytes", length));
  }
  std::string file;
  file.reserve(length);
  append_u32(file, kMagic);
  append_u32(file, 2);
  append_u32(file, length);
  append_u32(file, json.size());
  append_u32(file, kJsonChunk);
  file += json;
  if (!binary.empty()) {
    append_u32(file, binary.size());
    append_u32(file, kBinaryChunk);
    file += binary;
  }
  return file;
}

}  // namespace plumbline::scene
