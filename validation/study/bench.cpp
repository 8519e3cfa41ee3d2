#include "validation/study/bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "reference/base/error.hpp"

namespace plumbline::study {
namespace {

constexpr std::uint64_t kReferenceSeed = std::uint64_t{1} << 32U;
constexpr const char* kTaskAttributes[] = {"plumbline.sceneHash", "plumbline.environment",
                                           "plumbline.bounces"};

int number_of_runs(const Plan& plan) {
  return plan.repetitions * static_cast<int>(plan.spp.size());
}

std::vector<Method> available(const Task& task, const Plan& plan, std::vector<Skipped>& skipped) {
  std::vector<Method> result;
  for (const std::string& name : plan.methods) {
    const MethodEntry& entry = find_method(name);
    const std::string reason = entry.reason_against(task);
    if (reason.empty()) {
      result.push_back(entry.make(task));
    } else {
      skipped.push_back({name, reason, number_of_runs(plan)});
    }
  }
  return result;
}

/// Counts samples, which cost about the same whoever traces them.
class Work {
 public:
  Work(const Plan& plan, std::size_t methods) : progress_(plan.progress) {
    for (const int spp : plan.spp)
      total_ += static_cast<double>(spp) * plan.repetitions * static_cast<double>(methods);
    if (!plan.reference_file) total_ += 2.0 * plan.reference_spp * static_cast<double>(methods);
  }
  void add(double samples) {
    done_ += samples;
    if (progress_) progress_(std::min(1.0, done_ / total_));
  }

 private:
  std::function<void(double)> progress_;
  double total_ = 0.0;
  double done_ = 0.0;
};

LoadedReference read_reference(const Task& task, const Plan& plan) {
  LoadedReference loaded = load_reference(*plan.reference_file);
  const image::Image& image = loaded.reference.a;
  if (image.width != task.width || image.height != task.height) {
    throw InputError(fmt::format("{}: expected an image of {}x{}, it has {}x{}",
                                 plan.reference_file->string(), task.width, task.height, image.width,
                                 image.height));
  }
  const std::map<std::string, std::string> own = reference_attributes(task, plan);
  for (const char* name : kTaskAttributes) {
    const auto found = loaded.attributes.find(name);
    if (found == loaded.attributes.end() || found->second == own.at(name)) continue;
    throw InputError(fmt::format("{}: made for another task: {} is {}, expected {}",
                                 plan.reference_file->string(), name, found->second, own.at(name)));
  }
  return loaded;
}

void make_long_images(const std::vector<Method>& methods, const Plan& plan, Work& work, Outcome& outcome) {
  for (const Method& method : methods) {
    outcome.renderers[method.name] = method.render_halves(2 * plan.reference_spp, plan.seed + kReferenceSeed);
    work.add(2.0 * plan.reference_spp);
  }
  outcome.reference = make_reference(outcome.renderers);
}

void make_run(const Method& method, const Plan& plan, int repetition, std::size_t budget, Outcome& outcome) {
  const int spp = plan.spp[budget];
  const std::uint64_t number = static_cast<std::uint64_t>(repetition) * plan.spp.size() + budget;
  const std::uint64_t seed = plan.seed + 1 + number;
  Rendered rendered = method.render(spp, seed);
  outcome.runs.push_back(
      {method.name, spp, repetition, seed, rendered.seconds, relmse(rendered.image, outcome.reference)});
  if (repetition == 0 && spp == *std::max_element(plan.spp.begin(), plan.spp.end()))
    outcome.last_images[method.name] = std::move(rendered.image);
}

void make_runs(std::vector<Method> methods, const Plan& plan, Work& work, Outcome& outcome) {
  for (int repetition = 0; repetition < plan.repetitions; ++repetition) {
    for (std::size_t budget = 0; budget < plan.spp.size(); ++budget) {
      for (const Method& method : methods) {
        make_run(method, plan, repetition, budget, outcome);
        work.add(plan.spp[budget]);
      }
    }
    std::reverse(methods.begin(), methods.end());
  }
}

/// The first two in the order of --methods; the first is judged, the second is the base.
std::optional<Agreement> agreement_of(const Plan& plan, const std::map<std::string, Halved>& renderers) {
  std::vector<std::string> names;
  for (const std::string& method : plan.methods)
    if (renderers.contains(method)) names.push_back(method);
  if (names.size() < 2) return std::nullopt;
  return compare_renderers(fmt::format("{} against {}", names[0], names[1]), renderers.at(names[1]),
                           renderers.at(names[0]));
}

}  // namespace

Outcome run_study(const Task& task, const Plan& plan) {
  require_possible(task, plan);
  Outcome outcome;
  if (plan.reference_file) {
    LoadedReference loaded = read_reference(task, plan);
    outcome.reference = std::move(loaded.reference);
    outcome.renderers = std::move(loaded.renderers);
    outcome.has_reference_halves = loaded.has_halves;
  }
  const std::vector<Method> methods = available(task, plan, outcome.skipped);
  Work work(plan, methods.size());
  work.add(0.0);
  for (const Method& method : methods) (void)method.render(1, plan.seed);  // caches, pages, kernels
  if (!plan.reference_file) make_long_images(methods, plan, work, outcome);
  make_runs(methods, plan, work, outcome);
  outcome.agreement = agreement_of(plan, outcome.renderers);
  return outcome;
}

void require_possible(const Task& task, const Plan& plan) {
  if (plan.reference_file) (void)read_reference(task, plan);
  std::string reason;
  for (const std::string& name : plan.methods) {
    const std::string one = find_method(name).reason_against(task);
    if (one.empty()) return;
    reason = fmt::format("--methods: {}: {}", name, one);
  }
  throw InputError(reason.empty() ? "--methods: none given" : reason);
}

std::map<std::string, std::string> reference_attributes(const Task& task, const Plan& plan) {
  return {{"plumbline.sceneHash", scene::fingerprint(task.world->scene)},
          {"plumbline.environment", plan.environment},
          {"plumbline.bounces", std::to_string(task.max_bounces)},
          {"plumbline.samplesPerHalf", std::to_string(plan.reference_spp)},
          {"plumbline.version", PLUMBLINE_VERSION}};
}

}  // namespace plumbline::study
