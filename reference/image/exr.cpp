#include "reference/image/exr.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfTestFile.h>
#include <fmt/format.h>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/base/text.hpp"

namespace plumbline::image {
namespace {

constexpr std::size_t kMaxPixels = std::size_t{1} << 30U;

// OpenEXR reports a missing, foreign or damaged file by exceptions of several types; all become one line.
template <class Body>
auto naming_the_file(const std::filesystem::path& path, Body&& body) {
  try {
    return body();
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: cannot read as OpenEXR: {}", path.string(), one_line(error.what())));
  }
}

// The slice's base is where pixel (0, 0) of the *data window's* coordinates would lie.
Imf::Slice float_slice(std::vector<float>& values, const Imath::Box2i& window, int width) {
  const auto offset =
      static_cast<std::ptrdiff_t>(window.min.x) + static_cast<std::ptrdiff_t>(window.min.y) * width;
  return {Imf::FLOAT, reinterpret_cast<char*>(values.data() - offset), sizeof(float),
          sizeof(float) * static_cast<std::size_t>(width)};
}

}  // namespace

LayeredImage read_exr(const std::filesystem::path& path) {
  if (read_file(path).empty()) throw InputError(path.string() + ": is empty");
  return naming_the_file(path, [&] {
    if (!Imf::isOpenExrFile(path.c_str())) throw InputError(path.string() + ": is not an OpenEXR file");
    Imf::InputFile file(path.c_str(), 1);
    const Imath::Box2i window = file.header().dataWindow();
    LayeredImage result;
    result.width = window.max.x - window.min.x + 1;
    result.height = window.max.y - window.min.y + 1;
    const auto pixels = static_cast<std::size_t>(result.width) * static_cast<std::size_t>(result.height);
    if (result.width < 1 || result.height < 1 || pixels > kMaxPixels) {
      throw InputError(
          fmt::format("{}: size {}x{} is out of range", path.string(), result.width, result.height));
    }
    Imf::FrameBuffer buffer;
    for (auto it = file.header().channels().begin(); it != file.header().channels().end(); ++it) {
      if (it.channel().xSampling != 1 || it.channel().ySampling != 1) {
        throw InputError(fmt::format("{}: channel {} is subsampled", path.string(), it.name()));
      }
      auto& values = result.channels[it.name()];
      values.resize(pixels);
      buffer.insert(it.name(), float_slice(values, window, result.width));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    for (auto it = file.header().begin(); it != file.header().end(); ++it) {
      if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute())) {
        result.attributes[it.name()] = text->value();
      }
    }
    return result;
  });
}

void write_exr(const std::filesystem::path& path, const LayeredImage& layers) {
  const auto pixels = static_cast<std::size_t>(layers.width) * static_cast<std::size_t>(layers.height);
  Imf::Header header(layers.width, layers.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer buffer;
  for (const auto& [name, values] : layers.channels) {
    if (values.size() != pixels) {
      throw InputError(fmt::format("{}: channel {} has {} values, expected {}", path.string(), name,
                                   values.size(), pixels));
    }
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    // OpenEXR only reads through this pointer.
    auto* base = reinterpret_cast<char*>(const_cast<float*>(values.data()));
    buffer.insert(name, Imf::Slice(Imf::FLOAT, base, sizeof(float),
                                   sizeof(float) * static_cast<std::size_t>(layers.width)));
  }
  for (const auto& [name, text] : layers.attributes) header.insert(name, Imf::StringAttribute(text));
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    try {
      Imf::OutputFile file(temporary.c_str(), header, 1);
      file.setFrameBuffer(buffer);
      file.writePixels(layers.height);
    } catch (const std::exception& error) {
      const std::string reason = replaced(error.what(), temporary.string(), path.string());
      throw InputError(fmt::format("{}: cannot write: {}", path.string(), one_line(reason)));
    }
  });
}

namespace {
std::string channel_name(std::string_view layer, char component) {
  return layer.empty() ? std::string(1, component) : fmt::format("{}.{}", layer, component);
}
}  // namespace

std::optional<Image> rgb_layer(const LayeredImage& layers, std::string_view layer) {
  Image result = make_image(layers.width, layers.height);
  for (int c = 0; c < 3; ++c) {
    const auto channel = layers.channels.find(channel_name(layer, "RGB"[c]));
    if (channel == layers.channels.end()) return std::nullopt;
    for (std::size_t i = 0; i < result.pixels.size(); ++i) result.pixels[i][c] = channel->second[i];
  }
  return result;
}

void set_rgb_layer(LayeredImage& layers, std::string_view layer, const Image& image) {
  for (int c = 0; c < 3; ++c) {
    auto& channel = layers.channels[channel_name(layer, "RGB"[c])];
    channel.resize(image.pixels.size());
    for (std::size_t i = 0; i < image.pixels.size(); ++i) channel[i] = image.pixels[i][c];
  }
}

}  // namespace plumbline::image
