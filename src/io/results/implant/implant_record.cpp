// SPDX-License-Identifier: GPL-3.0-or-later
// From an implant to its run.h5 and back.
#include "stylet/io/implant_record_io.hpp"

#include "detail/input_file.hpp"
#include "detail/unfinished.hpp"
#include "dose/dvh_table.hpp"
#include "h5_new_file.hpp"
#include "implant/stored_implant.hpp"
#include "reading/ask.hpp"
#include "stylet/core/version.hpp"
#include "stylet/io/scenario_io.hpp"

namespace stylet {

namespace fs = std::filesystem;
using namespace results;

namespace {

RecordedDose recorded_dose(const DoseEvaluation& dose, const std::vector<double>& dose_Gy) {
  return {dose.grid, dose_Gy, dvh_at(dose, dose_Gy).percent};
}

}  // namespace

ImplantRecord implant_record(const ImplantOutcome& outcome) {
  const Scenario& scenario = outcome.scenario;
  ImplantRecord r;
  r.version = version();
  r.scenario_name = scenario.name;
  r.scenario_text = to_toml(scenario);
  r.source = outcome.delivered.source.name;
  r.prescription_Gy = outcome.delivered.prescription_Gy;
  r.needle_diameter_mm = scenario.needle.diameter_mm;
  r.needle_length_mm = scenario.needle.length_mm;
  r.seed_length_mm = outcome.seed_length_mm;
  r.implant = implant_of(outcome.history.seeds);
  r.mesh = outcome.mesh;
  r.needles = outcome.history.needles;
  r.stabilising = outcome.history.stabilising;
  r.seeds = outcome.history.seeds;
  for (const StructureDose& s : outcome.delivered.structures)
    r.structures.push_back({s.name, s.region, s.type, s.colour, s.dvh.volume_cc(), s.contours, s.cloud});
  r.planned = recorded_dose(outcome.planned, dvh_table(outcome.planned).dose_Gy);
  r.delivered = recorded_dose(outcome.delivered, dvh_table(outcome.delivered).dose_Gy);
  r.warnings = outcome.warnings;
  r.summary = implant_json(outcome);
  return r;
}

Result<> write_implant_record(ImplantRecord record, const fs::path& path) {
  auto hidden = detail::Unfinished::create(path, detail::Unfinished::Kind::file);
  if (!hidden) return hidden.error();
  const auto write = [&] { write_stored_implant(hidden->path().c_str(), std::move(record)); };
  if (auto done = h5::written(path, write); !done) return done;
  return hidden->finish();
}

Result<ImplantRecord> read_implant_record(const fs::path& path) {
  if (Result<> readable = detail::check_input_file(path); !readable)
    return input_error(path.string(), readable.error().what, kGiveAnImplant);
  Result<ImplantRecord> record = detail::ask(kImplantFile, path);
  if (!record) return record;
  if (auto sound = check_mesh(record->mesh, path.string() + ", /mesh"); !sound) return sound.error();
  return record;
}

bool is_implant_record(const fs::path& path) {
  if (!detail::check_input_file(path)) return false;
  const Result<bool> is = detail::ask(kIsImplantFile, path);
  return is && *is;
}

}  // namespace stylet
