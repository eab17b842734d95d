// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/patient/imaged_patient.hpp"

#include "stylet/geom/displaced.hpp"
#include "stylet/imaging/tissue_role.hpp"
#include "stylet/io/dose_io.hpp"
#include "stylet/io/model_file.hpp"
#include "stylet/io/recorded_moments.hpp"
#include "stylet/io/scenario_io.hpp"
#include "stylet/patient/patient_mesh.hpp"

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

/// Whether a probe moves nothing, because the contours were drawn with it there.
bool is_in_contours(const ProbeSettings& probe, const ProbeSettings& reference) {
  ProbeSettings turned = probe;
  turned.kind = reference.kind;
  turned.roll_deg = reference.roll_deg;  // turning the round probe moves nothing
  turned.step_mm = reference.step_mm;
  turned.in_contours = reference.in_contours;
  return reference.in_contours && turned == reference;
}

/// Prepares the probe of the patient's scenario, if there is one that moves anything.
/// @param reference where the probe was while the contours were drawn, if its in_contours is set
void add_probe(ImagedPatient& patient, const ProbeSettings& reference, const std::string& file,
               const Progress& progress) {
  const ProbeSettings& probe = patient.scenario.probe;
  if (probe.kind == ProbeKind::none || is_in_contours(probe, reference)) return;
  Scenario scenario = patient.scenario;
  scenario.probe = reference;
  scenario.probe.kind = probe.kind;
  auto made = PressingProbe::prepare(scenario, patient.mesh, file, progress);
  if (made) {
    patient.probe = std::make_shared<PressingProbe>(std::move(*made));
    return;
  }
  const Error& why = made.error();
  patient.notes.push_back(
      fmt::format("The probe does not press in this picture: {}: {}. {}.", why.where, why.what, why.cure));
}

Result<ImagedPatient> of_recording(const std::string& file, const std::vector<std::string>& settings,
                                   std::optional<double> time_s, const Progress& progress) {
  if (const auto checked = check_settings(settings, file); !checked) return checked.error();
  Result<RunRecording> recording = read_recording(file);
  if (!recording) return recording.error();
  const std::string where = file + ", /scenario";
  Result<Scenario> recorded = parse_scenario(recording->info.scenario_text, where);
  if (!recorded) return recorded.error();
  if (recording->frames.empty())
    return input_error(file, "the recording has no frame, so the tissue's displacement is not known",
                       "Record with output.frames_per_s above 0");
  const double last = recording->frames.back().time_s;
  if (time_s && (*time_s < 0.0 || *time_s > last))
    return input_error("--time", fmt::format("{:g} s is not in the recording, which ends at {:.3f} s", *time_s, last),
                       fmt::format("Give a time from 0 to {:.3f}", last));
  ImagedPatient patient;
  std::optional<ProbeSettings> probe;
  {
    const RecordedMoments moments(*recording);
    patient.moment = moments.at(time_s.value_or(moments.deepest_s()));
    probe = moments.probe_at(patient.moment.time_s);
  }
  // In a recording the settings move the probe from where it was then; they do not change where it was while the
  // contours were drawn.
  const ProbeSettings planned = recorded->probe;
  if (probe) recorded->probe = *probe;
  Result<Scenario> scenario = parse_scenario(to_toml(*recorded), where, settings);
  if (!scenario) return scenario.error();
  patient.scenario = *std::move(scenario);
  patient.mesh = std::move(recording->mesh);
  describe(patient);
  add_probe(patient, probe ? planned : patient.scenario.probe, file, progress);
  return patient;
}

Result<ImagedPatient> of_model(const std::string& file, const std::vector<std::string>& settings,
                               const Progress& progress) {
  if (const auto checked = check_settings(settings, file); !checked) return checked.error();
  auto model = read_model_file(file, progress);
  if (!model) return model.error();
  auto scenario = parse_scenario(model->scenario_text, file + ", /scenario", settings);
  if (!scenario) return scenario.error();
  ImagedPatient patient;
  patient.scenario = *std::move(scenario);
  patient.mesh = std::move(model->mesh);
  patient.notes = std::move(model->notes);
  return patient;
}

Result<ImagedPatient> of_scenario(const std::string& file, const std::vector<std::string>& settings,
                                  const Progress& progress) {
  Result<Scenario> scenario = read_scenario(file, settings);
  if (!scenario) return scenario.error();
  Result<MeshedAnatomy> anatomy = mesh_patient(*scenario, progress);
  if (!anatomy) return anatomy.error();
  ImagedPatient patient;
  patient.scenario = *std::move(scenario);
  patient.mesh = std::move(anatomy->mesh);
  patient.notes = std::move(anatomy->report.notes);
  return patient;
}

}  // namespace

Result<ImagedPatient> imaged_patient(const std::string& file, const std::vector<std::string>& settings,
                                     std::optional<double> time_s, const Progress& progress) {
  const bool is_model = is_meant_as_model(file);
  if (!is_model && is_hdf5_file(file)) return of_recording(file, settings, time_s, progress);
  if (time_s)
    return input_error("--time", fmt::format("{} is a patient at rest, who has no times", file),
                       "Leave --time out, or give the run.h5 that stylet insert writes");
  Result<ImagedPatient> patient = is_model ? of_model(file, settings, progress) : of_scenario(file, settings, progress);
  if (!patient) return patient;
  patient->moment = moment_at_rest(patient->mesh);
  describe(*patient);
  add_probe(*patient, patient->scenario.probe, file, progress);
  return patient;
}

Moment pressed(const ImagedPatient& patient, const ProbeSettings& settings) {
  Moment moment = patient.moment;
  if (patient.probe) patient.probe->press(settings, moment);
  return moment;
}

Result<> add_planned_seeds(ImagedPatient& patient, const std::string& file) {
  const auto plan = read_plan(file);
  if (!plan) return plan.error();
  if (plan->implant != Implant::permanent)
    return input_error(file, "the plan is a temporary implant, whose source does not stay",
                       "Give a plan of permanent seeds, or leave --seeds out");
  const Topology topology(patient.mesh);
  const Locator locator(patient.mesh, topology);
  std::string last_needle;
  for (const PlannedSource& source : plan->sources) {
    ShownSeed seed{.centre_mm = source.at_mm, .axis = source.axis};
    if (const auto at = locator.find(source.at_mm))
      seed.centre_mm += displacement_of(patient.mesh, patient.moment.displacement, *at);
    join_to_last(patient.moment.seeds,
                 patient.scenario.seed.stranded && !source.needle.empty() && source.needle == last_needle);
    last_needle = source.needle;
    patient.moment.seeds.push_back(seed);
  }
  return Ok{};
}

}  // namespace stylet
