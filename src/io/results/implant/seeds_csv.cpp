// SPDX-License-Identifier: GPL-3.0-or-later
#include "output_folder.hpp"
#include "stylet/io/implant_results.hpp"

#include <fmt/format.h>

namespace stylet {
namespace {

/// Three numbers with leading commas.
std::string fields(const Vec3& v) { return fmt::format(",{:.4f},{:.4f},{:.4f}", v.x(), v.y(), v.z()); }

}  // namespace

std::string seeds_csv(const ImplantOutcome& outcome) {
  std::string text = "seed,needle";
  for (const char* what : {"planned", "dropped", "rest"}) text += fmt::format(",{0}_x_mm,{0}_y_mm,{0}_z_mm", what);
  text += ",ax,ay,az,error_mm,lost,in_tissue";
  for (const char* cause : {"bend", "motion", "relaxation", "strand", "release", "aim"})
    text += fmt::format(",{0}_x_mm,{0}_y_mm,{0}_z_mm", cause);
  text += "\n";
  for (const SeedHistory& seed : outcome.history.seeds) {
    text += fmt::format("{},{}", seed.number + 1, results::csv_text(outcome.history.needles[seed.needle].name));
    text += fields(seed.planned_mm) + fields(seed.dropped_mm) + fields(seed.rest_mm) + fields(seed.axis);
    text += fmt::format(",{:.4f},{:d},{:d}", seed.error_mm().norm(), seed.lost, seed.in_tissue);
    for (const Vec3& cause : seed.cause_mm) text += fields(cause);
    text += "\n";
  }
  return text;
}

}  // namespace stylet
