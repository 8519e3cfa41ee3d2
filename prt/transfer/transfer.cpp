#include "prt/transfer/transfer.hpp"

#include <fmt/format.h>

#include <cmath>

#include "prt/sh/basis.hpp"
#include "reference/base/error.hpp"

namespace plumbline::transfer {

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
  const auto count = static_cast<std::size_t>(sh::coefficient_count(bands));
  const auto row =
      vertex * static_cast<std::size_t>(channels) + (channels == 1 ? 0U : static_cast<std::size_t>(channel));
  return std::span<const float>(coefficients).subspan(row * count, count);
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
  if (transfer.coefficients.size() != expected) {
    throw InputError(
        fmt::format("{}: expected {} coefficients, got {}", where, expected, transfer.coefficients.size()));
  }
  if (!transfer.standard_errors.empty() && transfer.standard_errors.size() != expected) {
    throw InputError(fmt::format("{}: expected {} standard errors, got {}", where, expected,
                                 transfer.standard_errors.size()));
  }
  for (std::size_t i = 0; i < expected; ++i) {
    if (!std::isfinite(transfer.coefficients[i]))
      throw InputError(fmt::format("{}: coefficient {} is not finite", where, i));
  }
}

}  // namespace plumbline::transfer
