// validation/study/bench.hpp: renderers timed against each other on one task.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "validation/report/report.hpp"
#include "validation/study/agreement.hpp"
#include "validation/study/efficiency.hpp"
#include "validation/study/method.hpp"
#include "validation/study/reference_image.hpp"

namespace plumbline::study {

struct Plan {
  std::string scene;        // as it was asked for
  std::string environment;  // the same
  std::vector<std::string> methods = {"path", "cycles"};
  std::vector<int> spp = {16, 64, 256};
  int repetitions = 3;
  int reference_spp = 1024;                             // of each half, of each method that is there
  std::optional<std::filesystem::path> reference_file;  // instead
  std::uint64_t seed = 0;
  std::function<void(double fraction)> progress;
};

/// A method that was asked for and is not there.
struct Skipped {
  std::string method;
  std::string reason;
  int runs = 0;  // how many there would have been
};

struct Outcome {
  std::vector<Run> runs;  // in the order they were made
  std::vector<Skipped> skipped;
  std::map<std::string, Halved> renderers;  // long images by method
  Halved reference;
  bool has_reference_halves = true;
  std::map<std::string, image::Image> last_images;  // one of the largest budget, by method
  std::optional<Agreement> agreement;               // of the first two renderers with a long image
};

/// The reference, made in equal parts by all methods that are there (or read from a file), then the runs, method after method for
/// each budget, the order turned round from one repetition to the next: A B, B A, … A run's seed is plan.seed + 1 + its number
/// among (repetition, budget); the reference's, plan.seed + 2^32.
/// @throws InputError for an unknown method, when no method is there, or for a reference file of another size or task.
[[nodiscard]] Outcome run_study(const Task& task, const Plan& plan);

/// Throws what run_study would throw, before any work.
void require_possible(const Task& task, const Plan& plan);

/// What marks a reference as made for this task.
[[nodiscard]] std::map<std::string, std::string> reference_attributes(const Task& task, const Plan& plan);

/// The study as a page: headlines, the two images, z map, error against time, tables, findings.
[[nodiscard]] report::Report make_report(const Task& task, const Plan& plan, const Outcome& outcome);
/// Top-level keys for bench.json: runs, budgets, ratios, slopes, skipped, reference.
[[nodiscard]] nlohmann::json to_json(const Task& task, const Plan& plan, const Outcome& outcome);

}  // namespace plumbline::study
