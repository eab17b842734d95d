// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the result folder of an invented implant, for work on the report of stylet dose:
//   synthetic_dose_report OUT/ [temporary]
#include "stylet/io/dose_results.hpp"
#include "synthetic_dose.hpp"

#include <cstdio>
#include <string_view>

namespace {

/// The other kinds of what a page can show: a temporary implant without prescription and goals, a structure of points.
stylet::DoseEvaluation as_temporary(stylet::DoseEvaluation e) {
  e.plan.implant = stylet::Implant::temporary;
  e.plan.label.clear();
  e.prescription_Gy = 0.0;
  e.goals.clear();
  e.points.clear();
  e.comparison.reset();
  e.warnings.clear();
  for (std::size_t k = 0; k < e.plan.sources.size(); ++k) e.plan.sources[k].dwell_s = 0.5 * static_cast<double>(k % 20);
  stylet::StructureDose& rectum = e.structures.back();
  for (const stylet::Contour& contour : rectum.contours)
    rectum.cloud.insert(rectum.cloud.end(), contour.points.begin(), contour.points.end());
  rectum.contours.clear();
  return e;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: synthetic_dose_report OUT/ [temporary]\n");
    return 2;
  }
  stylet::DoseEvaluation evaluation = stylet::testing::synthetic_dose(1.0, 0.5);
  if (argc > 2 && std::string_view(argv[2]) == "temporary") evaluation = as_temporary(std::move(evaluation));
  const auto done = stylet::write_dose_results(evaluation, argv[1]);
  if (!done) std::fprintf(stderr, "%s\n", done.error().message().c_str());
  return done ? 0 : 1;
}
