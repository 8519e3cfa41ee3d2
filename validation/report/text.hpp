// validation/report/text.hpp: text that is safe to put into HTML, XML and JSON, and numbers as a reader wants
// them.
#pragma once

#include <string>
#include <string_view>

namespace plumbline::report {

/// Valid UTF-8 without control characters other than tab and newline: every byte that breaks this becomes
/// U+FFFD, one for one sequence. XML 1.0 and JSON both accept the result.
[[nodiscard]] std::string clean_text(std::string_view text);

/// Cleaned, with & < > " ' as entities: for HTML and XML, element content and quoted attributes alike.
[[nodiscard]] std::string escape_markup(std::string_view text);
/// The same with newlines and tabs as character references, which XML attributes would else turn into spaces.
[[nodiscard]] std::string escape_attribute(std::string_view text);

[[nodiscard]] std::string base64(std::string_view bytes);

/// Four significant digits; "NaN", "inf", "-inf" for what is no number.
[[nodiscard]] std::string format_number(double value);
/// "0.0031 ± 0.0004": the uncertainty to two digits and the value to the same place; a common power of ten
/// is set off, "(3.1 ± 0.4)e-7". An uncertainty of 0 (deterministic) gives the value alone.
[[nodiscard]] std::string format_interval(double value, double uncertainty);
/// "120 ms", "3.4 s", "2.1 min".
[[nodiscard]] std::string format_seconds(double seconds);

}  // namespace plumbline::report
