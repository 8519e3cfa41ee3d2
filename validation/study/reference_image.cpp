#include "validation/study/reference_image.hpp"

#include <fmt/format.h>

#include <optional>
#include <set>
#include <string_view>

#include "reference/base/error.hpp"
#include "reference/image/exr.hpp"

namespace plumbline::study {
namespace {

constexpr double kDarkest = 0.01;  // of relMSE: keeps black pixels from counting infinitely

void require_same_size(const image::Image& one, const image::Image& other, const std::string& what) {
  if (one.width == other.width && one.height == other.height) return;
  throw InputError(fmt::format("{}: images of one size expected, they are {}x{} and {}x{}", what, one.width,
                               one.height, other.width, other.height));
}

void add(const image::Image& image, image::Image& sum) {
  require_same_size(image, sum, "reference");
  for (std::size_t p = 0; p < sum.pixels.size(); ++p) sum.pixels[p] += image.pixels[p];
}

/// Mean over pixels and channels of term(r, pixel), r from the halves' mean.
template <class Term>
double mean_over_pixels(const Halved& reference, const Term& term) {
  RgbD sum(0.0);
  for (std::size_t p = 0; p < reference.a.pixels.size(); ++p) {
    const RgbD a(reference.a.pixels[p]);
    const RgbD b(reference.b.pixels[p]);
    const RgbD r = 0.5 * (a + b);
    sum += term(a, b, p) / (r * r + kDarkest);
  }
  return (sum.x + sum.y + sum.z) / (3.0 * static_cast<double>(reference.a.pixels.size()));
}

}  // namespace

image::Image mean_of(const Halved& halved) {
  require_same_size(halved.a, halved.b, "halves");
  image::Image mean = halved.a;
  for (std::size_t p = 0; p < mean.pixels.size(); ++p)
    mean.pixels[p] = Rgb(0.5 * (RgbD(halved.a.pixels[p]) + RgbD(halved.b.pixels[p])));
  return mean;
}

Halved make_reference(const std::map<std::string, Halved>& renderers) {
  if (renderers.empty()) throw InputError("reference: no renderer made one");
  const Halved& first = renderers.begin()->second;
  Halved sum{image::make_image(first.a.width, first.a.height),
             image::make_image(first.a.width, first.a.height)};
  for (const auto& [name, halved] : renderers) {
    add(halved.a, sum.a);
    add(halved.b, sum.b);
  }
  const float scale = 1.0F / static_cast<float>(renderers.size());
  for (Rgb& pixel : sum.a.pixels) pixel *= scale;
  for (Rgb& pixel : sum.b.pixels) pixel *= scale;
  return sum;
}

double relmse(const image::Image& test, const Halved& reference) {
  require_same_size(test, reference.a, "relMSE");
  return mean_over_pixels(reference, [&](const RgbD& a, const RgbD& b, std::size_t p) {
    const RgbD v(test.pixels[p]);
    return (v - a) * (v - b);
  });
}

double own_relmse(const Halved& reference) {
  return mean_over_pixels(reference,
                          [](const RgbD& a, const RgbD& b, std::size_t) { return 0.25 * (a - b) * (a - b); });
}

void save_reference(const std::filesystem::path& path, const std::map<std::string, Halved>& renderers,
                    const std::map<std::string, std::string>& attributes) {
  const Halved reference = make_reference(renderers);
  image::LayeredImage file{reference.a.width, reference.a.height, {}, attributes};
  image::set_rgb_layer(file, "", mean_of(reference));
  image::set_rgb_layer(file, "a", reference.a);
  image::set_rgb_layer(file, "b", reference.b);
  for (const auto& [name, halved] : renderers) {
    image::set_rgb_layer(file, name + ".a", halved.a);
    image::set_rgb_layer(file, name + ".b", halved.b);
  }
  image::write_exr(path, file);
}

LoadedReference load_reference(const std::filesystem::path& path) {
  const image::LayeredImage file = image::read_exr(path);
  LoadedReference result;
  result.attributes = file.attributes;
  const std::optional<image::Image> mean = image::rgb_layer(file, "");
  if (!mean) throw InputError(fmt::format("{}: has no channels R, G, B", path.string()));
  const std::optional<image::Image> a = image::rgb_layer(file, "a");
  const std::optional<image::Image> b = image::rgb_layer(file, "b");
  result.has_halves = a && b;
  result.reference = result.has_halves ? Halved{*a, *b} : Halved{*mean, *mean};
  constexpr std::string_view kHalf = ".a.R";
  for (const auto& [channel, values] : file.channels) {
    if (!channel.ends_with(kHalf)) continue;
    const std::string name = channel.substr(0, channel.size() - kHalf.size());
    const std::optional<image::Image> own_a = image::rgb_layer(file, name + ".a");
    const std::optional<image::Image> own_b = image::rgb_layer(file, name + ".b");
    if (own_a && own_b) result.renderers[name] = {*own_a, *own_b};
  }
  return result;
}

}  // namespace plumbline::study
