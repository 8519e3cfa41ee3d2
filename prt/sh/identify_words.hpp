// prt/sh/identify_words.hpp: in what readings of a set of coefficients differ.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "prt/sh/identify.hpp"

namespace plumbline::sh {

/// How far a reading is from the plainest: ascending, own axes, orthonormal radiance in rows.
[[nodiscard]] int complexity(const Convention& convention);
/// The same six choices (factors aside).
[[nodiscard]] bool is_same_reading(const Convention& a, const Convention& b);
/// Which known conventions are tied, and what the tied candidates differ in from the first, one line a choice, each
/// candidate in its nearest reading.
[[nodiscard]] std::vector<std::string> differences(std::span<const Candidate> tied);
/// What would tell them apart.
[[nodiscard]] std::vector<std::string> remedies(std::span<const Candidate> tied, bool is_uniform);

}  // namespace plumbline::sh
