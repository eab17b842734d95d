// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/patient/imaged_patient.hpp"

#include "stylet/imaging/tissue_role.hpp"
#include "stylet/io/model_file.hpp"
#include "stylet/io/scenario_io.hpp"
#include "stylet/patient/patient_mesh.hpp"
#include "stylet/patient/recorded_moment.hpp"

#include <fmt/format.h>

namespace stylet {

namespace {

void describe(ImagedPatient& patient) {
  for (std::size_t r = 0; r < patient.mesh.regions.size(); ++r) {
    const std::string& region = patient.mesh.regions[r];
    patient.echoes.push_back(tissue_of(patient.scenario, region).echo);
    if (is_gland(tissue_role(region))) patient.gland_regions.push_back(static_cast<int>(r));
  }
}

Result<ImagedPatient> of_recording(const std::string& file, const std::vector<std::string>& settings,
                                   std::optional<double> time_s) {
  Result<RunRecording> recording = read_recording(file);
  if (!recording) return recording.error();
  Result<Scenario> scenario = parse_scenario(recording->info.scenario_text, file + ", /scenario", settings);
  if (!scenario) return scenario.error();
  if (recording->frames.empty())
    return input_error(file, "the recording has no frame, so the tissue's displacement is not known",
                       "Record with output.frames_per_s above 0");
  const double last = recording->frames.back().time_s;
  if (time_s && (*time_s < 0.0 || *time_s > last))
    return input_error("--time", fmt::format("{:g} s is not in the recording, which ends at {:.3f} s", *time_s, last),
                       fmt::format("Give a time from 0 to {:.3f}", last));
  ImagedPatient patient;
  patient.moment = recorded_moment(*recording, time_s.value_or(deepest_time_s(*recording)));
  patient.scenario = *std::move(scenario);
  patient.mesh = std::move(recording->mesh);
  describe(patient);
  return patient;
}

}  // namespace

Result<ImagedPatient> imaged_patient(const std::string& file, const std::vector<std::string>& settings,
                                     std::optional<double> time_s, const Progress& progress) {
  if (is_hdf5_file(file)) return of_recording(file, settings, time_s);
  if (time_s)
    return input_error("--time", fmt::format("{} is a scenario, which has no time", file),
                       "Leave --time out, or give the run.h5 of a run");
  Result<Scenario> scenario = read_scenario(file, settings);
  if (!scenario) return scenario.error();
  Result<MeshedAnatomy> anatomy = mesh_patient(*scenario, progress);
  if (!anatomy) return anatomy.error();
  ImagedPatient patient;
  patient.scenario = *std::move(scenario);
  patient.mesh = std::move(anatomy->mesh);
  patient.notes = std::move(anatomy->report.notes);
  patient.moment = moment_at_rest(patient.mesh);
  describe(patient);
  return patient;
}

}  // namespace stylet
