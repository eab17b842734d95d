// SPDX-License-Identifier: GPL-3.0-or-later
#include "rows.hpp"

#include "stylet/evidence/validate/validation.hpp"

#include <algorithm>

namespace stylet::validate {

namespace {

std::vector<RowSpec> collect() {
  std::vector<RowSpec> rows;
  for (const auto& more : {elasticity_rows(),
                           manufactured_rows(),
                           locking_rows(),
                           node_addition_rows(),
                           condensed_system_rows(),
                           needle_line_rows(),
                           free_surface_rows(),
                           viscosity_rows(),
                           needle_theory_rows(),
                           insertion_law_rows(),
                           closed_loop_rows(),
                           insertion_over_meshes_rows(),
                           step_and_tolerance_rows(),
                           odd_path_rows(),
                           other_software_rows(),
                           large_motion_rows(),
                           published_force_rows(),
                           liver_curve_rows(),
                           okamura_recording_rows(),
                           tip_tracking_rows(),
                           prostate_motion_rows(),
                           in_patients_rows(),
                           probe_rows(),
                           dose_rows(),
                           implant_rows(),
                           implant_dose_rows(),
                           ultrasound_rows()})
    rows.insert(rows.end(), more.begin(), more.end());
  std::stable_sort(rows.begin(), rows.end(), [](const RowSpec& a, const RowSpec& b) { return a.group < b.group; });
  return rows;
}

}  // namespace

const std::vector<RowSpec>& all_rows() {
  static const std::vector<RowSpec> rows = collect();
  return rows;
}

}  // namespace stylet::validate
