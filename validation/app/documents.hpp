// validation/app/documents.hpp: what describes the command outside it, made from the command itself.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace plumbline::app {

/// man(7) source: every verb with every option, as --help gives them.
[[nodiscard]] std::string man_page(const CLI::App& app);

/// A completion script for bash: verbs, the options of the verb, else files.
[[nodiscard]] std::string bash_completion(const CLI::App& app);

}  // namespace plumbline::app
