#include "reference/base/text.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace plumbline {

std::string one_line(std::string_view text, std::size_t longest) {
  std::string result;
  for (const char c : text) {
    const char kept = static_cast<unsigned char>(c) < 32U ? ' ' : c;
    if (kept != ' ' || !result.ends_with(' ')) result += kept;
  }
  const bool is_cut = result.size() > longest;
  if (is_cut) result.resize(longest);
  result.erase(result.find_last_not_of(' ') + 1);
  return is_cut ? result + "..." : result;
}

std::string replaced(std::string_view text, std::string_view from, std::string_view to) {
  std::string result;
  for (std::size_t found = text.find(from); found != std::string_view::npos; found = text.find(from)) {
    result.append(text.substr(0, found)).append(to);
    text.remove_prefix(found + from.size());
  }
  return result.append(text);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> words;
  for (std::size_t end = text.find(separator); end != std::string_view::npos; end = text.find(separator)) {
    words.push_back(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  words.push_back(text);
  return words;
}

std::string lower_case_extension(std::string_view path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace plumbline
