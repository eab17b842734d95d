// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/results/output_folder.hpp"
#include "reproduction_data.hpp"
#include "stylet/core/json_text.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace stylet::reproduce {
namespace fs = std::filesystem;

namespace {

using results::csv_text;
using results::File;

std::string figure5_csv(const std::vector<Figure5Row>& rows) {
  std::string csv =
      "dim,change,inverse_s,bcs_s,woodbury_s,woodbury_symmetric_s,largest_error,repeats,added,"
      "bcs_multiplications,woodbury_multiplications\n";
  for (const Figure5Row& row : rows) {
    csv += fmt::format("{},{},{:.6e},{:.6e},{:.6e},{:.6e},{:.2e},{},{},{:.0f},{:.0f}\n", row.dim, row.change,
                       row.inverse_s, row.bcs_s, row.woodbury_s, row.woodbury_symmetric_s, row.largest_error,
                       row.repeats, row.added, row.bcs_multiplications, row.woodbury_multiplications);
  }
  return csv;
}

std::string figure6_csv(const Figure6Run& run) {
  std::vector<std::string> events(run.steps.size());
  for (const Figure6Event& event : run.events) {
    std::string& text = events[event.iteration];
    text += (text.empty() ? "" : ";") + std::string(to_string(event.event.kind));
    if (!event.event.region.empty()) text += ":" + event.event.region;
  }
  std::vector<int> dimension(run.steps.size(), 0);
  for (const Figure6Remesh& remesh : run.remeshes)
    dimension[remesh.iteration] = std::max(dimension[remesh.iteration], remesh.event.dimension);
  std::string csv =
      "iteration,insertion,time_s,base_depth_mm,force_axial_N,force_sagittal_N,force_lateral_N,step_us,cumulative_s,"
      "remeshings,dk_dimension,contacts,sticking,events\n";
  double cumulative_s = 0.0;
  for (std::size_t i = 0; i < run.steps.size(); ++i) {
    const Step& s = run.steps[i];
    cumulative_s += 1e-6 * s.step_us;
    csv +=
        fmt::format("{},{},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f},{:.3f},{:.9f},{},{},{},{},{}\n", i, run.insertion[i] + 1,
                    s.time_s, s.base_depth_mm, s.force_axial_N, s.force_sagittal_N, s.force_lateral_N, s.step_us,
                    cumulative_s, run.remeshings[i], dimension[i], s.contacts, s.sticking, events[i]);
  }
  return csv;
}

std::string cell_text(const TableCell& cell) {
  if (const auto* number = std::get_if<double>(&cell)) return fmt::format("{:.6g}", *number);
  if (const auto* words = std::get_if<std::string>(&cell)) return csv_text(*words);
  return {};
}

std::string table_csv(const std::vector<TableRow>& rows) {
  std::string csv = "group,quantity,unit,paper,reproduced,default,note\n";
  for (const TableRow& row : rows) {
    csv += fmt::format("{},{},{},{},{},{},{}\n", csv_text(row.group), csv_text(row.quantity), csv_text(row.unit),
                       cell_text(row.paper), cell_text(row.reproduced), cell_text(row.ours), csv_text(row.note));
  }
  return csv;
}

}  // namespace

Result<> write_reproduction(const Reproduction& reproduction, const fs::path& folder) {
  Result<std::string> page = reproduction_page(reproduction);
  if (!page) return page.error();
  std::vector<File> files{{"report.html", std::move(*page)},
                          {"figure2.json", json_text(figure2_json(reproduction.figure2), 1)},
                          {"figure5.csv", figure5_csv(reproduction.figure5)},
                          {"table.csv", table_csv(reproduction.table)}};
  for (const Figure6Run& run : reproduction.figure6.runs) files.push_back({curve_file(run), figure6_csv(run)});
  files.push_back({"reproduce.json", reproduction_json(reproduction)});
  return results::write_folder(files, folder);
}

}  // namespace stylet::reproduce
