// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/dose/dose_plan.hpp"
#include "stylet/implant/found_seed.hpp"

#include <filesystem>

namespace stylet {

/// Reads the seeds that were found on images after an implant: CSV with the columns x_mm, y_mm, z_mm and, if known, ax,
/// ay, az (docs/formats.md), or the plan (DICOM RTPLAN, plan JSON) of a program that finds seeds. Places are [mm] LPS
/// in the frame of the plan. Strengths and names of needles are not used. Errors: no such file; another kind of file;
/// columns that are missing or not known; a field that is not a finite number; an axis without length; no seeds; the
/// plan of a temporary implant. Messages name file, line and value.
Result<FoundSeeds> read_found_seeds(const std::filesystem::path& path);

/// Checks that seeds which were found can be those of a plan. Errors: half of them or more lie further than 30 mm from
/// every planned seed, so that they are those of another patient or frame; one lies further than a metre from every
/// planned seed, which is no place in a patient; more than twice as many as were planned.
Result<> check_found_seeds(const FoundSeeds& found, const DosePlan& plan);

}  // namespace stylet
