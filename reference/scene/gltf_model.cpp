#include "reference/scene/gltf_model.hpp"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <exception>
#include <limits>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/scene/glb.hpp"
#include "reference/scene/text.hpp"

namespace plumbline::scene {
namespace {

constexpr int kDeepestNesting = 200;

// Extensions without which the geometry, the images or the lights are still right.
constexpr std::array<std::string_view, 3> kSupported = {"KHR_lights_punctual", "KHR_mesh_quantization",
                                                        "KHR_materials_emissive_strength"};
constexpr std::string_view kMaterialPrefix = "KHR_materials_";

// tinygltf passes the bytes of an embedded image without checking that they lie in the buffer: they are
// looked up later instead, from the buffer view.
bool keep_encoded(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
  if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

// tinygltf also searches the working directory; a scene means the files beside it.
bool exists_beside(const std::string& file, void* folder) {
  if (!file.starts_with(*static_cast<const std::string*>(folder))) return false;
  std::error_code error;
  return std::filesystem::is_regular_file(file, error);
}

std::string as_is(const std::string& file, void*) {
  return file;
}

void require_supported(const tinygltf::Model& model, const std::string& where) {
  for (const std::string& extension : model.extensionsRequired) {
    const bool is_supported = extension.starts_with(kMaterialPrefix) ||
                              std::find(kSupported.begin(), kSupported.end(), extension) != kSupported.end();
    if (!is_supported) {
      throw InputError(
          fmt::format("{}: requires the extension {}, which is not supported", where, one_line(extension)));
    }
  }
}

bool parse_bytes(tinygltf::Model& model, const std::string& bytes, std::string folder, std::string& error) {
  if (!folder.ends_with('/')) folder += '/';
  tinygltf::TinyGLTF parser;
  parser.SetImageLoader(&keep_encoded, nullptr);
  parser.SetFsCallbacks({&exists_beside, &as_is, &tinygltf::ReadWholeFile, nullptr, &folder});
  const auto size = static_cast<unsigned int>(bytes.size());
  std::string warning;
  try {
    return is_glb(bytes) ? parser.LoadBinaryFromMemory(&model, &error, &warning,
                                                       reinterpret_cast<const unsigned char*>(bytes.data()),
                                                       size, folder)
                         : parser.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, folder);
  } catch (const std::exception& thrown) {
    error = thrown.what();
    return false;
  }
}

}  // namespace

int nesting_depth(std::string_view json) {
  int depth = 0;
  int deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      deepest = std::max(deepest, ++depth);
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return deepest;
}

void parse_gltf(const std::filesystem::path& path, tinygltf::Model& model) {
  const std::string where = path.string();
  const std::string bytes = read_file(path);
  if (bytes.empty()) throw InputError(where + ": is empty");
  if (bytes.size() > std::numeric_limits<unsigned int>::max()) {
    throw InputError(fmt::format("{}: {} bytes, glTF files above 4 GiB are not read", where, bytes.size()));
  }
  const std::string_view json = is_glb(bytes) ? split_glb(bytes, where).json : std::string_view(bytes);
  if (nesting_depth(json) > kDeepestNesting) {
    throw InputError(fmt::format("{}: JSON is nested deeper than {} levels", where, kDeepestNesting));
  }
  std::string error;
  const std::string folder = std::filesystem::absolute(path).parent_path().string();
  if (!parse_bytes(model, bytes, folder, error)) {
    throw InputError(fmt::format("{}: cannot read as glTF: {}", where,
                                 error.empty() ? "unknown reason" : one_line(error)));
  }
  if (!model.asset.version.starts_with("2.")) {
    throw InputError(
        fmt::format("{}: glTF version is {}, expected 2.x", where, one_line(model.asset.version)));
  }
  require_supported(model, where);
}

}  // namespace plumbline::scene
