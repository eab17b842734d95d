// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/dose/dose_evaluation.hpp"

#include <filesystem>
#include <string>

namespace stylet {

/// Writes the result folder of `stylet dose` (docs/results): report.html, dvh.csv, dose.nrrd, plan.dcm,
/// dose.dcm, dose.json. A new folder appears only when it is complete. In an existing folder the files are replaced one
/// by one; dose.json is removed first and written last. Errors: the folder cannot be created or written; a dose grid
/// without points.
Result<> write_dose_results(const DoseEvaluation& evaluation, const std::filesystem::path& folder,
                            const Progress& progress = {});

/// The text of dose.json (docs/results). Numbers that do not exist, such as V100 without a prescription, are null.
std::string dose_json(const DoseEvaluation& evaluation);

/// The text of dvh.csv (docs/results): the dose [Gy] and for each structure the share [%] of its volume that
/// receives at least this dose. The steps are 1 % of the prescribed dose, and at most 400.
std::string dvh_csv(const DoseEvaluation& evaluation);

}  // namespace stylet
