// SPDX-License-Identifier: GPL-3.0-or-later
#include "output_folder.hpp"
#include "stylet/io/implant_results.hpp"

#include <fmt/format.h>

namespace stylet {
namespace {

/// Three numbers with leading commas.
std::string fields(const Vec3& v) { return fmt::format(",{:.4f},{:.4f},{:.4f}", v.x(), v.y(), v.z()); }

/// The name of a cause in the columns.
const char* column_of(SeedCause cause) {
  switch (cause) {
    case SeedCause::bend:
      return "bend";
    case SeedCause::motion:
      return "motion";
    case SeedCause::relaxation:
      return "relaxation";
    case SeedCause::strand:
      return "strand";
    case SeedCause::release:
      return "release";
    case SeedCause::aim:
      return "aim";
    case SeedCause::probe:
      return "probe";
    case SeedCause::wait:
      return "wait";
  }
  return "";
}

}  // namespace

std::string seeds_csv(const ImplantOutcome& outcome) {
  const Implant implant = implant_of(outcome.history.seeds);
  const bool temporary = implant == Implant::temporary;
  const std::vector<SeedCause> causes = causes_of(implant);
  std::string text = temporary ? "dwell_position,catheter" : "seed,needle";
  const std::vector<const char*> places =
      temporary ? std::vector{"planned", "planning_room", "planning", "delivery_room", "delivery"}
                : std::vector{"planned", "dropped", "rest"};
  for (const char* what : places) text += fmt::format(",{0}_x_mm,{0}_y_mm,{0}_z_mm", what);
  text += temporary ? ",ax,ay,az,dwell_s,error_mm,in_tissue" : ",ax,ay,az,error_mm,lost,in_tissue";
  for (const SeedCause cause : causes) text += fmt::format(",{0}_x_mm,{0}_y_mm,{0}_z_mm", column_of(cause));
  text += "\n";
  for (const SeedHistory& seed : outcome.history.seeds) {
    text += fmt::format("{},{}", seed.number + 1, results::csv_text(outcome.history.needles[seed.needle].name));
    text += fields(seed.planned_mm);
    if (temporary) {
      const DwellAtPlanning then = seed.at_planning.value_or(DwellAtPlanning{});
      text += fields(then.room_mm) + fields(then.tissue_mm);
    }
    text += fields(seed.dropped_mm) + fields(seed.rest_mm) + fields(seed.axis);
    text += temporary ? fmt::format(",{:.4f},{:.4f},{:d}", outcome.planned.plan.sources[seed.number].dwell_s,
                                    seed.error_mm().norm(), seed.in_tissue)
                      : fmt::format(",{:.4f},{:d},{:d}", seed.error_mm().norm(), seed.lost, seed.in_tissue);
    for (const SeedCause cause : causes) text += fields(seed.by(cause));
    text += "\n";
  }
  return text;
}

}  // namespace stylet
