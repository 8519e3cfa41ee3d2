#include "prt/transfer/transfer.hpp"

#include <fmt/format.h>

#include <cmath>

#include "prt/sh/basis.hpp"
#include "reference/base/error.hpp"

namespace plumbline::transfer {

namespace {

void require_sizes(const std::vector<float>& coefficients, const std::vector<float>& standard_errors,
                   std::size_t expected, const std::string& where) {
  if (coefficients.size() != expected) {
    throw InputError(
        fmt::format("{}: expected {} coefficients, got {}", where, expected, coefficients.size()));
  }
  if (!standard_errors.empty() && standard_errors.size() != expected) {
    throw InputError(
        fmt::format("{}: expected {} standard errors, got {}", where, expected, standard_errors.size()));
  }
  for (std::size_t i = 0; i < expected; ++i) {
    if (!std::isfinite(coefficients[i]))
      throw InputError(fmt::format("{}: coefficient {} is not finite", where, i));
  }
}

}  // namespace

std::string_view to_string(Kind kind) {
  switch (kind) {
    case Kind::unshadowed:
      return "unshadowed";
    case Kind::shadowed:
      return "shadowed";
    case Kind::interreflected:
      return "interreflected";
  }
  return "?";
}

Kind kind_from_string(std::string_view text) {
  for (const Kind kind : {Kind::unshadowed, Kind::shadowed, Kind::interreflected}) {
    if (text == to_string(kind)) return kind;
  }
  throw InputError(fmt::format("transfer: expected unshadowed, shadowed or interreflected, got {}", text));
}

std::span<const float> Transfer::vector(std::size_t vertex, int channel) const {
  return row_of(coefficients, vertex, channel);
}

std::span<const float> Transfer::row_of(const std::vector<float>& values, std::size_t vertex,
                                        int channel) const {
  const auto count = static_cast<std::size_t>(sh::coefficient_count(bands));
  const auto row =
      vertex * static_cast<std::size_t>(channels) + (channels == 1 ? 0U : static_cast<std::size_t>(channel));
  return std::span<const float>(values).subspan(row * count, count);
}

void validate(const Transfer& transfer, const std::string& where) {
  if (transfer.bands < 1 || transfer.bands > sh::kMaxBands) {
    throw InputError(
        fmt::format("{}: bands: expected 1 to {}, got {}", where, sh::kMaxBands, transfer.bands));
  }
  if (transfer.channels != 1 && transfer.channels != 3) {
    throw InputError(fmt::format("{}: channels: expected 1 or 3, got {}", where, transfer.channels));
  }
  const auto expected = transfer.vertices * static_cast<std::size_t>(transfer.channels) *
                        static_cast<std::size_t>(sh::coefficient_count(transfer.bands));
  require_sizes(transfer.coefficients, transfer.standard_errors, expected, where);
  for (const Term& term : transfer.terms) {
    require_sizes(term.coefficients, term.standard_errors, expected, where + ": terms");
    if (term.standard_errors.empty() != transfer.standard_errors.empty())
      throw InputError(where + ": terms: expected standard errors where the sum has them");
  }
}

}  // namespace plumbline::transfer
