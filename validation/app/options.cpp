#include "validation/app/options.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>

#include "prt/sh/basis.hpp"
#include "reference/base/error.hpp"
#include "reference/base/text.hpp"
#include "reference/scene/text.hpp"

namespace plumbline::app {
namespace {

// Beyond this float cannot tell neighbouring degrees apart.
constexpr double kMostDegrees = 1 << 24;

[[noreturn]] void refuse(const std::string& option, const std::string& expected, const std::string& text) {
  throw InputError(fmt::format("{}: expected {}, got {}", replaced(option, ",", " or "), expected,
                               quoted(one_line(text))));
}

// A file's name; "-" is one too.
CLI::Option* add_file(CLI::App& verb, const std::string& names, std::string& path, const std::string& help) {
  const std::function<void(const std::string&)> read = [&path, names](const std::string& text) {
    if (text.empty()) refuse(names, "the name of a file", text);
    path = text;
  };
  return verb.add_option_function<std::string>(names, read, help)->type_name("FILE");
}

}  // namespace

CLI::Option* add_whole_number(CLI::App& verb, const std::string& names, int& value, WholeNumbers range,
                              const std::string& help) {
  const std::function<void(const std::string&)> read = [&value, names, range](const std::string& text) {
    const std::optional<std::int64_t> number = scene::parse_integer(text);
    if (!number || *number < range.low || *number > range.high) {
      refuse(names, fmt::format("a whole number from {} to {}", range.low, range.high), text);
    }
    value = static_cast<int>(*number);
  };
  return verb.add_option_function<std::string>(names, read, help)->type_name("N");
}

CLI::Option* add_number(CLI::App& verb, const std::string& names, std::function<void(double)> store,
                        const std::string& expected, bool (*is_allowed)(double), const std::string& help) {
  const std::function<void(const std::string&)> read = [store = std::move(store), names, expected,
                                                        is_allowed](const std::string& text) {
    const std::optional<double> number = scene::parse_number(text);
    if (!number || !std::isfinite(*number) || !is_allowed(*number)) refuse(names, expected, text);
    store(*number);
  };
  return verb.add_option_function<std::string>(names, read, help)->type_name("NUMBER");
}

CLI::Option* add_positive(CLI::App& verb, const std::string& names, double& value, const std::string& help) {
  return add_number(
      verb, names, [&value](double number) { value = number; }, "a number above 0",
      [](double number) { return number > 0.0; }, help);
}

void add_angles(CLI::App& verb, const std::string& name, std::vector<float>& degrees,
                const std::string& help) {
  const std::function<void(const std::string&)> read = [&degrees, name](const std::string& text) {
    const std::vector<std::string_view> words = split(text, ',');
    std::vector<float> angles;
    for (const std::string_view word : words) {
      const std::optional<double> angle = scene::parse_number(word);
      if (angle && std::abs(*angle) <= kMostDegrees) angles.push_back(static_cast<float>(*angle));
    }
    if (words.size() != 3 || angles.size() != 3) refuse(name, "three angles X,Y,Z in degrees", text);
    degrees = std::move(angles);
  };
  verb.add_option_function<std::string>(name, read, help)->type_name("X,Y,Z");
}

void add_seed(CLI::App& verb, std::uint64_t& seed) {
  const std::function<void(const std::string&)> read = [&seed](const std::string& text) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
    if (error != std::errc{} || end != text.data() + text.size()) {
      refuse("--seed", "a whole number from 0 to 18446744073709551615", text);
    }
  };
  verb.add_option_function<std::string>("--seed", read, "same seed, same bits (default 0)")->type_name("N");
}

void add_threads(CLI::App& verb, int& threads) {
  add_whole_number(verb, "--threads", threads, {0, 4096}, "0 = all; never changes the result");
}

void add_bands(CLI::App& verb, int& bands, const std::string& help) {
  add_whole_number(verb, "--bands", bands, {1, sh::kMaxBands}, help)->required();
}

void add_bounces(CLI::App& verb, std::string& bounces) {
  verb.add_option("--bounces", bounces, "indirect bounces: 0 = direct light only, all = no limit (default)");
}

void add_size(CLI::App& verb, std::string& size) {
  verb.add_option("--size", size, "image size WxH (default 256x256)");
}

CLI::Option* add_output(CLI::App& verb, std::string& output, const std::string& help) {
  return add_file(verb, "-o,--output", output, help);
}

void add_json(CLI::App& verb, std::string& json, const std::string& what) {
  add_file(verb, "--json", json, "write " + what + " to this file, or - for standard output");
}

}  // namespace plumbline::app
