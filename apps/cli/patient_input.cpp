// SPDX-License-Identifier: GPL-3.0-or-later
#include "patient_input.hpp"

namespace stylet::cli {

namespace {

/// Whether mesh_contours() would look at this structure.
bool used(const Roi& roi, const MeshOptions& options) {
  if (roi.contours.empty()) return false;
  if (!options.regions.empty()) return options.regions.contains(roi.name);
  const std::string canonical = canonical_region(roi.name);
  if (options.preset == MeshPreset::paper) return is_target_region(canonical) || canonical == "band";
  return !canonical.empty();
}

}  // namespace

Result<PatientInput> read_patient(const std::filesystem::path& path, const MeshReadOptions& read_options,
                                  const MeshOptions& mesh_options, const MaskReadOptions& mask_options) {
  Result<PatientInput> input = read_input(path, read_options, mask_options);
  if (!input) return input;
  if (const auto* contours = std::get_if<ContourSet>(&*input)) {
    for (const Roi& roi : contours->rois) {
      if (!used(roi, mesh_options)) continue;
      if (const Result<> sound = check_roi(roi, contours->source); !sound) return sound.error();
    }
  }
  return input;
}

}  // namespace stylet::cli
