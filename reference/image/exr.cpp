#include "reference/image/exr.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfTestFile.h>
#include <ImfVersion.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/base/text.hpp"
#include "reference/image/picture_library.hpp"

namespace plumbline::image {
namespace {

constexpr std::size_t kMaxPixels = std::size_t{1} << 30U;
constexpr int kMaxSide = std::numeric_limits<int>::max();

// OpenEXR reports a missing, foreign or damaged file by exceptions of several types; all become one line.
template <class Body>
auto naming_the_file(const std::string& name, Body&& body) {
  try {
    return body();
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: cannot read as OpenEXR: {}", name, one_line(error.what())));
  }
}

// A file that is in memory already.
class MemoryStream : public Imf::IStream {
 public:
  MemoryStream(std::string_view bytes, const std::string& name) : IStream(name.c_str()), bytes_(bytes) {}

  bool read(char target[], int count) override {
    const auto wanted = static_cast<std::size_t>(count);
    if (count < 0 || at_ > bytes_.size() || wanted > bytes_.size() - at_) throw InputError(ends_early());
    std::copy_n(bytes_.data() + at_, wanted, target);
    at_ += wanted;
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t position) override { at_ = position; }

 private:
  [[nodiscard]] std::string ends_early() const {
    return fmt::format("{}: cannot read as OpenEXR: it ends early", fileName());
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
};

// The slice's base is where pixel (0, 0) of the *data window's* coordinates would lie.
Imf::Slice float_slice(float* values, const Imath::Box2i& window, std::size_t stride) {
  const auto width = static_cast<std::ptrdiff_t>(window.max.x) - window.min.x + 1;
  const auto offset =
      static_cast<std::ptrdiff_t>(window.min.x) + static_cast<std::ptrdiff_t>(window.min.y) * width;
  const auto step = static_cast<std::ptrdiff_t>(stride);
  return {Imf::FLOAT, reinterpret_cast<char*>(values - offset * step), sizeof(float) * stride,
          sizeof(float) * stride * static_cast<std::size_t>(width)};
}

struct Size {
  int width = 0;
  int height = 0;
  [[nodiscard]] std::size_t pixels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

Size size_of(const Imath::Box2i& window, int largest_side, std::size_t bytes, const std::string& name) {
  const auto width = static_cast<std::int64_t>(window.max.x) - window.min.x + 1;
  const auto height = static_cast<std::int64_t>(window.max.y) - window.min.y + 1;
  if (width < 1 || height < 1 || width > largest_side || height > largest_side ||
      static_cast<std::size_t>(width * height) > kMaxPixels ||
      !is_plausible(static_cast<std::size_t>(width * height), bytes)) {
    throw InputError(fmt::format("{}: size {}x{} is out of range for {} bytes", name, width, height, bytes));
  }
  return {static_cast<int>(width), static_cast<int>(height)};
}

void require_sampled(const Imf::Channel& channel, const std::string& channel_name, const std::string& name) {
  if (channel.xSampling != 1 || channel.ySampling != 1) {
    throw InputError(fmt::format("{}: channel {} is subsampled", name, channel_name));
  }
}

}  // namespace

LayeredImage read_exr(const std::filesystem::path& path) {
  const std::string name = path.string();
  const std::string bytes = read_file(path);
  if (bytes.empty()) throw InputError(name + ": is empty");
  return naming_the_file(name, [&] {
    MemoryStream stream(bytes, name);
    if (!Imf::isOpenExrFile(stream)) throw InputError(name + ": is not an OpenEXR file");
    Imf::InputFile file(stream, 1);
    const Imath::Box2i window = file.header().dataWindow();
    const Size size = size_of(window, kMaxSide, bytes.size(), name);
    LayeredImage result{size.width, size.height, {}, {}};
    Imf::FrameBuffer buffer;
    for (auto it = file.header().channels().begin(); it != file.header().channels().end(); ++it) {
      require_sampled(it.channel(), it.name(), name);
      auto& values = result.channels[it.name()];
      values.resize(size.pixels());
      buffer.insert(it.name(), float_slice(values.data(), window, 1));
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

namespace {

bool is_plain_colour(const Imf::Channel* channel) {
  return channel != nullptr && channel->type != Imf::UINT && channel->xSampling == 1 &&
         channel->ySampling == 1;
}

bool has_plain_colours(const Imf::ChannelList& channels) {
  return is_plain_colour(channels.findChannel("R")) && is_plain_colour(channels.findChannel("G")) &&
         is_plain_colour(channels.findChannel("B"));
}

// Bytes 0 to 3 are the magic number, 4 to 7 the version and flags, little-endian; a shorter file is no image.
bool is_single_part_exr(std::string_view bytes) {
  constexpr std::string_view kMagic("\x76\x2f\x31\x01", 4);
  if (bytes.size() < 8 || !bytes.starts_with(kMagic)) return false;
  int version = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    version |= static_cast<int>(static_cast<unsigned char>(bytes[4 + i])) << (8 * i);
  }
  return Imf::getVersion(version) == Imf::EXR_VERSION && !Imf::isMultiPart(version) &&
         !Imf::isNonImage(version);
}

}  // namespace

std::optional<Image> read_plain_exr(std::string_view bytes, const std::string& name) {
  if (!is_single_part_exr(bytes)) return std::nullopt;
  return naming_the_file(name, [&]() -> std::optional<Image> {
    MemoryStream stream(bytes, name);
    Imf::InputFile file(stream, 1);
    if (!has_plain_colours(file.header().channels())) return std::nullopt;
    const Imath::Box2i window = file.header().dataWindow();
    const Size size = size_of(window, kMaxPictureSide, bytes.size(), name);
    Image result = make_image(size.width, size.height);
    Imf::FrameBuffer buffer;
    for (int c = 0; c < 3; ++c) {
      buffer.insert(std::string(1, "RGB"[c]), float_slice(&result.pixels.front()[c], window, 3));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
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
