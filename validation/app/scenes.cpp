// plumbline scenes: what is built in.
#include <fmt/format.h>

#include "reference/light/environment.hpp"
#include "reference/scene/builtin.hpp"
#include "validation/app/verbs.hpp"

namespace plumbline::app {
namespace {

int run(const std::string& json) {
  nlohmann::json out = {{"scenes", nlohmann::json::array()}, {"environments", nlohmann::json::array()}};
  for (const scene::BuiltinInfo& info : scene::builtin_scenes()) {
    out["scenes"].push_back({{"name", info.name}, {"description", info.description}});
  }
  for (const light::BuiltinEnvironment& info : light::builtin_environments()) {
    out["environments"].push_back({{"name", info.name}, {"description", info.description}});
  }
  if (json != "-") {
    for (const char* group : {"scenes", "environments"}) {
      fmt::print("{}:\n", group);
      for (const nlohmann::json& entry : out[group]) {
        fmt::print("  builtin:{:<18} {}\n", entry["name"].get<std::string>(),
                   entry["description"].get<std::string>());
      }
    }
  }
  write_json(json, out);
  return kSuccess;
}

}  // namespace

void register_scenes(CLI::App& app, Action& chosen) {
  auto json = std::make_shared<std::string>();
  CLI::App* verb = app.add_subcommand("scenes", "list the built-in scenes and environments");
  verb->add_option("--json", *json, "write the list to this file, or - for standard output");
  verb->footer("Example: plumbline scenes");
  verb->callback([json, &chosen] { chosen = [json] { return run(*json); }; });
}

}  // namespace plumbline::app
