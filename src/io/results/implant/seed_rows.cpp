// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/seed_rows.hpp"

#include <fmt/format.h>

namespace stylet::results {

SeedRow row_of_seed(const SeedHistory& seed, const ImplantOutcome& outcome) {
  const Implant implant = implant_of(outcome.history.seeds);
  const double dwell_s = implant == Implant::temporary ? outcome.planned.plan.sources[seed.number].dwell_s : 0.0;
  return {seed, outcome.history.needles[seed.needle].name, implant, dwell_s};
}

FoundRow row_of_found(const SeedHistory& seed, const MatchedSeed* matched, const ImplantHistory& history,
                      const FoundComparison& comparison) {
  FoundRow shown;
  shown.number = seed.number;
  shown.needle = history.needles[seed.needle].name;
  shown.planned_mm = seed.planned_mm;
  shown.dropped_mm = seed.dropped_mm;
  if (!seed.lost) {
    shown.rest_mm = seed.rest_mm;
    shown.causes = seed.cause_mm;
  }
  if (matched) {
    shown.found = matched->found;
    shown.ambiguous = matched->ambiguous;
    shown.found_mm = matched->found_mm;
    shown.error_mm = matched->error_mm();
    shown.remainder_mm = matched->remainder_mm;
    shown.remainder_without_shift_mm = matched->remainder_mm - comparison.matching.shift_mm;
  }
  return shown;
}

std::string four_decimals(double value, int) { return fmt::format("{:.4f}", value); }

}  // namespace stylet::results
