// validation/app/main.cpp: the `plumbline` command. The only place where exceptions are caught.
#include <fmt/format.h>

#include <exception>
#include <new>
#include <string>

#include "reference/base/error.hpp"
#include "validation/app/documents.hpp"
#include "validation/app/verbs.hpp"

namespace plumbline::app {
namespace {

void register_verbs(CLI::App& app, Action& action) {
  for (const Register add :
       {register_render, register_merge, register_gather, register_project, register_bake, register_compress,
        register_relight, register_inspect, register_compare, register_validate, register_bench,
        register_conform, register_identify, register_conventions, register_normal_basis, register_scenes}) {
    add(app, action);
  }
}

// CLI11 would say of a wrong verb only that one is required.
void require_verb(const CLI::App& app, int argc, const char* const* argv) {
  const std::string word = argc > 1 ? argv[1] : "";
  bool is_known = word.starts_with('-') && app.get_option_no_throw(word) != nullptr;
  std::string verbs;
  for (const CLI::App* verb : app.get_subcommands({})) {
    is_known |= verb->get_name() == word;
    verbs += (verbs.empty() ? "" : ", ") + verb->get_name();
  }
  if (argc < 2) throw InputError(fmt::format("no verb given, there are: {} (see `plumbline --help`)", verbs));
  if (is_known) return;
  if (word.starts_with('-')) {
    throw InputError(fmt::format("{}: unknown option before the verb, verbs are: {}", quoted(word), verbs));
  }
  throw InputError(fmt::format("unknown verb {}, there are: {}", quoted(word), verbs));
}

int run(int argc, const char* const* argv) {
  CLI::App app("Plumbline: ground truth for spherical-harmonic lighting and precomputed radiance transfer",
               "plumbline");
  app.set_version_flag("--version", "plumbline " PLUMBLINE_VERSION);
  app.add_flag_callback(
      "--man-page", [&app] { throw CLI::CallForVersion(man_page(app), CLI::ExitCodes::Success); },
      "print the manual page");
  app.add_flag_callback(
      "--bash-completion",
      [&app] { throw CLI::CallForVersion(bash_completion(app), CLI::ExitCodes::Success); },
      "print a completion script for bash");
  app.require_subcommand(1);
  app.footer(
      "`plumbline VERB --help` describes a verb and shows an example.\n"
      "Exit codes: 0 success, 1 a check failed, 2 bad input or usage, 3 internal error.\n"
      "Example: plumbline render builtin:cornell -o cornell.exr --spp 64");
  Action action;
  register_verbs(app, action);
  require_verb(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    throw InputError(fmt::format("{} (see `plumbline {} --help`)", error.what(), argv[1]));
  }
  return action();
}

int complain_and(ExitCode code, const std::string& reason) {
  complain(reason);
  return code;
}

}  // namespace
}  // namespace plumbline::app

int main(int argc, char** argv) {
  using namespace plumbline;
  using app::complain_and;
  try {
    app::prepare_standard_streams();
    return app::run(argc, argv);
  } catch (const InputError& error) {
    return complain_and(app::kBadInput, error.what());
  } catch (const DeviceError& error) {
    return complain_and(app::kBadInput, error.what());
  } catch (const std::bad_alloc&) {
    return complain_and(app::kBadInput, "not enough memory for this input");
  } catch (const std::exception& error) {
    return complain_and(app::kInternal, std::string("internal error: ") + error.what());
  }
}
