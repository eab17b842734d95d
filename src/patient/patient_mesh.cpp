// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/patient/patient_mesh.hpp"

#include "kept_meshes.hpp"
#include "stylet/core/nearest_name.hpp"
#include "stylet/geom/quality.hpp"
#include "stylet/geom/structure_names.hpp"
#include "stylet/io/input.hpp"
#include "stylet/mesher/structures.hpp"
#include "stylet/patient/patient_file.hpp"
#include "stylet/phantom/phantom.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace stylet {

namespace {

/// Gives regions of a mesh other names. Regions to which the user gives the same name become one.
/// @return sentences for the user about these
Result<std::vector<std::string>> rename_regions(TetMesh& mesh, const std::map<std::string, std::string>& names,
                                                const std::string& where) {
  const std::vector<std::string> in_file = mesh.regions;
  std::set<std::string> asked;  // regions of the file that the user names
  for (const auto& [name, canonical] : names) {
    const auto found = find_region(in_file, name);
    if (found.empty()) {
      const std::string nearest = nearest_name(name, in_file);
      return input_error(where, fmt::format("there is no region '{}'; the mesh has {}", name, fmt::join(in_file, ", ")),
                         nearest.empty() ? "Use one of these names" : fmt::format("Did you mean '{}'?", nearest));
    }
    for (const std::size_t region : found) {
      mesh.regions[region] = region_meant(canonical);
      asked.insert(in_file[region]);
    }
  }
  std::vector<std::string> kept;
  std::vector<int> number;  // (regions of the file) in `kept`
  for (const std::string& region : mesh.regions) {
    const auto before = std::find(kept.begin(), kept.end(), region);
    number.push_back(static_cast<int>(before - kept.begin()));
    if (before == kept.end()) kept.push_back(region);
  }
  for (int& region : mesh.tet_region) region = number[static_cast<std::size_t>(region)];
  std::vector<std::string> notes;
  for (std::size_t r = 0; r < kept.size(); ++r) {
    std::vector<std::string> parts;
    for (std::size_t region = 0; region < in_file.size(); ++region) {
      if (number[region] == static_cast<int>(r)) parts.push_back(fmt::format("'{}'", in_file[region]));
    }
    if (parts.size() < 2) continue;
    for (std::size_t region = 0; region < in_file.size(); ++region) {
      if (number[region] != static_cast<int>(r) || asked.contains(in_file[region])) continue;
      return input_error(where, fmt::format("two regions would be called '{}': {}", kept[r], fmt::join(parts, ", ")),
                         fmt::format("Give each region a different name; to make them one, name '{}', too, in "
                                     "[patient.regions] or with --region",
                                     in_file[region]));
    }
    notes.push_back(fmt::format("The regions {} of the file are one region, '{}'.", fmt::join(parts, ", "), kept[r]));
  }
  mesh.regions = std::move(kept);
  return notes;
}

MeshReport report_as_is(const TetMesh& mesh) {
  MeshReport report;
  report.quality = mesh_quality(mesh);
  for (std::size_t region = 0; region < mesh.regions.size(); ++region) {
    report.regions.push_back({.name = mesh.regions[region],
                              .tets = report.quality.region_tets[region],
                              .volume_cc = report.quality.region_volume_cc[region],
                              .input_volume_cc = report.quality.region_volume_cc[region],
                              .structure_volume_cc = report.quality.region_volume_cc[region]});
  }
  return report;
}

/// Whether a mesh has a target, whose motion is reported: the gland, its zones, a planning volume or an unnamed label.
bool has_target(const TetMesh& mesh) {
  return std::any_of(mesh.regions.begin(), mesh.regions.end(),
                     [](const std::string& r) { return is_target_region(r) || r.starts_with("label_"); });
}

/// Checks, before the mesh is made, that the regions to which a scenario refers can be in it.
/// @param choice of the structures, or of the labels
Result<> check_regions(const StructureChoice& choice, const Scenario& scenario) {
  std::vector<std::string> regions;
  const auto add = [&](const std::string& region) {
    if (!region.empty() && std::find(regions.begin(), regions.end(), region) == regions.end())
      regions.push_back(region);
  };
  for (const StructureUse& use : choice.uses) add(use.region);
  for (const std::string& tissue : known_tissues()) {  // that the mesher adds
    if (is_surrounding(tissue) || tissue == "band" || tissue == "rectal_lumen") add(tissue);
  }
  for (const auto& [name, parameters] : scenario.tissue) {
    if (std::find(regions.begin(), regions.end(), name) != regions.end()) continue;
    const std::string near = nearest_name(name, regions);
    return input_error(fmt::format("tissue.{}", name),
                       fmt::format("the patient has no region '{}' (there are: {})", name, fmt::join(regions, ", ")),
                       fmt::format("{} patient.regions sets the names of structures and labels",
                                   near.empty() ? "Use one of these names;" : fmt::format("Did you mean '{}'?", near)));
  }
  return Ok{};
}

Result<MeshedAnatomy> model_of(const ContourSet& contours, const MeshOptions& options, const Scenario& scenario,
                               const Progress& progress) {
  const Result<StructureChoice> choice = choose_structures(contours, options);
  if (!choice) return choice.error();
  if (Result<> known = check_regions(*choice, scenario); !known) return known.error();
  return mesh_once(contours, options, progress);
}

Result<MeshedAnatomy> model_of(const LabelImage& image, const MeshOptions& options, const Scenario& scenario,
                               const Progress& progress) {
  const Result<StructureChoice> choice = choose_structures(image, options);
  if (!choice) return choice.error();
  if (Result<> known = check_regions(*choice, scenario); !known) return known.error();
  return mesh_once(image, options, progress);
}

Result<MeshedAnatomy> model_of(const TetMesh& mesh, const MeshOptions& options, const Scenario& scenario,
                               const Progress&) {
  if (!options.skip.empty()) {
    return input_error(scenario.patient.source,
                       "patient.skip cannot be used with a tetrahedral mesh, which is always used completely",
                       "Remove patient.skip; use [patient.regions] to rename regions");
  }
  auto out = take_mesh(mesh, options.regions, scenario.patient.source);
  if (out && !has_target(out->mesh)) {
    out->report.notes.push_back(fmt::format(
        "No region of the mesh ({}) is known as the target: no motion of a target is reported, and the template is in "
        "front of the middle of the mesh. Name the region of the prostate in [patient.regions].",
        fmt::join(out->mesh.regions, ", ")));
  }
  return out;
}

Result<MeshedAnatomy> model_of(const std::vector<Surface>& surfaces, const MeshOptions&, const Scenario& scenario,
                               const Progress&) {
  return input_error(scenario.patient.source,
                     fmt::format("the file has {} triangulated surface{}, which cannot be meshed", surfaces.size(),
                                 surfaces.size() == 1 ? "" : "s"),
                     "Give contours, a label mask or a tetrahedral mesh");
}

}  // namespace

Result<MeshedAnatomy> take_mesh(TetMesh mesh, const std::map<std::string, std::string>& names,
                                const std::string& where) {
  const auto notes = rename_regions(mesh, names, where);
  if (!notes) return notes.error();
  MeshReport report = report_as_is(mesh);
  report.notes = *notes;
  return MeshedAnatomy{.mesh = std::move(mesh), .report = std::move(report)};
}

Result<MeshedAnatomy> mesh_patient(const Scenario& scenario, const Progress& progress) {
  MeshOptions options;
  options.preset = scenario.mesh.preset;
  options.nodes = scenario.mesh.nodes;
  options.cull_tolerance_mm = scenario.mesh.cull_mm;
  options.regions = scenario.patient.regions;
  options.skip = scenario.patient.skip;
  options.stiff_band = scenario.mesh.stiff_band;
  options.layers = scenario.anatomy;
  if (scenario.patient.source == "phantom" && scenario.patient.volume > 0)
    return input_error("patient.volume", "the phantom is not a mask with volumes to choose from", "Leave it out");
  if (scenario.patient.source == "phantom" && !scenario.patient.regions_from.empty())
    return input_error("patient.regions_from", "the phantom is not a mesh file with arrays", "Leave it out");
  if (scenario.patient.source == "phantom") return model_of(demo_patient(), options, scenario, progress);
  const Result<PatientFile> file = read_patient(
      scenario.patient.source, {.scale = scenario.patient.scale, .regions_from = scenario.patient.regions_from},
      options, {.volume = scenario.patient.volume});
  if (!file) return file.error();
  auto patient =
      std::visit([&](const auto& content) { return model_of(content, options, scenario, progress); }, file->content);
  if (patient) {
    std::vector<std::string>& notes = patient->report.notes;
    notes.insert(notes.begin(), file->notes.begin(), file->notes.end());
    notes.insert(notes.begin(), file->warnings.begin(), file->warnings.end());
  }
  return patient;
}

}  // namespace stylet
