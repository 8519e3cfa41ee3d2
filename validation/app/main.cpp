// validation/app/main.cpp: the `plumbline` command. The only place where exceptions are caught.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "reference/base/error.hpp"
#include "validation/app/verbs.hpp"

namespace {

using plumbline::app::Action;

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

int complain(const std::string& reason, int code) {
  fmt::print(stderr, "plumbline: {}\n", one_line(reason));
  return code;
}

int run(int argc, char** argv) {
  CLI::App app("Plumbline: ground truth for spherical-harmonic lighting and precomputed radiance transfer",
               "plumbline");
  app.set_version_flag("--version", "plumbline " PLUMBLINE_VERSION);
  app.require_subcommand(1);
  app.footer(
      "`plumbline VERB --help` describes a verb and shows an example.\n"
      "Exit codes: 0 success, 1 a check failed, 2 bad input or usage, 3 internal error.");
  Action action;
  using namespace plumbline::app;
  for (const Register add :
       {register_render, register_merge, register_gather, register_project, register_bake, register_relight,
        register_inspect, register_compare, register_validate, register_scenes}) {
    add(app, action);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    if (argc < 2) return complain("no verb given (see `plumbline --help`)", kBadInput);
    return complain(error.what(), kBadInput);
  }
  return action ? action() : static_cast<int>(kBadInput);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace plumbline;
  try {
    return run(argc, argv);
  } catch (const InputError& error) {
    return complain(error.what(), app::kBadInput);
  } catch (const DeviceError& error) {
    return complain(error.what(), app::kBadInput);
  } catch (const std::bad_alloc&) {
    return complain("not enough memory for this input", app::kBadInput);
  } catch (const std::exception& error) {
    return complain(std::string("internal error: ") + error.what(), app::kInternal);
  }
}
