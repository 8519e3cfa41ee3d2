// reference/base/text.hpp: foreign text in messages.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace plumbline {

/// Foreign text fit for a one-line message: line breaks and control characters become blanks, runs of blanks
/// one blank, and it ends after `longest` bytes.
[[nodiscard]] std::string one_line(std::string_view text, std::size_t longest = 200);

/// `text` with every `from` (not empty) turned into `to`.
[[nodiscard]] std::string replaced(std::string_view text, std::string_view from, std::string_view to);

/// The words between separators, empty ones included: always one more than there are separators. They point
/// into `text`.
[[nodiscard]] std::vector<std::string_view> split(std::string_view text, char separator);

/// The path's extension in lower case, with its dot; empty when there is none.
[[nodiscard]] std::string lower_case_extension(std::string_view path);

}  // namespace plumbline
