// prt/transfer/baked_file.hpp: a scene with its transfer, as one .glb that any glTF viewer opens.
// prt/transfer/FORMAT.md specifies the extension.
#pragma once

#include <filesystem>
#include <optional>

#include "prt/compress/compressed.hpp"
#include "prt/transfer/transfer.hpp"
#include "reference/scene/scene.hpp"

namespace plumbline::transfer {

struct Baked {
  scene::Scene scene;
  Transfer transfer;  // of a compressed file: decoded, without standard errors
  std::optional<compress::Compressed> compressed = {};
};

/// Writes by rename, `compressed` in the place of the coefficients and their standard errors where there is one. @throws InputError when shapes do not agree or the path cannot be written.
void save_baked(const std::filesystem::path& path, const Baked& baked);

/// @throws InputError, one line naming the file: no glb, no transfer in it, another version, sizes that do
/// not agree with the scene or the file.
[[nodiscard]] Baked load_baked(const std::filesystem::path& path);

}  // namespace plumbline::transfer
