// plumbline scenes: what is built in.
#include <fmt/format.h>

#include "reference/light/environment.hpp"
#include "reference/scene/builtin.hpp"
#include "validation/app/options.hpp"
#include "validation/app/verbs.hpp"

namespace plumbline::app {
namespace {

struct Options {
  std::string json;
};

nlohmann::json listing() {
  nlohmann::json out = {{"scenes", nlohmann::json::array()}, {"environments", nlohmann::json::array()}};
  for (const scene::BuiltinInfo& info : scene::builtin_scenes()) {
    out["scenes"].push_back({{"name", info.name}, {"description", info.description}});
  }
  for (const light::BuiltinEnvironment& info : light::builtin_environments()) {
    out["environments"].push_back({{"name", info.name}, {"description", info.description}});
  }
  return out;
}

std::string text_of(const nlohmann::json& out) {
  std::string text;
  for (const char* group : {"scenes", "environments"}) {
    text += fmt::format("{}:\n", group);
    for (const nlohmann::json& entry : out[group]) {
      text += fmt::format("  builtin:{:<18} {}\n", entry["name"].get<std::string>(),
                          entry["description"].get<std::string>());
    }
  }
  return text;
}

int run(const Options& options) {
  require_destinations({{"--json", options.json, ""}});
  const nlohmann::json out = listing();
  if (options.json != "-") write_output("-", text_of(out));
  write_json(options.json, out);
  return kSuccess;
}

}  // namespace

void register_scenes(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("scenes", "list the built-in scenes and environments");
  add_json(*verb, options->json, "the list");
  verb->footer("Example: plumbline scenes");
  on_chosen(*verb, options, chosen, &run);
}

}  // namespace plumbline::app
