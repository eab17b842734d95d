// SPDX-License-Identifier: GPL-3.0-or-later
// Description of the run.h5 of an implant.
#include "describe.hpp"
#include "table.hpp"

#include "stylet/implant/seed_errors.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stylet::cli {

namespace {

Json vector_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

std::string needles_of_implant(const ImplantRecord& record) {
  const bool dwells = record.implant == Implant::temporary;
  Table table({dwells ? "catheter" : "needle", dwells ? "dwell positions" : "seeds", "depth mm", "peak force N",
               "deflection mm", "steps", "events"});
  const auto row = [&](const NeedleHistory& needle, std::size_t seeds) {
    table.row({needle.name, fmt::to_string(seeds), fmt::format("{:.1f}", needle.depth_mm),
               fmt::format("{:.2f}", needle.peak_force_N), fmt::format("{:.2f}", needle.deflection_mm),
               fmt::to_string(needle.record.steps.size()), fmt::to_string(needle.events.size())});
  };
  std::vector<std::size_t> seeds(record.needles.size(), 0);
  for (const SeedHistory& seed : record.seeds) ++seeds[seed.needle];
  for (const NeedleHistory& needle : record.stabilising) row(needle, 0);
  for (std::size_t k = 0; k < record.needles.size(); ++k) row(record.needles[k], seeds[k]);
  return table.text();
}

std::string seeds_of_implant(const ImplantRecord& record) {
  const bool dwells = record.implant == Implant::temporary;
  Table table({dwells ? "dwell position" : "seed", dwells ? "catheter" : "needle", "error mm", "left mm",
               "posterior mm", "superior mm", ""});
  for (const SeedHistory& seed : record.seeds) {
    const Vec3 error = seed.error_mm();
    table.row({fmt::to_string(seed.number + 1), record.needles[seed.needle].name, fmt::format("{:.2f}", error.norm()),
               fmt::format("{:.2f}", error.x()), fmt::format("{:.2f}", error.y()), fmt::format("{:.2f}", error.z()),
               seed.lost         ? "lost"
               : !seed.in_tissue ? (dwells ? "not in tissue" : "not dropped in tissue")
                                 : ""});
  }
  return table.text();
}

std::string mean_error_in_words(const SeedErrors& errors) {
  if (errors.seeds == 0) return "(all seeds are lost)";
  const auto axis = [&](std::size_t k) {
    return fmt::format("{:.2f} ± {:.2f}", errors.axes[k].mean_mm, errors.axes[k].sd_mm);
  };
  return fmt::format("mean {:.2f} mm, 95 % within {:.2f} mm, largest {:.2f} mm; left {}, posterior {}, superior {} mm",
                     errors.mean_mm, errors.p95_mm, errors.largest_mm, axis(0), axis(1), axis(2));
}

Json needle_of_implant(const NeedleHistory& needle) {
  return {{"name", needle.name},
          {"depth_mm", needle.depth_mm},
          {"peak_force_N", needle.peak_force_N},
          {"deflection_mm", needle.deflection_mm},
          {"steps", needle.record.steps.size()},
          {"shapes", needle.record.shapes.size()},
          {"events", needle.events.size()}};
}

}  // namespace

Description describe(const ImplantRecord& record) {
  const SeedErrors errors = seed_errors(record.seeds);
  Json needles = Json::array(), stabilising = Json::array(), seeds = Json::array();
  for (const NeedleHistory& needle : record.needles) needles.push_back(needle_of_implant(needle));
  for (const NeedleHistory& needle : record.stabilising) stabilising.push_back(needle_of_implant(needle));
  for (const SeedHistory& seed : record.seeds) {
    seeds.push_back({{"number", seed.number + 1},
                     {"needle", record.needles[seed.needle].name},
                     {"error_mm", seed.error_mm().norm()},
                     {"error_xyz_mm", vector_json(seed.error_mm())},
                     {"lost", seed.lost}});
  }
  Description out;
  const bool dwells = record.implant == Implant::temporary;
  out.json = {{"kind", "implant"},
              {"implant", to_string(record.implant)},
              {"version", record.version},
              {"scenario", record.scenario_name},
              {"source", record.source},
              {"mesh", {{"nodes", record.mesh.node_count()}, {"tets", record.mesh.tet_count()}}},
              {"needles", needles},
              {"stabilising", stabilising},
              {"seeds", seeds},
              {"error", {{"seeds", errors.seeds}, {"mean_mm", errors.mean_mm}, {"p95_mm", errors.p95_mm}}},
              {"warnings", record.warnings}};

  Facts facts;
  facts.add("kind", dwells ? "a temporary implant: dwell positions in catheters" : "an implant of seeds");
  facts.add("made by", "stylet " + record.version);
  facts.add("scenario", record.scenario_name);
  facts.add("source", record.source);
  facts.add("prescription",
            record.prescription_Gy > 0.0 ? fmt::format("{:g} Gy", record.prescription_Gy) : "(not said)");
  facts.add("mesh", fmt::format("{} nodes, {} tetrahedra, {} regions", record.mesh.node_count(),
                                record.mesh.tet_count(), record.mesh.regions.size()));
  facts.add(dwells ? "catheters" : "needles",
            record.stabilising.empty()
                ? fmt::to_string(record.needles.size())
                : fmt::format("{}, and {} that stabilise", record.needles.size(), record.stabilising.size()));
  facts.add(dwells ? "dwell positions" : "seeds",
            dwells ? fmt::to_string(record.seeds.size())
                   : fmt::format("{}, {} lost", record.seeds.size(), record.seeds.size() - errors.seeds));
  facts.add("distance from plan", mean_error_in_words(errors));
  out.text = facts.text() + "\n\n" + needles_of_implant(record) + "\n\n" + seeds_of_implant(record);
  for (const std::string& warning : record.warnings) out.text += "\n  warning: " + warning;
  return out;
}

}  // namespace stylet::cli
