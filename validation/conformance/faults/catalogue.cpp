#include "validation/conformance/faults/catalogue.hpp"

#include <array>
#include <cstddef>
#include <cstring>

#include "validation/conformance/adapters/plumbline_sh.hpp"

namespace plumbline::conformance {

std::vector<Fault> all_faults() {
  std::vector<Fault> all;
  for (const auto part :
       {basis_faults, projection_faults, operation_faults, lighting_faults, statistics_faults}) {
    const std::vector<Fault> faults = part();
    all.insert(all.end(), faults.begin(), faults.end());
  }
  return all;
}

const std::vector<UnjudgedFault>& transport_faults() {
  static const std::vector<UnjudgedFault> kFaults{
      {"M11, L9, T27",
       "iterating T <- T + B T instead of summing B^k T0: right at one bounce, too bright after"},
      {"M12, T28", "a bounce without 1/pi, or without the 4 pi of its directions"},
      {"M15", "SH lightmap whose factors of bands 0 and 1 disagree"},
      {"M25", "probes that miss one bounce of mixed lights"},
      {"L6", "visibility skips triangles by vertex index: duplicated vertices hide themselves"},
      {"T29", "normals normalised for direct light, not for indirect"},
      {"T31", "occluders farther than a fixed distance vanish"},
      {"T38, T39, T40",
       "light counted twice, densities that disagree, pulses not divided by the sample count"},
      {"T41, T42", "Russian roulette without its weight, a fixed bounce limit sold as converged"},
      {"T43, T50", "shadow epsilons, triangles lost in the hierarchy"},
      {"T46", "isotropic phase function 1/pi"},
      {"T48", "the receiver's albedo twice, or another surface's"},
  };
  return kFaults;
}

namespace {

/// Without the functions that are not our own: a check that no longer applies is one that calls them.
Implementation without_the_fault(const Implementation& faulty) {
  constexpr std::size_t kFirst = offsetof(Implementation, evaluate_basis);
  using Pointer = void (*)();
  std::array<Pointer, (sizeof(Implementation) - kFirst) / sizeof(Pointer)> theirs{};
  std::array<Pointer, theirs.size()> ours{};
  Implementation result = faulty;
  std::memcpy(theirs.data(), reinterpret_cast<const char*>(&faulty) + kFirst, sizeof(theirs));
  std::memcpy(ours.data(), reinterpret_cast<const char*>(&plumbline_sh()) + kFirst, sizeof(ours));
  for (std::size_t i = 0; i < theirs.size(); ++i)
    if (theirs.at(i) != ours.at(i)) theirs.at(i) = nullptr;
  std::memcpy(reinterpret_cast<char*>(&result) + kFirst, theirs.data(), sizeof(theirs));
  if (faulty.light_unit != plumbline_sh().light_unit) result.light_directional = nullptr;
  return result;
}

}  // namespace

Kill judge_fault(const Fault& fault, int bands, const Ruler& ruler) {
  Kill kill{&fault, {}};
  const std::string wanted = fault.check;
  const Implementation rest = without_the_fault(fault.implementation);
  for (const Check& check : all_checks()) {
    if (!check.applies(fault.implementation) || check.applies(rest)) continue;
    for (Judged& result : run_check(check, fault.implementation, bands, ruler)) {
      if (result.finding.verdict != checks::Verdict::fail) continue;
      kill.is_caught = true;
      const std::string place = result.finding.family + ": " + result.finding.name;
      kill.is_named =
          kill.is_named || (place.starts_with(wanted) && result.cause.find(fault.cause) != std::string::npos);
      kill.failures.push_back(std::move(result));
    }
  }
  return kill;
}

}  // namespace plumbline::conformance
