// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/patient/prepared_model.hpp"
#include "stylet/probe/patient_probe.hpp"
#include "stylet/sim/hole_map.hpp"
#include "stylet/sim/recording.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stylet {

/// Settings of insert(). By default it carries out the plans of the scenario and makes no map.
struct InsertSettings {
  bool map = false;                ///< also predict the gland's shift for a needle through each hole of the template
  std::span<const Step> recorded;  ///< steps of a recording whose base motion is repeated; empty: the scenario's plans
  std::string where = "scenario";  ///< name of the scenario in error messages
  std::function<void()> begin;     ///< called once, after the settings have been checked and before the first step
};

/// The result of insert(), beside the files that it wrote.
struct InsertResult {
  Summary summary;                   ///< forces, events, the gland's motion and warnings of the whole run
  std::vector<Step> steps;           ///< all steps, in order of time
  std::optional<HoleMap> map;        ///< only with InsertSettings::map
  std::optional<ProbeReport> probe;  ///< only with a scenario whose probe.kind is not none
};

/// Carries out all insertions of a model and writes the result folder: report, pictures, tables and the recording
/// (docs/results). It takes seconds to minutes.
/// @param folder is created if it is missing; files of an earlier run in it are replaced
/// Errors: a folder that cannot be written; a map for a scenario that cannot have one (check_mappable()); errors of
/// run().
Result<InsertResult> insert(const PreparedModel& prepared, const std::filesystem::path& folder,
                            const InsertSettings& settings = {}, const Progress& progress = {});

}  // namespace stylet
