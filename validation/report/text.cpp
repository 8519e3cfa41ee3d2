#include "validation/report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace plumbline::report {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

std::uint8_t byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<std::uint8_t>(text[i]) : std::uint8_t{0};
}

// Bytes announced by a UTF-8 lead byte; 0 for a byte that cannot lead.
std::size_t announced_length(std::uint8_t lead) {
  if (lead < 0x80) return 1;
  if (lead >= 0xC2 && lead <= 0xDF) return 2;
  if (lead >= 0xE0 && lead <= 0xEF) return 3;
  if (lead >= 0xF0 && lead <= 0xF4) return 4;
  return 0;
}

// Overlong forms, surrogates and values above U+10FFFF are shut out by the second byte alone; U+FFFE and
// U+FFFF are no XML characters.
bool is_allowed(std::string_view sequence) {
  const std::uint8_t lead = byte_at(sequence, 0);
  const std::uint8_t second = byte_at(sequence, 1);
  if (sequence.size() == 1) return lead >= 0x20 ? lead != 0x7F : lead == '\n' || lead == '\t';
  if (lead == 0xE0 && second < 0xA0) return false;
  if (lead == 0xED && second > 0x9F) return false;
  if (lead == 0xF0 && second < 0x90) return false;
  if (lead == 0xF4 && second > 0x8F) return false;
  return !(lead == 0xEF && second == 0xBF && byte_at(sequence, 2) >= 0xBE);
}

// Length of the well-formed sequence that starts at i; 0 when there is none.
std::size_t sequence_length(std::string_view text, std::size_t i) {
  const std::size_t length = announced_length(byte_at(text, i));
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte_at(text, i + k) & 0xC0) != 0x80) return 0;
  }
  return length;
}

std::string_view entity(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return {};
  }
}

void replace_all(std::string& text, char from, std::string_view to) {
  for (std::size_t i = text.find(from); i != std::string::npos; i = text.find(from, i + to.size())) {
    text.replace(i, 1, to);
  }
}

}  // namespace

std::string clean_text(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = sequence_length(text, i);
    const std::string_view sequence = text.substr(i, std::max<std::size_t>(length, 1));
    result += length > 0 && is_allowed(sequence) ? sequence : kReplacement;
    i += sequence.size();
  }
  return result;
}

std::string escape_markup(std::string_view text) {
  std::string result;
  for (const char c : clean_text(text)) {
    const std::string_view replacement = entity(c);
    replacement.empty() ? result.push_back(c) : void(result.append(replacement));
  }
  return result;
}

std::string escape_attribute(std::string_view text) {
  std::string result = escape_markup(text);
  replace_all(result, '\n', "&#10;");
  replace_all(result, '\t', "&#9;");
  return result;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string result;
  result.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::uint32_t group = std::uint32_t{byte_at(bytes, i)} << 16U |
                                std::uint32_t{byte_at(bytes, i + 1)} << 8U | byte_at(bytes, i + 2);
    for (std::size_t digit = 0; digit < 4; ++digit) {
      const bool is_padding = i + digit > bytes.size();
      result.push_back(is_padding ? '=' : kDigits[group >> (18U - 6U * static_cast<unsigned>(digit)) & 63U]);
    }
  }
  return result;
}

std::string format_number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return fmt::format("{:.4g}", value);
}

std::string format_interval(double value, double uncertainty) {
  if (uncertainty == 0.0) return format_number(value);
  if (!std::isfinite(value) || !std::isfinite(uncertainty) || uncertainty < 0.0) {
    return fmt::format("{} ± {}", format_number(value), format_number(uncertainty));
  }
  const int magnitude = static_cast<int>(std::floor(std::log10(std::max(std::abs(value), uncertainty))));
  const int exponent = magnitude < -4 || magnitude > 5 ? magnitude : 0;
  const double unit = std::pow(10.0, exponent);
  const int place = static_cast<int>(std::floor(std::log10(uncertainty / unit)));
  const int decimals = std::clamp(1 - place, 0, 12);
  const std::string pair =
      fmt::format("{:.{}f} ± {:.{}f}", value / unit, decimals, uncertainty / unit, decimals);
  return exponent == 0 ? pair : fmt::format("({})e{}", pair, exponent);
}

std::string format_seconds(double seconds) {
  if (!std::isfinite(seconds)) return format_number(seconds);
  if (seconds < 0.9995) return fmt::format("{:.3g} ms", seconds * 1e3);
  if (seconds < 120.0) return fmt::format("{:.3g} s", seconds);
  if (seconds < 7200.0) return fmt::format("{:.3g} min", seconds / 60.0);
  return fmt::format("{:.3g} h", seconds / 3600.0);
}

}  // namespace plumbline::report
