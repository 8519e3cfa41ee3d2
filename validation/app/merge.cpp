// plumbline merge: shards of one render put together.
#include <fmt/format.h>

#include "reference/image/exr.hpp"
#include "reference/integrate/shards.hpp"
#include "validation/app/options.hpp"
#include "validation/app/verbs.hpp"

namespace plumbline::app {
namespace {

struct Options {
  std::vector<std::string> parts;
  std::string output;
  std::string json;
};

int run(const Options& options) {
  require_destinations({{"-o", options.output, ".exr"}, {"--json", options.json, ""}});
  std::vector<image::LayeredImage> parts;
  for (const std::string& path : options.parts) parts.push_back(image::read_exr(path));
  image::write_exr(options.output, integrate::merge_shards(parts, options.parts));
  if (options.json != "-") say(fmt::format("{}: {} shards", options.output, parts.size()));
  write_json(options.json, {{"output", options.output}, {"shards", parts.size()}});
  return kSuccess;
}

}  // namespace

void register_merge(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      app.add_subcommand("merge", "put the shards of a render together, bit-identical to the single run");
  verb->add_option("PART", options->parts, "all N images written by `render --shard i/N`, in any order")
      ->required();
  add_output(*verb, options->output, "image to write")->required();
  add_json(*verb, options->json, "a summary");
  verb->footer("Example: plumbline merge part0.exr part1.exr -o whole.exr");
  on_chosen(*verb, options, chosen, &run);
}

}  // namespace plumbline::app
