// reference/base/atomic_file.hpp: outputs that appear by rename, so that nothing is ever half written.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace plumbline {

/// Calls `write` with a temporary path in the destination's folder, then renames it over `destination`, or
/// over the file that `destination` links to. When `write` throws, the temporary is removed and the old
/// destination (if any) is untouched.
/// @throws InputError when the destination cannot be written; see require_writable.
void write_atomically(const std::filesystem::path& destination,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// The same for text that is already in memory.
void write_text_atomically(const std::filesystem::path& destination, std::string_view text);

/// Refuses, before hours of work, a destination that could not be written at the end: an empty name, a folder,
/// a device or pipe (a rename would replace it), a folder that is missing or where no file can be made.
/// @throws InputError naming the path and the reason.
void require_writable(const std::filesystem::path& destination);

/// Whole file as bytes. @throws InputError when it is missing, a folder, or unreadable.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

}  // namespace plumbline
