#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>

#include "reference/base/error.hpp"
#include "reference/image/file.hpp"
#include "validation/report/html_parts.hpp"
#include "validation/report/pixels.hpp"
#include "validation/report/text.hpp"

namespace plumbline::report::html {
namespace {

constexpr int kLongestPreview = 384;  // of the picture shown until the page's script takes over
constexpr int kLongestBlocky = 128;   // up to this size single pixels are shown as squares

std::string data_uri(const image::Image8& image) {
  return "data:image/png;base64," + base64(image::encode_png(image));
}

void require_pixels(const std::string& where, int width, int height, std::size_t held,
                    std::size_t per_pixel) {
  const bool is_possible = width >= 0 && height >= 0;
  const std::size_t needed =
      is_possible ? static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * per_pixel : 0;
  if (is_possible && held == needed) return;
  throw InputError(fmt::format("report: picture '{}': {} x {} pixels need {} values, has {}",
                               clean_text(where), width, height, needed, held));
}

std::string blocky(int width, int height) {
  return std::max(width, height) <= kLongestBlocky ? " blocky" : "";
}

std::string missing(const std::string& label) {
  return fmt::format(
      "<figure class=\"picture-box\"><p class=\"note\">No picture.</p><figcaption>{}</figcaption></figure>\n",
      escape_markup(label));
}

std::string figure(const Gallery::Entry& entry, const std::string& title, float exposure_stops) {
  const image::Image& image = entry.image;
  require_pixels(entry.label, image.width, image.height, image.pixels.size(), 1);
  if (image.pixels.empty()) return missing(entry.label);
  return fmt::format(
      "<figure class=\"picture-box\" data-label=\"{0}\" data-radiance=\"{1}\">"
      "<div class=\"picture{2}\"><img src=\"{3}\" width=\"{4}\" height=\"{5}\" alt=\"{6}: {0}\"></div>"
      "<figcaption>{0}</figcaption></figure>\n",
      escape_attribute(entry.label), base64(image::encode_png(pack_radiance(image))),
      blocky(image.width, image.height),
      data_uri(image::tone_map(shrink(image, kLongestPreview), exposure_stops)), image.width, image.height,
      escape_attribute(title));
}

std::string scale_bar(const Gallery::ErrorMap& error) {
  const std::string end =
      format_number(error.scale) + (error.unit.empty() ? "" : " " + escape_attribute(error.unit));
  const image::Image8& ramp = error.ramp;
  if (ramp.rgb.empty()) return fmt::format("<div class=\"scale\">brightest colour: {}</div>", end);
  require_pixels(error.label + ": ramp", ramp.width, ramp.height, ramp.rgb.size(), 3);
  return fmt::format(
      "<div class=\"scale\"><span>0</span><img src=\"{}\" alt=\"colours from 0 (left) to {} "
      "(right)\"><span>{}</span></div>",
      data_uri(ramp), end, end);
}

std::string figure(const Gallery::ErrorMap& error, const std::string& title) {
  const image::Image8& image = error.image;
  require_pixels(error.label, image.width, image.height, image.rgb.size(), 3);
  if (image.rgb.empty()) return missing(error.label);
  return fmt::format(
      "<figure class=\"picture-box\" data-label=\"{0}\">"
      "<div class=\"picture{1}\"><img src=\"{2}\" width=\"{3}\" height=\"{4}\" alt=\"{5}: {0}\"></div>"
      "<figcaption>{0}{6}</figcaption></figure>\n",
      escape_attribute(error.label), blocky(image.width, image.height), data_uri(image), image.width,
      image.height, escape_attribute(title), scale_bar(error));
}

// What only works with the script is hidden until the script shows it.
constexpr const char* kExposure = R"(<div class="controls exposure" hidden>
<label for="exposure-{0}">Exposure</label>
<input type="range" id="exposure-{0}" min="-10" max="10" step="0.25" value="{1}">
<output for="exposure-{0}">{1} stops</output>
<button type="button" data-auto>Auto</button>
<button type="button" data-reset>Reset</button>
</div>
)";
constexpr const char* kCompare = R"(<div class="compare" hidden>
<div class="controls">
<label>Left <select data-side="left"></select></label>
<label>Right <select data-side="right"></select></label>
</div>
<div class="stage"><canvas data-side="right"></canvas><canvas data-side="left"></canvas><div class="divider"></div></div>
<input type="range" class="split" min="0" max="100" step="0.5" value="50" aria-label="Divider between left and right picture">
</div>
<div class="readout" hidden><span class="where">Point at a picture to read linear radiance</span><span class="values"></span></div>
)";

std::string gallery(const Gallery& gallery, std::size_t index) {
  std::string figures;
  for (const Gallery::Entry& entry : gallery.entries)
    figures += figure(entry, gallery.title, gallery.exposure_stops);
  for (const Gallery::ErrorMap& error : gallery.errors) figures += figure(error, gallery.title);
  if (figures.empty()) figures = "<p class=\"note\">No pictures.</p>\n";
  const std::string caption =
      gallery.caption.empty() ? "" : "<p class=\"caption\">" + escape_markup(gallery.caption) + "</p>\n";
  return fmt::format("<div class=\"gallery\">\n<h3>{}</h3>\n{}", escape_markup(gallery.title), caption) +
         fmt::format(fmt::runtime(kExposure), index, gallery.exposure_stops) + "<div class=\"pictures\">\n" +
         figures + "</div>\n" + kCompare + "</div>\n";
}

}  // namespace

std::string galleries(const Report& report) {
  std::string body;
  for (std::size_t i = 0; i < report.galleries.size(); ++i) body += gallery(report.galleries[i], i);
  return section("galleries", "Images", body);
}

}  // namespace plumbline::report::html
