// validation/app/relight_sequence.hpp: the pictures of `plumbline relight`: one, or numbered ones of a light that turns.
#pragma once

#include <string>
#include <vector>

#include "reference/image/image.hpp"
#include "validation/app/common.hpp"

namespace plumbline::app {

/// --frames, --strip, --exposure.
struct SequenceOptions {
  int frames = 0;  // 0: one picture, under its own name
  std::string strip;
  float exposure_stops = 0.0F;  // of PNG
};
void add_sequence_options(CLI::App& verb, SequenceOptions& options);
/// The options that change pictures, as words of a shell command.
[[nodiscard]] std::string command_text(const SequenceOptions& options);

/// How far --rotate-env has turned the light in frame i of N: i/N of the way. The last frame is one step short, so
/// that a whole turn comes round without showing a picture twice. Without --frames: all the way.
[[nodiscard]] Vec3 degrees_of_frame(const LightOptions& light, int frame, int frames);

/// "out.exr", 7 -> "out_0007.exr": four digits, more where there are more frames. Without frames the name itself.
[[nodiscard]] std::string frame_path(const std::string& output, int frame, int frames);

/// Every picture that --output asks for; one without a name where none is.
/// @throws InputError when `output` is neither .exr nor .png, or the strip would be too wide
[[nodiscard]] std::vector<Destination> picture_destinations(const std::string& output,
                                                            const SequenceOptions& options, const Size& size);

/// Writes OpenEXR, or PNG (sRGB at the exposure) by the name's ending; by rename.
void write_picture(const std::string& path, const image::LayeredImage& picture, float exposure_stops);

/// Pictures side by side.
class Strip {
 public:
  Strip(const SequenceOptions& options, const Size& size);
  void add(const image::LayeredImage& picture);
  /// Nothing when none was asked for.
  void write() const;

 private:
  std::string path_;
  float exposure_stops_ = 0.0F;
  int added_ = 0;
  image::Image pixels_;
};

}  // namespace plumbline::app
