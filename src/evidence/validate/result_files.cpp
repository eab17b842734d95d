// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/results/output_folder.hpp"
#include "validation_data.hpp"

#include <fmt/format.h>

namespace stylet::validate {

using results::csv_text;

namespace {

/// One line per point, curve by curve, because the curves of a row may have different abscissae.
std::string curves_csv(const Plot& plot) {
  std::string csv = fmt::format("curve,{},{}\n", csv_text(plot.x_label), csv_text(plot.y_label));
  for (const Curve& curve : plot.curves) {
    const std::string label = csv_text(curve.label);
    for (std::size_t i = 0; i < curve.x.size(); ++i)
      csv += fmt::format("{},{:.9g},{:.9g}\n", label, curve.x[i], curve.y[i]);
  }
  return csv;
}

std::string sensitivity_csv(const Sensitivity& study) {
  std::string csv =
      "key,unit,base,low,high,peak_axial_N_base,peak_axial_N_low,peak_axial_N_high,target_shift_mm_base,"
      "target_shift_mm_low,target_shift_mm_high,tip_deflection_mm_base,tip_deflection_mm_low,tip_deflection_mm_high,"
      "note\n";
  for (const Influence& i : study.influences) {
    const auto three = [&](double Outputs::*output) {
      const std::string high = i.high.empty() ? std::string() : fmt::format("{:.9g}", i.at_high.*output);
      return fmt::format("{:.9g},{:.9g},{}", study.base.*output, i.at_low.*output, high);
    };
    csv += fmt::format("{},{},{},{},{},{},{},{},{}\n", csv_text(i.key), csv_text(i.unit), csv_text(i.base),
                       csv_text(i.low), csv_text(i.high), three(&Outputs::peak_axial_N),
                       three(&Outputs::target_shift_mm), three(&Outputs::tip_deflection_mm), csv_text(i.note));
  }
  return csv;
}

}  // namespace

Result<> write_validation(const Validation& validation, const std::filesystem::path& folder) {
  Result<std::string> page = validation_page(validation);
  if (!page) return page.error();
  std::vector<results::File> files{{"validate.html", std::move(*page)}};
  for (const Row& row : validation.rows) {
    if (!row.finding.plot.curves.empty()) files.push_back({curve_file(row), curves_csv(row.finding.plot)});
  }
  if (validation.sensitivity) files.push_back({"sensitivity.csv", sensitivity_csv(*validation.sensitivity)});
  files.push_back({"validate.json", validation_json(validation)});
  return results::write_folder(files, folder);
}

}  // namespace stylet::validate
