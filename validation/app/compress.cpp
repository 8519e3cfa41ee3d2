// plumbline compress: a baked file made smaller.
#include <fmt/format.h>

#include <chrono>
#include <numeric>

#include "prt/compress/choice.hpp"
#include "prt/compress/seams.hpp"
#include "prt/transfer/baked_file.hpp"
#include "reference/base/error.hpp"
#include "reference/base/text.hpp"
#include "reference/scene/text.hpp"
#include "validation/app/compressed_json.hpp"
#include "validation/app/options.hpp"
#include "validation/app/verbs.hpp"

namespace plumbline::app {
namespace {

struct Options {
  std::string input;
  std::string output;
  std::string method = "cpca";
  int clusters = 0;  // 0: the default, or what --target-error takes
  int components = -1;
  std::string bits;
  bool has_falling_bits = false;
  bool is_iterative = true;
  double target_error = 0.0;
  int iterations = 100;
  std::uint64_t seed = 0;
  int threads = 0;
  std::string json;
};

constexpr int kDefaultClusters = 256;
constexpr int kDefaultComponents = 12;

std::vector<int> parse_bits(const std::string& text) {
  std::vector<int> bits;
  for (const std::string_view word : split(text, ',')) {
    const auto number = scene::parse_integer(word);
    if (!number || (*number != 4 && *number != 8 && *number != 16 && *number != 32)) {
      throw InputError(
          fmt::format("--bits: expected 4, 8, 16 or 32, or several of them (8,8,4), got {}", quoted(text)));
    }
    bits.push_back(static_cast<int>(*number));
  }
  return bits;
}

compress::ClusterSettings cluster_settings(const Options& options, std::size_t vertices,
                                           std::size_t dimension) {
  compress::ClusterSettings settings;
  // Defaults give way to small scenes, numbers that were asked for do not.
  settings.clusters = options.clusters > 0
                          ? options.clusters
                          : static_cast<int>(std::min<std::size_t>(kDefaultClusters, vertices));
  settings.components = options.components >= 0
                            ? options.components
                            : static_cast<int>(std::min<std::size_t>(kDefaultComponents, dimension));
  settings.max_iterations = options.iterations;
  settings.seed = options.seed;
  settings.threads = options.threads;
  settings.progress = progress_bar("compress");
  return settings;
}

compress::Compressed compress_as_asked(const Options& options, const transfer::Transfer& transfer) {
  const compress::Vectors vectors = compress::vectors_of(transfer);
  compress::CompressSettings settings;
  settings.method = compress::method_from_string(options.method);
  settings.is_iterative = options.is_iterative;
  settings.clusters = cluster_settings(options, vectors.count(), vectors.dimension);
  settings.bits = parse_bits(options.bits.empty() ? "8" : options.bits);
  settings.has_falling_bits = options.has_falling_bits;
  return compress::compress(transfer, settings);
}

compress::Choice choose(const Options& options, const transfer::Transfer& transfer) {
  compress::ChoiceSettings settings;
  settings.method = compress::method_from_string(options.method);
  settings.is_iterative = options.is_iterative;
  settings.target_error = options.target_error;
  settings.clusters = cluster_settings(options, 1, 1);
  settings.clusters.progress = {};
  if (!options.bits.empty()) settings.bits = parse_bits(options.bits);
  std::optional<compress::Choice> choice = compress::choose(transfer, settings);
  if (choice) return *std::move(choice);
  throw InputError(
      fmt::format("--target-error {}: {} does not get there with up to {} clusters and {} components",
                  options.target_error, options.method, compress::kMostClusters,
                  options.method == "vq" ? 0 : compress::kMostComponents));
}

nlohmann::json json_of(const compress::Seams& seams) {
  return {{"border_edges", seams.border_edges}, {"inner_edges", seams.inner_edges},
          {"exact_jump", seams.exact_jump},     {"border_jump", seams.border_jump},
          {"border_added", seams.border_added}, {"inner_added", seams.inner_added}};
}

nlohmann::json summary(const Options& options, const transfer::Transfer& before, const transfer::Baked& after,
                       int tried, double seconds) {
  const compress::Compressed& compressed = *after.compressed;
  const compress::Vectors exact = compress::vectors_of(before);
  const compress::Seams seams = compress::measure_seams(after.scene.triangles, compressed.labels, exact,
                                                        compress::vectors_of(after.transfer));
  nlohmann::json json = compressed_json(compressed);
  json.update(nlohmann::json{{"input", options.input},
                             {"output", options.output},
                             {"method", options.method},
                             {"uncompressed_bytes_per_vertex", exact.dimension * sizeof(float)},
                             {"vertices", compressed.vertices},
                             {"seams", json_of(seams)},
                             {"seed", options.seed},
                             {"seconds", seconds}});
  if (options.target_error > 0.0) json["target_error"] = options.target_error;
  if (tried > 0) json["tried"] = tried;
  return json;
}

std::string text_of(const compress::Compressed& compressed, const nlohmann::json& json) {
  std::string text =
      fmt::format("{}: {} clusters x {} components, {:.1f} bytes a vertex instead of {}, error {:.3g} %",
                  json["output"].get<std::string>(), compressed.clusters, compressed.components(),
                  json["bytes_per_vertex"].get<double>(), json["uncompressed_bytes_per_vertex"].get<int>(),
                  100.0 * compressed.relative_error);
  if (compressed.bake_relative_error > 0.0) {
    text += fmt::format(" (noise of the bake: {:.3g} %{})", 100.0 * compressed.bake_relative_error,
                        compressed.relative_error < compressed.bake_relative_error ? ", the larger" : "");
  }
  return text;
}

void require_consistent(const Options& options) {
  const auto refuse = [](const std::string& what) { throw InputError("compress: " + what); };
  if (options.target_error > 0.0 &&
      (options.clusters > 0 || options.components >= 0 || options.has_falling_bits)) {
    refuse("--target-error chooses clusters, components and falling bits itself");
  }
  if (options.method == "pca" && options.clusters > 1) refuse("pca has one cluster; --method cpca has more");
  if (options.method == "vq" && options.components > 0) refuse("vq has no components; --method cpca has");
  if (options.method != "cpca" && !options.is_iterative) refuse("only cpca is --static or --iterative");
}

int run(const Options& options) {
  require_consistent(options);
  if (!options.bits.empty()) (void)parse_bits(options.bits);
  require_destinations({{"-o", options.output, ".glb"}, {"--json", options.json, ""}});
  transfer::Baked baked = transfer::load_baked(options.input);
  if (baked.compressed)
    throw InputError(options.input + ": is compressed already; compress the file that was baked");
  const auto start = std::chrono::steady_clock::now();
  const transfer::Transfer before = baked.transfer;
  int tried = 0;
  if (options.target_error > 0.0) {
    compress::Choice choice = choose(options, before);
    tried = choice.tried;
    baked.compressed = std::move(choice.compressed);
  } else {
    baked.compressed = compress_as_asked(options, before);
  }
  baked.transfer.coefficients = compress::decode(*baked.compressed);
  baked.transfer.standard_errors.clear();
  const double seconds = seconds_since(start);
  transfer::save_baked(options.output, baked);
  const nlohmann::json json = summary(options, before, baked, tried, seconds);
  if (options.json != "-") say(text_of(*baked.compressed, json));
  write_json(options.json, json);
  return kSuccess;
}

void add_shape_options(CLI::App& verb, Options& options) {
  verb.add_option("--method", options.method, "vq (cluster means), pca (one cluster) or cpca (both; default)")
      ->check(CLI::IsMember({"vq", "pca", "cpca"}));
  add_whole_number(verb, "--clusters", options.clusters, {1, compress::kMaxClusters},
                   "clusters (default 256)");
  add_whole_number(verb, "--components", options.components, {0, static_cast<int>(compress::kMaxDimension)},
                   "axes a cluster (default 12; renderers like multiples of 4)");
  verb.add_option("--bits", options.bits,
                  "4, 8 (default), 16 or 32 bits a weight; several, as 16,8,4, go to one component each, the "
                  "last to the rest");
  verb.add_flag("--falling-bits", options.has_falling_bits,
                "as many bits for each component as keep its rounding below the first one's");
  verb.add_flag("--iterative,!--static", options.is_iterative,
                "cpca: clusters by distance to the subspace (default), or to the mean");
  add_positive(verb, "--target-error", options.target_error,
               "smallest file of this method whose error (root mean square over all coefficients, relative) "
               "is at most this");
}

}  // namespace

void register_compress(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("compress", "make a baked file smaller and faster to relight");
  verb->add_option("BAKED", options->input, "file written by `plumbline bake`")->required();
  add_output(*verb, options->output, "compressed file (.prt.glb) to write")->required();
  add_shape_options(*verb, *options);
  add_whole_number(*verb, "--iterations", options->iterations, {0, 100000},
                   "iterations at most (default 100)");
  add_seed(*verb, options->seed);
  add_threads(*verb, options->threads);
  add_json(*verb, options->json, "a summary");
  verb->footer(
      "Example: plumbline compress plaza.prt.glb -o small.prt.glb --method cpca --target-error 0.01");
  on_chosen(*verb, options, chosen, &run);
}

}  // namespace plumbline::app
