// SPDX-License-Identifier: GPL-3.0-or-later
#include "patient_model.hpp"

#include "mesh_report.hpp"
#include "patient_input.hpp"

#include "stylet/core/nearest_name.hpp"
#include "stylet/io/input.hpp"
#include "stylet/phantom/phantom.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet::cli {

Result<> rename_regions(TetMesh& mesh, const std::map<std::string, std::string>& names, const std::string& where) {
  for (const auto& [name, canonical] : names) {
    const int region = mesh.region_index(name);
    if (region < 0) {
      const std::string nearest = nearest_name(name, mesh.regions);
      return input_error(where,
                         fmt::format("there is no region '{}'; the mesh has {}", name, fmt::join(mesh.regions, ", ")),
                         nearest.empty() ? "Name one of these" : fmt::format("Did you mean '{}'?", nearest));
    }
    const std::string known = canonical_region(canonical);
    mesh.regions[static_cast<std::size_t>(region)] = known.empty() ? canonical : known;
  }
  for (auto region = mesh.regions.begin(); region != mesh.regions.end(); ++region) {
    if (std::find(mesh.regions.begin(), region, *region) != region) {
      return input_error(where, fmt::format("two regions would be called '{}'", *region),
                         "Give every region a name of its own");
    }
  }
  return Ok{};
}

namespace {

Result<MeshedAnatomy> model_of(const ContourSet& contours, const MeshOptions& options, const Scenario&,
                               const Progress& progress) {
  return mesh_contours(contours, options, progress);
}

Result<MeshedAnatomy> model_of(const LabelImage& image, const MeshOptions& options, const Scenario&,
                               const Progress& progress) {
  return mesh_labels(image, options, progress);
}

Result<MeshedAnatomy> model_of(const TetMesh& mesh, const MeshOptions& options, const Scenario& scenario,
                               const Progress&) {
  MeshedAnatomy out{.mesh = mesh, .report = {}};
  if (Result<> named = rename_regions(out.mesh, options.regions, scenario.patient.source); !named) return named.error();
  out.report = report_as_is(out.mesh);
  return out;
}

Result<MeshedAnatomy> model_of(const std::vector<Surface>& surfaces, const MeshOptions&, const Scenario& scenario,
                               const Progress&) {
  return input_error(scenario.patient.source,
                     fmt::format("{} triangulated surfaces; surfaces are not meshed", surfaces.size()),
                     "Give contours, a label mask or a tetrahedral mesh");
}

}  // namespace

Result<MeshedAnatomy> patient_model(const Scenario& scenario, const std::string&, const Progress& progress) {
  MeshOptions options;
  options.preset = scenario.mesh.preset == "paper" ? MeshPreset::paper : MeshPreset::standard;
  options.nodes = scenario.mesh.nodes;
  options.cull_tolerance_mm = scenario.mesh.cull_mm;
  options.regions = scenario.patient.regions;
  options.stiff_band = scenario.mesh.stiff_band;
  if (scenario.patient.source == "phantom") return mesh_contours(demo_patient(), options, progress);
  std::vector<std::string> remarks;
  const Result<PatientInput> input =
      read_patient(scenario.patient.source, {.scale = scenario.patient.scale, .notes = &remarks}, options,
                   {.volume = scenario.patient.volume});
  if (!input) return input.error();
  Result<MeshedAnatomy> model =
      std::visit([&](const auto& content) { return model_of(content, options, scenario, progress); }, *input);
  if (model) model->report.notes.insert(model->report.notes.end(), remarks.begin(), remarks.end());
  return model;
}

}  // namespace stylet::cli
