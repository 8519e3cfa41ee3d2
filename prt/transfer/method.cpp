#include "prt/transfer/method.hpp"

#include <fmt/format.h>

#include <array>

#include "reference/base/error.hpp"

namespace plumbline::transfer {
namespace {

template <class Choice, std::size_t N>
Choice choice_from(const std::array<Choice, N>& choices, std::string_view text, const char* where,
                   const char* expected) {
  for (const Choice choice : choices) {
    if (text == to_string(choice)) return choice;
  }
  throw InputError(fmt::format("{}: expected {}, got {}", where, expected, text));
}

}  // namespace

std::string_view to_string(Solver solver) {
  return solver == Solver::traced ? "traced" : "iterative";
}

std::string_view to_string(Sampling sampling) {
  switch (sampling) {
    case Sampling::qmc:
      return "qmc";
    case Sampling::cosine:
      return "cosine";
    case Sampling::uniform:
      return "uniform";
  }
  return "?";
}

std::string_view to_string(DirectionSets directions) {
  return directions == DirectionSets::shared ? "shared" : "per-vertex";
}

Solver solver_from_string(std::string_view text) {
  return choice_from(std::array{Solver::traced, Solver::iterative}, text, "solver", "traced or iterative");
}

Sampling sampling_from_string(std::string_view text) {
  return choice_from(std::array{Sampling::qmc, Sampling::cosine, Sampling::uniform}, text, "sampling",
                     "qmc, cosine or uniform");
}

DirectionSets direction_sets_from_string(std::string_view text) {
  return choice_from(std::array{DirectionSets::per_vertex, DirectionSets::shared}, text, "directions",
                     "per-vertex or shared");
}

}  // namespace plumbline::transfer
