#include "validation/app/gl_audit.hpp"

#include <string>

#include "validation/app/output.hpp"
#include "validation/checks/gl_agreement.hpp"
#include "validation/checks/gl_storage.hpp"

namespace plumbline::app {
namespace {

// "4": how many are 4 to 7 floats apart.
nlohmann::json json_of(const checks::UlpHistogram& histogram) {
  nlohmann::json json = nlohmann::json::object();
  for (std::size_t k = 0; k < checks::UlpHistogram::kBins; ++k) {
    if (histogram.counts[k] > 0) json[std::to_string(k == 0 ? 0 : 1 << (k - 1))] = histogram.counts[k];
  }
  return json;
}

nlohmann::json json_of(const checks::GlAgreement& a) {
  return {{"vertices",
           {{"max_relative", number(a.vertices_relative)},
            {"max_of_terms", number(a.vertices_of_terms)},
            {"ulps", json_of(a.vertices)}}},
          {"samples",
           {{"max_relative", number(a.samples_relative)},
            {"max_of_terms", number(a.samples_of_terms)},
            {"ulps", json_of(a.samples)}}},
          {"inside", a.inside},
          {"sky", a.sky},
          {"at_edges", a.at_edges},
          {"farthest_edge", a.farthest_edge},
          {"edge_width", a.edge_width},
          {"at_depths", a.at_depths},
          {"unexplained", a.unexplained}};
}

}  // namespace

nlohmann::json gl_audit(const relight::gl::Context& context, const transfer::Baked& baked,
                        const sh::ShRgb& lighting, const scene::Camera& camera, int width, int height) {
  relight::gl::Renderer renderer(context, baked.scene, baked.transfer, {});
  const std::vector<Rgb> cpu = relight::unit_albedo_exit_radiance(baked.transfer, lighting);
  nlohmann::json storage = nlohmann::json::array();
  for (const checks::StorageError& error : checks::storage_errors(context, baked, lighting)) {
    storage.push_back({{"storage", relight::gl::to_string(error.storage)},
                       {"bytes_per_vertex", error.bytes_per_vertex},
                       {"relative_rmse", error.relative_rmse},
                       {"max_of_terms", error.of_terms}});
  }
  nlohmann::json targets = nlohmann::json::array();
  for (const checks::TargetRange& range : checks::target_ranges(context, baked, lighting, camera)) {
    targets.push_back({{"target", relight::gl::to_string(range.target)},
                       {"largest_radiance", range.largest_radiance},
                       {"light_scale", range.light_scale},
                       {"saturates", range.saturates}});
  }
  return {{"agreement",
           json_of(checks::gl_agreement(context, renderer, baked, lighting, cpu, camera, width, height))},
          {"storage", storage},
          {"targets", targets}};
}

}  // namespace plumbline::app
