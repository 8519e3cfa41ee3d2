// plumbline merge: shards of one render put together.
#include <fmt/format.h>

#include "reference/base/atomic_file.hpp"
#include "reference/image/exr.hpp"
#include "reference/integrate/shards.hpp"
#include "validation/app/verbs.hpp"

namespace plumbline::app {
namespace {

struct Options {
  std::vector<std::string> parts;
  std::string output;
  std::string json;
};

int run(const Options& options) {
  require_writable(options.output);
  std::vector<image::LayeredImage> parts;
  for (const std::string& path : options.parts) parts.push_back(image::read_exr(path));
  image::write_exr(options.output, integrate::merge_shards(parts, options.parts));
  if (options.json != "-") fmt::print("{}: {} shards\n", options.output, parts.size());
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
  verb->add_option("-o,--output", options->output, "image to write")->required();
  verb->add_option("--json", options->json, "write a summary to this file, or - for standard output");
  verb->footer("Example: plumbline merge part0.exr part1.exr -o whole.exr");
  verb->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace plumbline::app
