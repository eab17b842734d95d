// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/results/output_folder.hpp"
#include "reproduction_data.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cmath>

namespace stylet::reproduce {
namespace fs = std::filesystem;

namespace {

constexpr const char* kLast = "reproduce.json";  ///< a folder that holds it is complete

struct File {
  std::string name;
  std::string content;
};

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
    const StepRecord& s = run.steps[i];
    cumulative_s += 1e-6 * s.step_us;
    csv +=
        fmt::format("{},{},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f},{:.3f},{:.9f},{},{},{},{},{}\n", i, run.insertion[i] + 1,
                    s.time_s, s.base_depth_mm, s.force_axial_N, s.force_sagittal_N, s.force_lateral_N, s.step_us,
                    cumulative_s, run.remeshings[i], dimension[i], s.contacts, s.sticking, events[i]);
  }
  return csv;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

std::string cell_text(const TableCell& cell) {
  if (const auto* number = std::get_if<double>(&cell)) return fmt::format("{:.6g}", *number);
  if (const auto* words = std::get_if<std::string>(&cell)) return quoted(*words);
  return {};
}

std::string table_csv(const std::vector<TableRow>& rows) {
  std::string csv = "group,quantity,unit,paper,reproduced,default,note\n";
  for (const TableRow& row : rows) {
    csv += fmt::format("{},{},{},{},{},{},{}\n", quoted(row.group), quoted(row.quantity), quoted(row.unit),
                       cell_text(row.paper), cell_text(row.reproduced), cell_text(row.ours), quoted(row.note));
  }
  return csv;
}

Result<> write_all(const std::vector<File>& files, const fs::path& folder) {
  for (const File& file : files) {
    if (auto done = results::write_file(folder / file.name, file.content); !done) return done;
  }
  return Ok{};
}

/// The files under a hidden name beside the folder, which then takes its place in one step.
Result<> write_new_folder(const std::vector<File>& files, const fs::path& folder) {
  const fs::path parent = folder.has_parent_path() ? folder.parent_path() : fs::path(".");
  if (auto ready = results::prepare_folder(parent); !ready) return ready;
  const fs::path hidden = parent / fmt::format(".{}.{}.part", folder.filename().string(), ::getpid());
  std::error_code code;
  fs::create_directory(hidden, code);
  if (code) return results::write_error(hidden, code.message());
  Result<> done = write_all(files, hidden);
  if (done) {
    fs::rename(hidden, folder, code);
    if (code) done = results::write_error(folder, code.message());
  }
  std::error_code ignored;
  if (!done) fs::remove_all(hidden, ignored);
  return done;
}

}  // namespace

Result<> write_reproduction(const Reproduction& reproduction, const fs::path& folder) {
  Result<std::string> page = reproduction_page(reproduction);
  if (!page) return page.error();
  std::vector<File> files{{"report.html", std::move(*page)},
                          {"figure2.json", figure2_json(reproduction.figure2).dump(1)},
                          {"figure5.csv", figure5_csv(reproduction.figure5)},
                          {"table.csv", table_csv(reproduction.table)}};
  for (const Figure6Run& run : reproduction.figure6.runs) files.push_back({curve_file(run), figure6_csv(run)});
  files.push_back({kLast, reproduction_json(reproduction)});

  // "out/" and "out" are the same folder.
  const fs::path place = folder.has_filename() ? folder : folder.parent_path();
  std::error_code code;
  if (!fs::exists(place, code)) return write_new_folder(files, place);
  if (auto ready = results::prepare_folder(place); !ready) return ready;
  fs::remove(place / kLast, code);
  return write_all(files, place);
}

}  // namespace stylet::reproduce
