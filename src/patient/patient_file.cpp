// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/patient/patient_file.hpp"

#include "stylet/core/nearest_name.hpp"
#include "stylet/geom/structure_names.hpp"
#include "stylet/patient/fit.hpp"
#include "stylet/patient/judged_contours.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace stylet {

namespace {

Result<> drop_skipped(std::vector<Surface>& surfaces, const std::vector<std::string>& skip, const std::string& where) {
  std::vector<std::string> names;
  for (const Surface& surface : surfaces) names.push_back(surface.name);
  std::vector<bool> drop(surfaces.size(), false);
  for (const std::string& word : skip) {
    const auto found = find_named(names, word);
    if (found.empty()) {
      const std::string near = nearest_name(word, names);
      return input_error(where, fmt::format("patient.skip: there is no surface '{}'; the file has {}", word, names),
                         near.empty() ? "Use one of these names" : fmt::format("Did you mean '{}'?", near));
    }
    for (const std::size_t i : found) drop[i] = true;
  }
  std::vector<Surface> kept;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (!drop[i]) kept.push_back(std::move(surfaces[i]));
  }
  surfaces = std::move(kept);
  return Ok{};
}

}  // namespace

Result<PatientFile> read_patient(const std::filesystem::path& path, const MeshReadOptions& read_options,
                                 const MeshOptions& mesh_options, const MaskReadOptions& mask_options) {
  PatientFile file;
  MeshReadOptions with_notes = read_options;
  with_notes.notes = &file.notes;
  Result<PatientInput> input = read_input(path, with_notes, mask_options, mesh_options.skip);
  if (!input) return input.error();
  file.content = std::move(*input);
  if (const auto* contours = std::get_if<ContourSet>(&file.content)) {
    const auto judged = judge_contours(*contours, mesh_options);
    if (!judged) return judged.error();
    if (const Error* fault = judged->fault()) return *fault;
    for (std::string& note : judged->oddities()) file.notes.push_back(std::move(note));
  }
  if (auto* surfaces = std::get_if<std::vector<Surface>>(&file.content)) {
    if (Result<> done = drop_skipped(*surfaces, mesh_options.skip, path.string()); !done) return done.error();
  }
  const auto findings = judge_fit(file.content, {.names = mesh_options, .scale = read_options.scale});
  if (const auto refused = refusal(findings, path.string())) return *refused;
  for (const FitFinding& finding : findings)
    (finding.verdict == FitVerdict::note ? file.notes : file.warnings).push_back(finding.message());
  return file;
}

}  // namespace stylet
