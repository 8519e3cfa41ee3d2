// prt/transfer/baked_file.hpp: a scene with its transfer, as one .glb that any glTF viewer opens.
// prt/transfer/FORMAT.md specifies the extension.
#pragma once

#include <filesystem>

#include "prt/transfer/transfer.hpp"
#include "reference/scene/scene.hpp"

namespace plumbline::transfer {

struct Baked {
  scene::Scene scene;
  Transfer transfer;
};

/// Writes by rename. @throws InputError when shapes do not agree or the path cannot be written.
void save_baked(const std::filesystem::path& path, const Baked& baked);

/// @throws InputError, one line naming the file: no glb, no transfer in it, another version, sizes that do
/// not agree with the scene or the file.
[[nodiscard]] Baked load_baked(const std::filesystem::path& path);

}  // namespace plumbline::transfer
