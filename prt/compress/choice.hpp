// prt/compress/choice.hpp: how many clusters, components and bits an error needs (rate and distortion).
#pragma once

#include <optional>
#include <vector>

#include "prt/compress/quantise.hpp"

namespace plumbline::compress {

struct ChoiceSettings {
  Method method = Method::cpca;
  bool is_iterative = true;
  double target_error = 0.0;  // the relative error that may not be passed; > 0
  ClusterSettings clusters;   // numbers of clusters and components are not read
  std::vector<int> bits;      // the only first bits to try; empty: 8, 16 and 32, all alike and falling
};

/// A point of the plane of size and error.
struct Candidate {
  int clusters = 1;
  std::vector<int> bits;  // one a component
  double bytes_per_vertex = 0.0;
  double expected_error = 0.0;  // relative; static clusters, step^2/12 a weight
};

struct Choice {
  Compressed compressed;
  std::vector<Candidate> candidates;  // all that were weighed, by rising size
  int tried = 0;                      // how many of them were carried out
};

/// Components and clusters that are weighed: each number of components up to the first, each power of two up to the second.
inline constexpr int kMostComponents = 32;
inline constexpr int kMostClusters = 1024;

/// The smallest compression (bytes_per_vertex, constants included) whose measured relative error is at most the target. One
/// static clustering for each number of clusters gives the errors of all numbers of components at once, as sums of
/// dropped eigenvalues, and of all bits, as step^2/12. Then the smallest are carried out until one holds; iterative clusters err
/// less, so that a few which static ones would just miss are tried too. None: nothing that was weighed gets there.
/// @throws InputError for a target that is not above 0
[[nodiscard]] std::optional<Choice> choose(const transfer::Transfer& transfer,
                                           const ChoiceSettings& settings);

}  // namespace plumbline::compress
