// validation/report/html_parts.hpp: the sections of the page, each as finished markup, empty when there is
// nothing to show. All text is escaped here.
#pragma once

#include <string>

#include "validation/report/report.hpp"

namespace plumbline::report::html {

/// "✓ pass" in its colour: symbol, word and colour say the same.
[[nodiscard]] std::string badge(checks::Verdict verdict);
/// A section with a heading and an anchor; empty for an empty body.
[[nodiscard]] std::string section(const std::string& anchor, const std::string& heading,
                                  const std::string& body);
/// Numbers are set flush right, verdict words as badges; short rows are filled up with empty cells.
[[nodiscard]] std::string table(const std::vector<std::string>& columns,
                                const std::vector<std::vector<std::string>>& rows, const std::string& name);

/// @throws InputError when a picture's pixels are not width * height.
[[nodiscard]] std::string galleries(const Report& report);
[[nodiscard]] std::string forests(const Report& report);
[[nodiscard]] std::string charts(const Report& report);
[[nodiscard]] std::string tables(const Report& report);

/// The failed and the undecided, as links into findings().
[[nodiscard]] std::string attention(const Report& report);
[[nodiscard]] std::string findings(const Report& report);
/// The measured value with its interval in units of the bound, drawn over the band -1 ... 1.
[[nodiscard]] std::string interval_bar(const checks::Finding& finding);

}  // namespace plumbline::report::html
