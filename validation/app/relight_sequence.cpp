#include "validation/app/relight_sequence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "reference/base/error.hpp"
#include "reference/base/text.hpp"
#include "reference/image/exr.hpp"
#include "reference/image/file.hpp"
#include "validation/app/options.hpp"

namespace plumbline::app {
namespace {

constexpr int kMostFrames = 100000;
constexpr double kMostStops = 64.0;

bool is_png(const std::string& path) {
  return lower_case_extension(path) == ".png";
}

}  // namespace

void add_sequence_options(CLI::App& verb, SequenceOptions& options) {
  add_whole_number(
      verb, "--frames", options.frames, {1, kMostFrames},
      "write this many pictures OUT_0000, OUT_0001, ...: in frame i of N the light is turned by i/N of "
      "--rotate-env, so that a whole turn repeats no picture");
  verb.add_option("--strip", options.strip, "PNG of all frames side by side")->type_name("FILE");
  add_number(
      verb, "--exposure", [&options](double stops) { options.exposure_stops = static_cast<float>(stops); },
      "a number from -64 to 64", [](double stops) { return std::abs(stops) <= kMostStops; },
      "of PNG pictures, in stops (default 0)");
}

std::string command_text(const SequenceOptions& options) {
  std::string text;
  if (options.frames > 0) text += fmt::format(" --frames {}", options.frames);
  if (options.exposure_stops != 0.0F) text += fmt::format(" --exposure {}", options.exposure_stops);
  return text;
}

Vec3 degrees_of_frame(const LightOptions& light, int frame, int frames) {
  if (light.rotation_deg.empty()) return Vec3(0.0F);
  const double share = frames > 0 ? static_cast<double>(frame) / frames : 1.0;
  Vec3 degrees;
  for (int axis = 0; axis < 3; ++axis) {
    degrees[axis] =
        static_cast<float>(share * static_cast<double>(light.rotation_deg[static_cast<std::size_t>(axis)]));
  }
  return degrees;
}

std::string frame_path(const std::string& output, int frame, int frames) {
  if (frames == 0) return output;
  const std::filesystem::path path(output);
  std::filesystem::path numbered = path.parent_path() / path.stem();
  numbered += fmt::format("_{:0{}}", frame, std::max<std::size_t>(4, std::to_string(frames - 1).size()));
  numbered += path.extension();
  return numbered.string();
}

std::vector<Destination> picture_destinations(const std::string& output, const SequenceOptions& options,
                                              const Size& size) {
  std::vector<Destination> all;
  if (!options.strip.empty()) {
    const auto width = static_cast<std::int64_t>(size.width) * std::max(1, options.frames);
    if (width > kMaxSide) {
      throw InputError(fmt::format("--strip: {} pixels of width are more than {}: fewer or smaller frames",
                                   width, kMaxSide));
    }
  }
  if (output.empty()) return {Destination{"-o", "", ""}};
  if (!is_png(output) && output != "-" && lower_case_extension(output) != ".exr")
    throw InputError(fmt::format("-o: {}: expected a name that ends in .exr or .png", output));
  for (int frame = 0; frame < std::max(1, options.frames); ++frame)
    all.push_back({"-o", output == "-" ? output : frame_path(output, frame, options.frames),
                   is_png(output) ? ".png" : ".exr"});
  return all;
}

void write_picture(const std::string& path, const image::LayeredImage& picture, float exposure_stops) {
  if (is_png(path)) {
    image::write_png(path, image::tone_map(*image::rgb_layer(picture, ""), exposure_stops));
  } else {
    image::write_exr(path, picture);
  }
}

Strip::Strip(const SequenceOptions& options, const Size& size)
    : path_(options.strip), exposure_stops_(options.exposure_stops) {
  if (!path_.empty()) pixels_ = image::make_image(size.width * std::max(1, options.frames), size.height);
}

void Strip::add(const image::LayeredImage& picture) {
  if (path_.empty()) return;
  const image::Image frame = *image::rgb_layer(picture, "");
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) pixels_.at(added_ * frame.width + x, y) = frame.at(x, y);
  }
  ++added_;
}

void Strip::write() const {
  if (!path_.empty()) image::write_png(path_, image::tone_map(pixels_, exposure_stops_));
}

}  // namespace plumbline::app
