// SPDX-License-Identifier: GPL-3.0-or-later
#include "early_warnings.hpp"

#include "free_memory.hpp"
#include "stylet/io/model_file.hpp"
#include "stylet/io/scenario_io.hpp"
#include "stylet/sim/plausible.hpp"

#include <fmt/format.h>

namespace stylet::cli {

void warn_before_start(const std::string& file, const std::vector<std::string>& settings, Work work, Console& console) {
  if (is_hdf5_file(file) || is_meant_as_model(file)) return;
  const Result<Scenario> scenario = read_scenario(file, settings);
  if (!scenario) return;
  for (const std::string& warning : warnings_before_start(*scenario)) console.warn_ahead(warning);
  const WorkEstimate estimate = estimate_work(*scenario);
  const bool all = work == Work::all;
  console.tell_with_progress(
      fmt::format("{}{} takes {}, by a rough estimate.", all ? "This" : "Preparing ", all ? "" : file,
                  work_text(all ? estimate.seconds : estimate.preparation_s, estimate.memory_GB)));
  if (const auto free_GB = free_memory_GB(); free_GB && *free_GB < estimate.memory_GB)
    console.warn(
        fmt::format("About {:.1f} GB of memory are needed, and {:.1f} GB are free. Fewer nodes (mesh.nodes) "
                    "need less.",
                    estimate.memory_GB, *free_GB));
}

}  // namespace stylet::cli
