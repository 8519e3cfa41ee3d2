// reference/scene/text.hpp: pieces of text files. Numbers are read strictly: "1x" is no number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "reference/base/text.hpp"

namespace plumbline::scene {

/// Words between blanks (space, tab, carriage return).
[[nodiscard]] std::vector<std::string_view> split_words(std::string_view line);

/// Splits off the next line of `rest`; none at the end. The line has no line break.
[[nodiscard]] std::optional<std::string_view> next_line(std::string_view& rest);

/// The whole word as a number ("nan" and "inf" included); none when it is anything else.
[[nodiscard]] std::optional<double> parse_number(std::string_view word);
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view word);

using plumbline::one_line;

}  // namespace plumbline::scene
