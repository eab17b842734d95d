// SPDX-License-Identifier: GPL-3.0-or-later
#include "early_warnings.hpp"

#include "stylet/io/model_file.hpp"
#include "stylet/io/scenario_io.hpp"
#include "stylet/sim/plausible.hpp"

namespace stylet::cli {

void warn_before_start(const std::string& file, const std::vector<std::string>& settings, Console& console) {
  if (is_hdf5_file(file) || is_meant_as_model(file)) return;
  const Result<Scenario> scenario = read_scenario(file, settings);
  if (!scenario) return;
  for (const std::string& warning : warnings_before_start(*scenario)) console.warn_ahead(warning);
}

}  // namespace stylet::cli
