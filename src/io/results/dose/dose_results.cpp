// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/io/dose_results.hpp"

#include "dose/dose_page.hpp"
#include "output_folder.hpp"
#include "stylet/core/survive.hpp"
#include "stylet/io/dose_io.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <exception>
#include <fstream>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

namespace stylet {
namespace fs = std::filesystem;

namespace {

/// The bytes of a file whose writer needs a path: it is written under a hidden name beside the results, and removed.
Result<std::string> bytes_of(const std::string& name, const fs::path& beside,
                             const std::function<Result<>(const fs::path&)>& write) {
  const fs::path hidden = beside / fmt::format(".{}.{}", ::getpid(), name);
  std::error_code ignored;
  if (auto done = write(hidden); !done) {
    fs::remove(hidden, ignored);
    return done.error();
  }
  std::ifstream file(hidden, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const bool whole = file.good() || file.eof();
  fs::remove(hidden, ignored);
  if (!whole || bytes.empty()) return results::write_error(hidden, "it could not be read again");
  return bytes;
}

/// DICOM's units of dose know no rate.
bool has_dicom_dose(const DoseEvaluation& e) { return e.quantity.find("rate") == std::string::npos; }

/// plan.dcm, dose.dcm and dose.nrrd. Both DICOM files have one patient, study and frame of reference.
Result<std::vector<results::File>> files_of_grid_and_plan(const DoseEvaluation& e, const fs::path& beside) {
  const DoseGrid& grid = e.grid;
  DosePlan plan = e.plan;
  plan.prescription_Gy = e.prescription_Gy;
  const PatientRecord patient = record_of_files(e.patient, plan, e.source);
  const std::string uid = rtplan_uid(plan, e.source, patient);
  const std::vector<std::pair<std::string, std::function<Result<>(const fs::path&)>>> writers{
      {"plan.dcm", [&](const fs::path& path) { return write_rtplan(plan, e.source, path, patient); }},
      {"dose.dcm", [&](const fs::path& path) { return write_rtdose(grid, uid, path, patient, e.quantity); }},
      {"dose.nrrd", [&](const fs::path& path) { return write_dose_nrrd(grid, path); }}};
  std::vector<results::File> files;
  for (const auto& [name, write] : writers) {
    if (name == "dose.dcm" && !has_dicom_dose(e)) continue;
    auto bytes = bytes_of(name, beside, write);
    if (!bytes) return bytes.error();
    files.push_back({name, std::move(*bytes)});
  }
  return files;
}

Result<> write_all_results(const DoseEvaluation& evaluation, const fs::path& folder, const Progress& progress) {
  const fs::path place = folder.has_filename() ? folder : folder.parent_path();
  std::error_code code;
  const fs::path beside = fs::exists(place, code)   ? place
                          : place.has_parent_path() ? place.parent_path()
                                                    : fs::path(".");
  if (auto ready = results::prepare_folder(beside); !ready) return ready;
  report(progress, "dose grid", 0.0);
  auto files = files_of_grid_and_plan(evaluation, beside);
  if (!files) return files.error();
  report(progress, "report", 0.0);
  auto page = results::dose_page(evaluation);
  if (!page) return page.error();
  files->push_back({"report.html", std::move(*page)});
  files->push_back({"dvh.csv", dvh_csv(evaluation)});
  files->push_back({"dose.json", dose_json(evaluation)});
  if (!has_dicom_dose(evaluation)) fs::remove(place / "dose.dcm", code);  // that of an earlier run
  auto done = results::write_folder(*files, place);
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
