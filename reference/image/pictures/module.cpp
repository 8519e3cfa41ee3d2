// The module `plumbline_pictures`: all that needs OpenImageIO (picture_library.hpp says why it is apart).
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <stdexcept>

#include "reference/image/picture_library.hpp"

namespace plumbline::image {
namespace {

[[noreturn]] void fail(const std::string& reason) {
  throw std::runtime_error(reason.empty() ? "unknown reason" : reason);
}

// Integer files hold sRGB unless they say they are linear; float and half files hold linear values.
bool is_srgb_encoded(const OIIO::ImageSpec& spec) {
  const std::string space = spec.get_string_attribute("oiio:ColorSpace");
  if (spec.format.is_floating_point()) return false;
  return space != "Linear" && space != "linear" && space != "scene_linear";
}

// OpenImageIO without unassociating alpha: a texel's colour is what the file stores.
OIIO::ImageSpec open_options() {
  OIIO::ImageSpec options;
  options.attribute("oiio:UnassociatedAlpha", 1);
  return options;
}

RawPicture read_all(OIIO::ImageInput& input, std::size_t bytes) {
  const OIIO::ImageSpec spec = input.spec();
  if (spec.width < 1 || spec.height < 1 || spec.width > kMaxPictureSide || spec.height > kMaxPictureSide ||
      spec.nchannels < 1 ||
      !is_plausible(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height), bytes)) {
    fail("size " + std::to_string(spec.width) + "x" + std::to_string(spec.height) + " with " +
         std::to_string(spec.nchannels) + " channels is out of range");
  }
  RawPicture result{spec.width, spec.height, spec.nchannels, is_srgb_encoded(spec), {}};
  result.values.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                       static_cast<std::size_t>(spec.nchannels));
  if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, result.values.data())) {
    fail(input.geterror());
  }
  return result;
}

RawPicture decode(std::string_view bytes, const std::string& name) {
  OIIO::Filesystem::IOMemReader proxy(const_cast<char*>(bytes.data()), bytes.size());  // only read
  OIIO::ImageSpec options = open_options();
  // OpenImageIO 2.4 passes the proxy on only when there are no options, so it goes in among them too:
  // otherwise a file that has this name is read instead.
  OIIO::Filesystem::IOProxy* source = &proxy;
  options.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &source);
  auto input = OIIO::ImageInput::open(name, &options, &proxy);
  if (!input) fail(OIIO::geterror());
  return read_all(*input, bytes.size());
}

std::string encode_png(const Image8& image) {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput proxy(bytes);
  auto output = OIIO::ImageOutput::create("png");
  if (!output) fail("this OpenImageIO cannot write PNG");
  OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  output->set_ioproxy(&proxy);
  if (!output->open("preview.png", spec) || !output->write_image(OIIO::TypeDesc::UINT8, image.rgb.data()) ||
      !output->close()) {
    fail(output->geterror());
  }
  return {bytes.begin(), bytes.end()};
}

constexpr PictureLibrary kLibrary{decode, encode_png};

}  // namespace
}  // namespace plumbline::image

extern "C" __attribute__((visibility("default"))) const plumbline::image::PictureLibrary*
plumbline_pictures_1() {
  return &plumbline::image::kLibrary;
}
