// SPDX-License-Identifier: GPL-3.0-or-later
#include "describe.hpp"
#include "table.hpp"

#include "stylet/io/scenario_io.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet::cli {

Description describe(const ModelFile& file) {
  const Result<Scenario> scenario = parse_scenario(file.scenario_text, "scenario");
  const std::string name = scenario ? scenario->name : "";
  const double store_mb = static_cast<double>(file.compliance.store.size()) * sizeof(double) / 1048576.0;
  const auto recorded =
      std::count_if(file.motions.begin(), file.motions.end(), [](const auto& motion) { return !motion.empty(); });

  Description out;
  out.json = {{"kind", "model"},
              {"version", file.version},
              {"scenario", name},
              {"nodes", file.mesh.node_count()},
              {"tets", file.mesh.tet_count()},
              {"regions", file.mesh.regions},
              {"element", file.element},
              {"insertions", file.motions.size()},
              {"recorded_motions", recorded},
              {"corridor_nodes", file.corridor.size()},
              {"compliance_mb", store_mb},
              {"notes", file.notes}};
  Facts facts;
  facts.add("kind", "saved model");
  facts.add("made by", "stylet " + file.version);
  facts.add("scenario", name);
  facts.add("mesh", fmt::format("{} nodes, {} tetrahedra, {}", file.mesh.node_count(), file.mesh.tet_count(),
                                fmt::join(file.mesh.regions, ", ")));
  facts.add("element", file.element);
  facts.add("insertions", fmt::format("{}, {} of them with a recorded motion", file.motions.size(), recorded));
  facts.add("compliance", fmt::format("{} nodes, {:.0f} MB in memory", file.corridor.size(), store_mb));
  out.text = facts.text();
  for (const std::string& note : file.notes) out.text += "\n  note: " + note;
  return out;
}

}  // namespace stylet::cli
