// plumbline normal-basis: how much of a smooth light's reflection a few functions of the normal carry.
#include "prt/normal_map/normal_basis.hpp"

#include <fmt/format.h>

#include "reference/base/error.hpp"
#include "validation/app/options.hpp"
#include "validation/app/verbs.hpp"

namespace plumbline::app {
namespace {

struct Options {
  int terms = 0;
  std::string json;
};

nlohmann::json figures(int terms) {
  const normal_map::NormalBasis uniform = normal_map::make_normal_basis(normal_map::NormalWeight::uniform);
  const normal_map::NormalBasis cosine = normal_map::make_normal_basis(normal_map::NormalWeight::cosine);
  return {{"terms", terms},
          {"energy_uniform", normal_map::energy_kept(uniform, terms)},
          {"energy_cosine", normal_map::energy_kept(cosine, terms)},
          {"singular_values_uniform", uniform.singular_values},
          {"singular_values_cosine", cosine.singular_values}};
}

std::string text_of(const nlohmann::json& json) {
  const auto row = [&](const char* label, const char* energy, const char* values) {
    std::string text =
        fmt::format("{:<18} {:7.3f} %   singular values", label, 100.0 * json[energy].get<double>());
    for (const nlohmann::json& value : json[values]) text += fmt::format(" {:.5f}", value.get<double>());
    return text + "\n";
  };
  return fmt::format("squared energy kept by {} of 9 terms, normals spread over the hemisphere\n",
                     json["terms"].get<int>()) +
         row("uniformly", "energy_uniform", "singular_values_uniform") +
         row("by their cosine", "energy_cosine", "singular_values_cosine");
}

int run(const Options& options) {
  require_destinations({{"--json", options.json, ""}});
  if (options.terms < 1 || options.terms > static_cast<int>(normal_map::kQuadraticCount)) {
    throw InputError(
        fmt::format("--terms: expected 1 to {}, got {}", normal_map::kQuadraticCount, options.terms));
  }
  const nlohmann::json json = figures(options.terms);
  if (options.json != "-") write_output("-", text_of(json));
  write_json(options.json, json);
  return kSuccess;
}

}  // namespace

void register_normal_basis(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      app.add_subcommand("normal-basis", "SVD of the normal-direction matrix for normal-mapped PRT");
  verb->add_option("--terms", options->terms, "terms kept, 1 to 9")->required();
  add_json(*verb, options->json, "the energies and singular values");
  verb->footer("Example: plumbline normal-basis --terms 4 --json -");
  on_chosen(*verb, options, chosen, &run);
}

}  // namespace plumbline::app
