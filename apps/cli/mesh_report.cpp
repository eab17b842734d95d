// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_report.hpp"

#include "describe.hpp"
#include "table.hpp"

#include <fmt/format.h>

namespace stylet::cli {

std::string report_text(const MeshReport& report) {
  const MeshQuality& quality = report.quality;
  Facts facts;
  facts.add("nodes", fmt::to_string(quality.nodes));
  facts.add("tetrahedra", fmt::to_string(quality.tets));
  facts.add("dihedral angles",
            fmt::format("{:.1f}° … {:.1f}°, {:.2f} % of the elements below 12°", quality.dihedral_deg.min,
                        quality.dihedral_deg.max, 100 * quality.fraction_below_12_deg));
  facts.add("edges", fmt::format("{:.2f} … {:.2f} mm", quality.edge_mm.min, quality.edge_mm.max));
  facts.add("radius ratio", fmt::format("≥ {:.3f} (1 for a regular tetrahedron)", quality.radius_ratio_min));
  facts.add("surface distance",
            fmt::format("mean {:.2f} mm, largest {:.2f} mm", report.surface_mean_mm, report.surface_max_mm));
  if (report.contour_points > 0) {
    facts.add("contour points",
              fmt::format("{}, of which {} were kept", report.contour_points, report.contour_points_kept));
  }
  facts.add("time", fmt::format("{:.2f} s", report.seconds));

  Table table(
      {"region", "tetrahedra", "structure cc", "region cc", "mesh cc", "off %", "distance mean mm", "largest mm"});
  for (const RegionReport& region : report.regions) {
    const bool made_here = region.input_volume_cc <= 0;
    const double off = made_here ? 0 : 100 * (region.volume_cc / region.input_volume_cc - 1);
    table.row(
        {region.name, fmt::to_string(region.tets), made_here ? "" : fmt::format("{:.2f}", region.structure_volume_cc),
         made_here ? "" : fmt::format("{:.2f}", region.input_volume_cc), fmt::format("{:.2f}", region.volume_cc),
         made_here ? "" : fmt::format("{:+.1f}", off), made_here ? "" : fmt::format("{:.2f}", region.surface_mean_mm),
         made_here ? "" : fmt::format("{:.2f}", region.surface_max_mm)});
  }
  std::string text = facts.text() + "\n\n" + table.text();
  for (const std::string& note : report.notes) text += "\n  note: " + note;
  return text;
}

Json report_json(const MeshReport& report) {
  Json json = quality_json(report.quality);
  json["surface_distance_mm"] = {{"mean", report.surface_mean_mm}, {"max", report.surface_max_mm}};
  json["regions"] = Json::object();
  for (const RegionReport& region : report.regions) {
    json["regions"][region.name] = {
        {"tets", region.tets},
        {"volume_cc", region.volume_cc},
        {"input_volume_cc", region.input_volume_cc},
        {"structure_volume_cc", region.structure_volume_cc},
        {"surface_distance_mm", {{"mean", region.surface_mean_mm}, {"max", region.surface_max_mm}}}};
  }
  json["contour_points"] = {{"read", report.contour_points}, {"kept", report.contour_points_kept}};
  json["notes"] = report.notes;
  json["seconds"] = report.seconds;
  return json;
}

}  // namespace stylet::cli
