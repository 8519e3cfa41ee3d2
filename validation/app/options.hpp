// validation/app/options.hpp: options that several verbs spell the same way. Every value is read strictly
// ("1x", "0x10" or "1.5" is no whole number) and a wrong one is refused in one line that names the option,
// what was expected and what came.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "validation/app/common.hpp"

namespace plumbline::app {

/// Both ends included.
struct WholeNumbers {
  std::int64_t low = 0;
  std::int64_t high = std::numeric_limits<int>::max();
};
/// @param names  as CLI11 takes them: "-n,--number"
CLI::Option* add_whole_number(CLI::App& verb, const std::string& names, int& value, WholeNumbers range,
                              const std::string& help);

/// A finite number that satisfies `is_allowed`; `expected` says which those are.
CLI::Option* add_number(CLI::App& verb, const std::string& names, std::function<void(double)> store,
                        const std::string& expected, bool (*is_allowed)(double), const std::string& help);
CLI::Option* add_positive(CLI::App& verb, const std::string& names, double& value, const std::string& help);

/// Three finite numbers "X,Y,Z", which may be negative.
void add_angles(CLI::App& verb, const std::string& name, std::vector<float>& degrees,
                const std::string& help);

/// --seed, any 64 bits.
void add_seed(CLI::App& verb, std::uint64_t& seed);
/// --threads: 0 = all there are.
void add_threads(CLI::App& verb, int& threads);
/// --bands n.
void add_bands(CLI::App& verb, int& bands, const std::string& help);
/// --bounces; read it with parse_bounces.
void add_bounces(CLI::App& verb, std::string& bounces);
/// --size; read it with parse_size.
void add_size(CLI::App& verb, std::string& size);
/// -o,--output.
CLI::Option* add_output(CLI::App& verb, std::string& output, const std::string& help);
/// --json.
void add_json(CLI::App& verb, std::string& json, const std::string& what);

/// Makes `run` what happens when the verb was chosen and its options are right.
template <class Options>
void on_chosen(CLI::App& verb, std::shared_ptr<Options> options, Action& chosen, int (*run)(const Options&)) {
  verb.callback(
      [options = std::move(options), &chosen, run] { chosen = [options, run] { return run(*options); }; });
}

}  // namespace plumbline::app
