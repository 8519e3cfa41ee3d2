// One fuzz target a file format (libFuzzer, Clang): whatever the bytes, a loader gives a value or throws InputError. Anything
// else - a crash, a leak, undefined behaviour, another exception, minutes, gigabytes - is a finding.
// PLUMBLINE_FUZZ_FORMAT is the file name's extension.
#include <unistd.h>

#include <cstdint>
#include <fstream>
#include <string>

#include "prt/sh/lighting.hpp"
#include "prt/transfer/baked_file.hpp"
#include "reference/base/error.hpp"
#include "reference/image/exr.hpp"
#include "reference/image/file.hpp"
#include "reference/scene/load.hpp"

namespace plumbline {
namespace {

constexpr std::string_view kFormat = PLUMBLINE_FUZZ_FORMAT;

// Loaders take names: glTF and OBJ files name others beside them.
const std::string& file() {
  static const std::string name =
      "/dev/shm/plumbline-fuzz-" + std::to_string(::getpid()) + "." + std::string(kFormat);
  return name;
}

void load(std::string_view bytes) {
  if (kFormat == "hdr" || kFormat == "png") {
    (void)image::read_image(bytes, file());
    return;
  }
  std::ofstream(file(), std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (kFormat == "exr") {
    (void)image::read_plain_exr(bytes, file());
    (void)image::read_exr(file());
  } else if (kFormat == "json") {
    (void)sh::read_coefficients(file());
  } else if (kFormat == "prt.glb") {
    (void)transfer::load_baked(file());
  } else {
    (void)scene::load_scene(file());
  }
}

}  // namespace
}  // namespace plumbline

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    plumbline::load({reinterpret_cast<const char*>(data), size});
  } catch (const plumbline::InputError&) {
    return 0;
  }
  return 0;
}
