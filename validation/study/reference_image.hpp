// validation/study/reference_image.hpp: the long render that images of renderers are held against, and the distance from it.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "reference/image/image.hpp"

namespace plumbline::study {

/// A renderer's image and two independent halves of its samples, whose mean it is.
struct Halved {
  image::Image a;
  image::Image b;
};
[[nodiscard]] image::Image mean_of(const Halved& halved);

/// The mean of all renderers' long images; its halves are the means of their halves.
/// @throws InputError for no renderers or different sizes.
[[nodiscard]] Halved make_reference(const std::map<std::string, Halved>& renderers);

/// relMSE without the reference's own noise: the mean over pixels and channels of (v - a)(v - b) / (r^2 + 0.01), where a and b
/// are the reference's halves and r their mean. As (v - a)(v - b) = (v - r)^2 - ((a - b) / 2)^2, and the second term is on average
/// the variance of r, the noise of the reference cancels; a single value may be negative when the reference is no better than
/// the image. NaN where anything is not finite. @throws InputError for different sizes.
[[nodiscard]] double relmse(const image::Image& test, const Halved& reference);
/// The part that relmse takes off: the reference's own relMSE, mean of ((a - b) / 2)^2 / (r^2 + 0.01).
[[nodiscard]] double own_relmse(const Halved& reference);

/// One OpenEXR file: R G B, a.*, b.* of the reference and "<renderer>.a.*", "<renderer>.b.*" of each renderer.
void save_reference(const std::filesystem::path& path, const std::map<std::string, Halved>& renderers,
                    const std::map<std::string, std::string>& attributes);

struct LoadedReference {
  Halved reference;
  std::map<std::string, Halved> renderers;  // empty for a file of another origin
  std::map<std::string, std::string> attributes;
  bool has_halves = false;  // false: taken as exact, both halves equal
};
/// What save_reference wrote, or any OpenEXR image with R, G, B. @throws InputError naming the file.
[[nodiscard]] LoadedReference load_reference(const std::filesystem::path& path);

}  // namespace plumbline::study
