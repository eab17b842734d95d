// SPDX-License-Identifier: GPL-3.0-or-later
#include "imaged_case.hpp"

#include "stylet/geom/locator.hpp"
#include "stylet/io/dose_io.hpp"
#include "stylet/io/model_file.hpp"
#include "stylet/io/scenario_io.hpp"
#include "stylet/patient/patient_mesh.hpp"
#include "stylet/patient/recorded_moment.hpp"

#include <fmt/format.h>

namespace stylet::cli {

namespace {

Result<ImagedCase> recorded_case(const std::string& file, const std::vector<std::string>& settings) {
  if (const auto checked = check_settings(settings, file); !checked) return checked.error();
  auto recording = read_recording(file);
  if (!recording) return recording.error();
  auto scenario = parse_scenario(recording->info.scenario_text, file + ", /scenario", settings);
  if (!scenario) return scenario.error();
  return ImagedCase{
      .file = file, .scenario = std::move(*scenario), .patient = {}, .recording = std::move(*recording), .notes = {}};
}

Result<ImagedCase> saved_case(const std::string& file, const std::vector<std::string>& settings,
                              const Progress& progress) {
  if (const auto checked = check_settings(settings, file); !checked) return checked.error();
  auto model = read_model_file(file, progress);
  if (!model) return model.error();
  auto scenario = parse_scenario(model->scenario_text, file + ", /scenario", settings);
  if (!scenario) return scenario.error();
  return ImagedCase{.file = file,
                    .scenario = std::move(*scenario),
                    .patient = std::move(model->mesh),
                    .recording = {},
                    .notes = std::move(model->notes)};
}

}  // namespace

Result<ImagedCase> open_imaged_case(const std::string& file, const std::vector<std::string>& settings,
                                    const Progress& progress) {
  if (is_meant_as_model(file)) return saved_case(file, settings, progress);
  if (is_hdf5_file(file)) return recorded_case(file, settings);
  auto scenario = read_scenario(file, settings);
  if (!scenario) return scenario.error();
  auto patient = mesh_patient(*scenario, progress);
  if (!patient) return patient.error();
  return ImagedCase{.file = file,
                    .scenario = std::move(*scenario),
                    .patient = std::move(patient->mesh),
                    .recording = {},
                    .notes = std::move(patient->report.notes)};
}

Result<Moment> imaged_moment(const ImagedCase& imaged, std::optional<double> time_s) {
  if (!imaged.recording) {
    if (!time_s) return moment_at_rest(imaged.mesh());
    return input_error("--time", fmt::format("{} is a patient at rest, who has no times", imaged.file),
                       "Leave --time out, or give the run.h5 that stylet insert writes");
  }
  const auto& frames = imaged.recording->frames;
  const double end_s = frames.empty() ? 0.0 : frames.back().time_s;
  if (time_s && !(*time_s >= 0.0 && *time_s <= end_s))
    return input_error("--time", fmt::format("{:g} s is not in the recording, which ends at {:g} s", *time_s, end_s),
                       fmt::format("Give a time from 0 to {:g} s", end_s));
  Moment moment = recorded_moment(*imaged.recording, time_s.value_or(deepest_time_s(*imaged.recording)));
  // Without a lumen in the scenario a needle has the proportions of one of 18 gauge, which are ShownNeedle's defaults.
  const ShownNeedle gauge_18;
  const double lumen_of_diameter = gauge_18.lumen_diameter_mm / gauge_18.diameter_mm;
  for (ShownNeedle& needle : moment.needles)
    needle.lumen_diameter_mm =
        imaged.scenario.needle.lumen_diameter_mm.value_or(lumen_of_diameter * needle.diameter_mm);
  return moment;
}

Result<> add_planned_seeds(const ImagedCase& imaged, const std::string& file, Moment& moment) {
  const auto plan = read_plan(file);
  if (!plan) return plan.error();
  if (plan->implant != Implant::permanent)
    return input_error(file, "the plan is a temporary implant, whose source does not stay",
                       "Give a plan of permanent seeds, or leave --seeds out");
  const Topology topology(imaged.mesh());
  const Locator locator(imaged.mesh(), topology);
  for (const PlannedSource& source : plan->sources) {
    ShownSeed seed{.centre_mm = source.at_mm, .axis = source.axis};
    if (const auto at = locator.find(source.at_mm)) {
      const auto& corners = imaged.mesh().tets[static_cast<std::size_t>(at->tet)];
      for (std::size_t k = 0; k < corners.size(); ++k)
        seed.centre_mm +=
            at->weights[static_cast<Eigen::Index>(k)] * moment.displacement.col(corners[k]).cast<double>();
    }
    moment.seeds.push_back(seed);
  }
  return Ok{};
}

}  // namespace stylet::cli
