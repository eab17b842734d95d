// SPDX-License-Identifier: GPL-3.0-or-later
// The public readers of dose_io.hpp: they recognise the kind of file and run its parser.
#include "detail/csv.hpp"
#include "detail/dicom.hpp"
#include "detail/file_kind.hpp"
#include "detail/json_text.hpp"
#include "detail/text.hpp"
#include "dose/dose_parsers.hpp"
#include "dose/plan_words.hpp"
#include "reading/ask.hpp"
#include "reading/tasks.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

namespace stylet {

namespace {

namespace fs = std::filesystem;
using detail::FileKind;

/// First line of a text file that is neither empty nor a comment.
std::string header_line(const fs::path& path) {
  std::ifstream stream(path);
  std::string line;
  for (int k = 0; k < 200 && std::getline(stream, line); ++k) {
    line = detail::trimmed(line);
    if (!line.empty() && line.front() != '#') return line;
  }
  return {};
}

bool has_words(const std::string& line, std::initializer_list<const char*> words) {
  return std::all_of(words.begin(), words.end(),
                     [&](const char* word) { return line.find(word) != std::string::npos; });
}

}  // namespace

DoseFileKind dose_file_kind(const fs::path& path) {
  std::error_code code;
  if (!fs::is_regular_file(path, code)) return DoseFileKind::none;
  const Result<FileKind> kind = detail::identify(path);
  if (!kind) return DoseFileKind::none;
  if (*kind == FileKind::dicom) {
    const Result<std::string> modality = detail::ask(detail::kModality, path);
    if (!modality) return DoseFileKind::none;
    if (*modality == "RTPLAN") return DoseFileKind::plan;
    return *modality == "RTDOSE" ? DoseFileKind::dose_grid : DoseFileKind::none;
  }
  if (*kind == FileKind::contour_json) {
    const Result<std::string> format = detail::ask(detail::kJsonFormat, path);
    if (!format) return DoseFileKind::none;
    if (*format == "stylet-plan") return DoseFileKind::plan;
    return *format == "stylet-source" ? DoseFileKind::source_model : DoseFileKind::none;
  }
  const std::string line = header_line(path);
  const bool plan = has_words(line, {"x_mm", "y_mm", "z_mm"}) || has_words(line, {"hole", "retraction_mm", "train"});
  return *kind == FileKind::unknown && plan ? DoseFileKind::plan : DoseFileKind::none;
}

Result<std::string> detail::format_of_json(const fs::path& path) {
  const Result<nlohmann::json> json = parse_json_file(path);
  if (!json) return json.error();
  return json->is_object() && json->contains("format") && (*json)["format"].is_string()
             ? (*json)["format"].get<std::string>()
             : std::string();
}

Result<DosePlan> detail::parse_plan_text(const fs::path& path) {
  const Result<FileKind> kind = identify(path);
  if (!kind) return kind.error();
  return *kind == FileKind::contour_json ? parse_plan_json(path) : parse_plan_csv(path);
}

Result<DosePlan> read_plan(const fs::path& path) {
  const Result<FileKind> kind = detail::identify(path);
  if (!kind) return kind.error();
  if (*kind == FileKind::dicom) return detail::ask(detail::kRtplan, path);
  if (*kind != FileKind::contour_json && *kind != FileKind::unknown) {
    return input_error(path.string(), "this is " + detail::name_of(*kind) + ", a plan is expected",
                       "Give a DICOM RTPLAN, plan JSON or CSV of seeds");
  }
  return detail::ask(detail::kPlanText, path);
}

Result<DoseGrid> read_rtdose(const fs::path& path) {
  const Result<FileKind> kind = detail::identify(path);
  if (!kind) return kind.error();
  if (*kind != FileKind::dicom) {
    return input_error(path.string(), "this is " + detail::name_of(*kind) + ", a DICOM RTDOSE is expected",
                       "Export the dose as DICOM RTDOSE");
  }
  return detail::ask(detail::kRtdose, path);
}

Result<std::vector<Vec3>> read_points(const fs::path& path) {
  const std::vector<std::string> columns{"x_mm", "y_mm", "z_mm", "name"};
  const Result<detail::CsvTable> table = detail::read_csv_table(path, columns);
  if (!table) return table.error();
  std::vector<Vec3> points(table->rows.size());
  for (std::size_t row = 0; row < points.size(); ++row) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const std::string& column = columns[static_cast<std::size_t>(axis)];
      if (!table->has(column))
        return input_error(table->file, "the column " + column + " is missing",
                           "Write x_mm,y_mm,z_mm in the first line");
      const Result<double> number = table->number(row, column);
      if (!number) return number.error();
      points[row][axis] = *number;
    }
  }
  return points;
}

Result<std::vector<DoseGoal>> read_goals(const fs::path& path) {
  const std::vector<std::string> columns{"structure", "metric", "bound", "citation"};
  const Result<detail::CsvTable> table = detail::read_csv_table(path, columns);
  if (!table) return table.error();
  for (const char* column : {"structure", "metric", "bound", "citation"}) {
    if (!table->has(column))
      return input_error(table->file, std::string("the column ") + column + " is missing",
                         "Write structure,metric,bound,citation in the first line");
  }
  std::vector<DoseGoal> goals;
  for (std::size_t row = 0; row < table->rows.size(); ++row) {
    const Result<DoseGoal> goal = parse_goal({table->text(row, "structure"), table->text(row, "metric"),
                                              table->text(row, "bound"), table->text(row, "citation")},
                                             table->where(row));
    if (!goal) return goal.error();
    goals.push_back(*goal);
  }
  return goals;
}

}  // namespace stylet
