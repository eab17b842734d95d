// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/io/dose_results.hpp"

#include "dose/dose_bytes.hpp"
#include "dose/dose_page.hpp"
#include "output_folder.hpp"
#include "stylet/core/survive.hpp"

#include <fmt/format.h>

#include <exception>
#include <functional>
#include <utility>
#include <vector>

namespace stylet {
namespace fs = std::filesystem;

namespace {

/// DICOM's units of dose know no rate.
bool has_dicom_dose(const DoseEvaluation& e) { return e.quantity.find("rate") == std::string::npos; }

/// plan.dcm, dose.dcm and dose.nrrd. Both DICOM files have one patient, study and frame of reference.
Result<std::vector<results::File>> files_of_grid_and_plan(const DoseEvaluation& e, const fs::path& folder) {
  const DoseGrid& grid = e.grid;
  DosePlan plan = e.plan;
  plan.prescription_Gy = e.prescription_Gy;
  const PatientRecord patient = record_of_files(e.patient, plan, e.source);
  const std::string uid = rtplan_uid(plan, e.source, patient);
  using Bytes = std::function<Result<std::string>(const std::string& where)>;
  const std::vector<std::pair<std::string, Bytes>> makers{
      {"plan.dcm", [&](const std::string& where) { return rtplan_bytes(plan, e.source, where, patient); }},
      {"dose.dcm", [&](const std::string& where) { return rtdose_bytes(grid, uid, where, patient, e.quantity); }},
      {"dose.nrrd", [&](const std::string& where) { return dose_nrrd_bytes(grid, where); }}};
  std::vector<results::File> files;
  for (const auto& [name, make] : makers) {
    if (name == "dose.dcm" && !has_dicom_dose(e)) continue;
    auto bytes = make((folder / name).string());
    if (!bytes) return bytes.error();
    files.push_back({name, std::move(*bytes)});
  }
  return files;
}

Result<> write_all_results(const DoseEvaluation& evaluation, const fs::path& folder, const Progress& progress) {
  report(progress, "dose grid", 0.0);
  auto files = files_of_grid_and_plan(evaluation, folder);
  if (!files) return files.error();
  report(progress, "report", 0.0);
  auto page = results::dose_page(evaluation);
  if (!page) return page.error();
  files->push_back({"report.html", std::move(*page)});
  files->push_back({"dvh.csv", dvh_csv(evaluation)});
  files->push_back({"dose.json", dose_json(evaluation)});
  std::error_code code;
  if (!has_dicom_dose(evaluation)) fs::remove(folder / "dose.dcm", code);  // that of an earlier run
  auto done = results::write_folder(*files, folder);
  if (done) report(progress, "report", 1.0);
  return done;
}

}  // namespace

Result<> write_dose_results(const DoseEvaluation& evaluation, const fs::path& folder, const Progress& progress) {
  try {
    return write_all_results(evaluation, folder, progress);
  } catch (const std::exception&) {
    return failure(folder.string(), fmt::format("cannot be written: {}", caught_exception("").what),
                   "Close other programs or use a coarser dose grid, then run again");
  }
}

}  // namespace stylet
