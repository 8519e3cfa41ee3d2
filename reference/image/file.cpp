#include "reference/image/file.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/base/text.hpp"

namespace plumbline::image {
namespace {

constexpr int kMaxSide = 1 << 16;

// OpenImageIO's reasons may have several lines.
std::string reason_of(const std::string& text) {
  return text.empty() ? "unknown reason" : one_line(text);
}

// Integer files hold sRGB unless they say they are linear; float and half files hold linear values.
bool is_srgb_encoded(const OIIO::ImageSpec& spec) {
  const std::string space = spec.get_string_attribute("oiio:ColorSpace");
  if (spec.format.is_floating_point()) return false;
  return space != "Linear" && space != "linear" && space != "scene_linear";
}

enum class Content { colour, data };

Image decode(OIIO::ImageInput& input, const std::string& name, Content content) {
  const OIIO::ImageSpec spec = input.spec();
  if (spec.width < 1 || spec.height < 1 || spec.width > kMaxSide || spec.height > kMaxSide ||
      spec.nchannels < 1) {
    throw InputError(fmt::format("{}: size {}x{} with {} channels is out of range", name, spec.width,
                                 spec.height, spec.nchannels));
  }
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  const auto pixels = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
  std::vector<float> values(pixels * channels);
  if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data())) {
    throw InputError(fmt::format("{}: cannot read the image: {}", name, reason_of(input.geterror())));
  }
  const bool is_srgb = content == Content::colour && is_srgb_encoded(spec);
  const bool is_gray = channels < 3;
  Image result = make_image(spec.width, spec.height);
  for (std::size_t i = 0; i < pixels; ++i) {
    for (int c = 0; c < 3; ++c) {
      const float value = values[i * channels + (is_gray ? 0U : static_cast<std::size_t>(c))];
      result.pixels[i][c] = is_srgb ? linear_from_srgb(value) : value;
    }
  }
  return result;
}

// OpenImageIO without unassociating alpha: a texel's colour is what the file stores.
OIIO::ImageSpec open_options() {
  OIIO::ImageSpec options;
  options.attribute("oiio:UnassociatedAlpha", 1);
  return options;
}

void encode(const Image8& image, const std::string& name, OIIO::Filesystem::IOProxy& proxy) {
  auto output = OIIO::ImageOutput::create("png");
  if (!output) throw InputError(name + ": this OpenImageIO cannot write PNG");
  OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  output->set_ioproxy(&proxy);
  if (!output->open(name, spec) || !output->write_image(OIIO::TypeDesc::UINT8, image.rgb.data()) ||
      !output->close()) {
    throw InputError(fmt::format("{}: cannot write: {}", name, reason_of(output->geterror())));
  }
}

Image read_from_memory(std::string_view bytes, const std::string& name, Content content) {
  if (bytes.empty()) throw InputError(name + ": is empty");
  OIIO::Filesystem::IOMemReader proxy(const_cast<char*>(bytes.data()), bytes.size());  // only read
  OIIO::ImageSpec options = open_options();
  // OpenImageIO 2.4 passes the proxy on only when there are no options, so it goes in among them too:
  // otherwise a file that has this name is read instead.
  OIIO::Filesystem::IOProxy* source = &proxy;
  options.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &source);
  auto input = OIIO::ImageInput::open(name, &options, &proxy);
  if (!input)
    throw InputError(fmt::format("{}: cannot read as an image: {}", name, reason_of(OIIO::geterror())));
  return decode(*input, name, content);
}

}  // namespace

Image read_image(const std::filesystem::path& path) {
  return read_image(read_file(path), path.string());
}

Image read_image(std::string_view bytes, const std::string& name) {
  return read_from_memory(bytes, name, Content::colour);
}

Image read_data_image(std::string_view bytes, const std::string& name) {
  return read_from_memory(bytes, name, Content::data);
}

float linear_from_srgb(float srgb) {
  return srgb <= 0.04045F ? srgb / 12.92F : std::pow((srgb + 0.055F) / 1.055F, 2.4F);
}

float srgb_from_linear(float linear) {
  return linear <= 0.0031308F ? linear * 12.92F : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

Image8 tone_map(const Image& image, float exposure_stops) {
  const float scale = std::exp2(exposure_stops);
  Image8 result{image.width, image.height, {}};
  result.rgb.reserve(image.pixels.size() * 3);
  for (const Rgb& pixel : image.pixels) {
    const Rgb shown = is_finite(pixel) ? pixel * scale : Rgb(1.0F, 0.0F, 1.0F);
    for (int c = 0; c < 3; ++c) {
      const float encoded = srgb_from_linear(std::clamp(shown[c], 0.0F, 1.0F));
      result.rgb.push_back(static_cast<std::uint8_t>(std::lround(encoded * 255.0F)));
    }
  }
  return result;
}

Image8 quantise_data(const Image& image) {
  Image8 result{image.width, image.height, {}};
  result.rgb.reserve(image.pixels.size() * 3);
  for (const Rgb& pixel : image.pixels) {
    for (int c = 0; c < 3; ++c) {
      result.rgb.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(pixel[c], 0.0F, 1.0F) * 255.0F)));
    }
  }
  return result;
}

void write_png(const std::filesystem::path& path, const Image8& image) {
  write_text_atomically(path, encode_png(image));
}

std::string encode_png(const Image8& image) {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput proxy(bytes);
  encode(image, "preview.png", proxy);
  return {bytes.begin(), bytes.end()};
}

}  // namespace plumbline::image
