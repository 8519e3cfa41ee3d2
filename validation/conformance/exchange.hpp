// validation/conformance/exchange.hpp: questions and answers as files, for engines that cannot be linked.
#pragma once

#include <filesystem>

#include "validation/conformance/conform.hpp"

namespace plumbline::conformance {

/// Writes README.txt, manifest.json and the questions: directions, coefficients, rotations and normals as CSV, a
/// lat-long environment as EXR. The folder is made where there is none. @throws InputError when it cannot be written
void write_questions(const std::filesystem::path& folder, int bands);

/// Judges the answers beside the questions; the convention comes from convention.json there (empty = unknown). A
/// missing answer is inconclusive. @throws InputError for a folder without manifest.json, or an answer that is no
/// table of finite numbers
[[nodiscard]] Verdict judge_answers(const std::filesystem::path& folder);

}  // namespace plumbline::conformance
