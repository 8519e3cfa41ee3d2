// validation/conformance/border.hpp: between an implementation's SH convention and Plumbline's.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "prt/sh/convention.hpp"
#include "reference/base/vector.hpp"
#include "validation/conformance/plumbline_conformance.h"

namespace plumbline::conformance {

/// CONVENTIONS.md#spherical-harmonics, as the interface writes it.
[[nodiscard]] plumbline_convention own_convention();
/// Its six parts in words; unknown ones say so.
[[nodiscard]] std::string to_string(const plumbline_convention& convention);
/// Empty when every part is one of the interface's values and the axes are a signed permutation or all 0; else what
/// is wrong.
[[nodiscard]] std::string fault_of(const plumbline_convention& convention);

/// The same as a value; unknown parts are Plumbline's. @throws InputError for one with a fault
[[nodiscard]] sh::Convention sh_convention(const plumbline_convention& convention);

/// Converts by one matrix a band: c' = W Q c, Q orthogonal (axes, places), W diagonal (sign, norm, quantity). Their
/// functions are y' = W_r^-1 Q y, with W_r for radiance, and vectors that are multiplied with c go by W^-1 Q.
class Border {
 public:
  /// For 1 ... max_bands bands. @throws InputError for a convention with a fault
  Border(const plumbline_convention& convention, int max_bands);

  [[nodiscard]] const plumbline_convention& convention() const { return declared_; }
  /// Index order, sign, norm and axes are all declared.
  [[nodiscard]] bool knows_basis() const;
  /// Also what the coefficients are of.
  [[nodiscard]] bool knows_coefficients() const;
  /// The largest number of bands that can be brought back: 3 where the convention has or keeps no more.
  [[nodiscard]] int usable_bands(int bands) const;

  /// n^2 coefficients from ours to theirs and back; n^2 basis values from theirs to ours.
  [[nodiscard]] std::vector<double> to_theirs(int bands, const std::vector<double>& ours) const;
  [[nodiscard]] std::vector<double> to_ours(int bands, const std::vector<double>& theirs) const;
  [[nodiscard]] std::vector<double> basis_to_ours(int bands, const std::vector<double>& theirs) const;
  /// Vectors t that coefficients are multiplied with, t . c the same on both sides.
  [[nodiscard]] std::vector<double> dual_to_theirs(int bands, const std::vector<double>& ours) const;
  [[nodiscard]] std::vector<double> dual_to_ours(int bands, const std::vector<double>& theirs) const;
  /// n^2 rows of r, g, b in our layout, from the declared layout and convention.
  [[nodiscard]] std::vector<double> rgb_to_ours(int bands, const std::vector<double>& theirs) const;

 private:
  using Band = std::vector<double>;  // (2l + 1)^2, row-major: Q of one degree

  plumbline_convention declared_;
  sh::Convention convention_;
  std::vector<Band> bands_;
  std::vector<double> weights_;        // W
  std::vector<double> basis_weights_;  // W_r
};

/// Values of the convention's functions at a direction, from the definition: n^2.
[[nodiscard]] std::vector<double> convention_basis(const plumbline_convention& convention, int bands,
                                                   const Vec3d& direction);

/// The convention (index order, sign, norm, axes) whose functions of 1 ... 3 bands these are, at `directions`, to a
/// relative 1e-3; the plainest axes where several fit. None: no convention of the interface fits.
/// @param values  directions.size() rows of 9
[[nodiscard]] std::optional<plumbline_convention> convention_of_basis(const std::vector<Vec3d>& directions,
                                                                      const std::vector<double>& values);

}  // namespace plumbline::conformance
