// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/dvh_table.hpp"

#include "dose/round_number.hpp"
#include "fixed_number.hpp"
#include "output_folder.hpp"
#include "stylet/io/dose_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet {
namespace results {
namespace {

constexpr int kMostSteps = 400;

double step_of(const DoseEvaluation& evaluation) {
  if (evaluation.prescription_Gy > 0.0) return 0.01 * evaluation.prescription_Gy;
  double hottest = 0.0;
  for (const StructureDose& s : evaluation.structures) hottest = std::max(hottest, s.dvh.dose_of_percent(1.0));
  return std::isfinite(hottest) && hottest > 0.0 ? round_above(hottest / kMostSteps) : 1.0;
}

}  // namespace

DvhTable dvh_table(const DoseEvaluation& evaluation) {
  DvhTable table;
  table.percent.resize(evaluation.structures.size());
  const double step = step_of(evaluation);
  for (int k = 0; k <= kMostSteps; ++k) {
    const double dose = k * step;
    double largest = 0.0;
    table.dose_Gy.push_back(dose);
    for (std::size_t s = 0; s < table.percent.size(); ++s) {
      table.percent[s].push_back(evaluation.structures[s].dvh.percent_above(dose));
      largest = std::max(largest, table.percent[s].back());
    }
    if (largest <= 0.0) break;
  }
  return table;
}

DvhTable dvh_at(const DoseEvaluation& evaluation, const std::vector<double>& dose_Gy) {
  DvhTable table{.dose_Gy = dose_Gy, .percent = {}};
  for (const StructureDose& structure : evaluation.structures) {
    std::vector<double>& curve = table.percent.emplace_back();
    for (const double dose : dose_Gy) curve.push_back(structure.dvh.percent_above(dose));
  }
  return table;
}

}  // namespace results

std::string dvh_csv(const DoseEvaluation& evaluation) {
  const results::DvhTable table = results::dvh_table(evaluation);
  std::string csv = "dose_Gy";
  for (const StructureDose& structure : evaluation.structures) csv += "," + results::csv_text(structure.name);
  csv += "\n";
  for (std::size_t k = 0; k < table.dose_Gy.size(); ++k) {
    csv += results::fixed(table.dose_Gy[k], 3);
    for (const std::vector<double>& percent : table.percent) csv += "," + results::fixed(percent[k], 3);
    csv += "\n";
  }
  return csv;
}

}  // namespace stylet
