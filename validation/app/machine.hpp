// validation/app/machine.hpp: where and when a report was made, and the folder it goes to.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace plumbline::app {

/// cpu, threads, memory, os, compiler.
[[nodiscard]] std::map<std::string, std::string> machine();
/// ISO 8601.
[[nodiscard]] std::string now_utc();
/// Makes the folder that `page` will be written into. @throws InputError when that cannot be
void make_folder(const std::filesystem::path& folder, const std::string& page);

}  // namespace plumbline::app
