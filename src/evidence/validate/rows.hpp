// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "need.hpp"
#include "stylet/evidence/validate/context.hpp"
#include "stylet/evidence/validate/row.hpp"

#include <vector>

/// One function per file of rows. To add a file of rows, add a function here and a line in rows.cpp and CMakeLists.txt.
namespace stylet::validate {

std::vector<RowSpec> elasticity_rows();
std::vector<RowSpec> node_addition_rows();
std::vector<RowSpec> condensed_system_rows();
std::vector<RowSpec> manufactured_rows();
std::vector<RowSpec> large_motion_rows();
std::vector<RowSpec> locking_rows();
std::vector<RowSpec> needle_theory_rows();
std::vector<RowSpec> needle_line_rows();
std::vector<RowSpec> free_surface_rows();
std::vector<RowSpec> viscosity_rows();
std::vector<RowSpec> insertion_law_rows();
std::vector<RowSpec> closed_loop_rows();
std::vector<RowSpec> step_and_tolerance_rows();
std::vector<RowSpec> insertion_over_meshes_rows();
std::vector<RowSpec> odd_path_rows();
std::vector<RowSpec> other_software_rows();
std::vector<RowSpec> published_force_rows();
std::vector<RowSpec> liver_curve_rows();
std::vector<RowSpec> okamura_recording_rows();
std::vector<RowSpec> tip_tracking_rows();
std::vector<RowSpec> prostate_motion_rows();
std::vector<RowSpec> in_patients_rows();
std::vector<RowSpec> probe_rows();
std::vector<RowSpec> dose_rows();
std::vector<RowSpec> implant_rows();
std::vector<RowSpec> implant_dose_rows();
std::vector<RowSpec> ultrasound_rows();

}  // namespace stylet::validate
