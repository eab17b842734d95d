// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/dose_text.hpp"

#include "fixed_number.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

namespace stylet::results {

std::string gray(double dose_Gy) {
  if (!std::isfinite(dose_Gy)) return "–";
  return fixed(dose_Gy, std::abs(dose_Gy) < 99.95 ? 1 : 0) + "&nbsp;Gy";
}

std::string percent(double value) { return fixed(value, 1) + "&nbsp;%"; }

std::string small_share(double dose_Gy, double of_Gy) {
  return of_Gy > 0.0 && std::isfinite(dose_Gy) ? "<small>" + fixed(100.0 * dose_Gy / of_Gy, 0) + "&nbsp;%</small>"
                                               : std::string();
}

std::string plan_line(const DoseEvaluation& evaluation) {
  const DosePlan& plan = evaluation.plan;
  const bool permanent = plan.implant == Implant::permanent;
  std::string facts = fmt::format("{} implant, {} {}, {}", permanent ? "permanent" : "temporary", plan.sources.size(),
                                  permanent ? "seeds" : "dwell positions", evaluation.source.title);
  if (evaluation.prescription_Gy > 0.0) facts += fmt::format(", {:g} Gy prescribed", evaluation.prescription_Gy);
  const std::string name = std::filesystem::path(plan.file).filename().string();
  return name.empty() || plan.label.empty() ? facts : name + ": " + facts;
}

}  // namespace stylet::results
