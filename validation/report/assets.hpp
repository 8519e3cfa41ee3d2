// validation/report/assets.hpp: the page's own files, embedded at build time (assets.cmake).
#pragma once

#include <string_view>

namespace plumbline::report::assets {

[[nodiscard]] std::string_view page_html();
[[nodiscard]] std::string_view page_css();
[[nodiscard]] std::string_view page_js();
[[nodiscard]] std::string_view chart_js();          // Chart.js, minified
[[nodiscard]] std::string_view chart_js_licence();  // MIT: travels with every copy

}  // namespace plumbline::report::assets
