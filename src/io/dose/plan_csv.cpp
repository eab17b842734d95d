// SPDX-License-Identifier: GPL-3.0-or-later
// Plans in CSV (docs/formats.md): a row for each seed, or for each needle with its train.
#include "detail/csv.hpp"
#include "detail/text.hpp"
#include "dose/plan_words.hpp"
#include "stylet/core/nearest_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace stylet::detail {

namespace {

const std::vector<std::string> kPlanColumns{
    "x_mm",    "y_mm", "z_mm",          "ax",    "ay",    "az", "strength_U", "needle",
    "dwell_s", "hole", "retraction_mm", "train", "source"};
const std::vector<std::string> kPlanLines{
    "label",          "source",           "frame_of_reference", "strength_date",      "plan_date",
    "implant",        "prescription_Gy",  "strength_U",         "template_origin_mm", "pitch_mm",
    "seed_length_mm", "spacer_length_mm", "tip_offset_mm"};

/// The number of a line "# key: value"; `usual` where there is none.
Result<double> key_number(const CsvTable& table, const std::string& key, double usual) {
  const auto found = table.keys.find(key);
  if (found == table.keys.end()) return usual;
  const auto number = to_number(found->second);
  if (number && std::isfinite(*number)) return *number;
  return input_error(fmt::format("{}, line '# {}'", table.file, key),
                     fmt::format("'{}' is not a finite number", found->second), "Correct this value");
}

std::string key_text(const CsvTable& table, const std::string& key) {
  const auto found = table.keys.find(key);
  return found == table.keys.end() ? std::string() : found->second;
}

/// Whether a line "# key: value" that nothing reads looks as if it were meant to be read.
bool is_meant_as_key(const std::string& key) {
  static constexpr std::array<std::string_view, 10> words{"strength",  "activity", "unit", "isotope",  "half",
                                                          "prescript", "fraction", "dose", "template", "dwell"};
  if (std::find(kPlanLines.begin(), kPlanLines.end(), key) != kPlanLines.end()) return false;
  std::string small;
  for (const char c : key) small += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const bool is_word = key.find(' ') == std::string::npos;
  return (is_word && (key.find('_') != std::string::npos || !nearest_name(key, kPlanLines).empty())) ||
         std::any_of(words.begin(), words.end(), [&](std::string_view word) { return small.starts_with(word); });
}

/// Three numbers of a row. Error: one of them is not a finite number.
Result<Vec3> vector_at(const CsvTable& table, std::size_t row, const std::array<const char*, 3>& columns) {
  Vec3 x = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const Result<double> number = table.number(row, columns[k]);
    if (!number) return number.error();
    x[static_cast<Eigen::Index>(k)] = *number;
  }
  return x;
}

Result<> add_seed(const CsvTable& table, std::size_t row, double strength_U, PlanBuilder& builder) {
  PlannedSource seed;
  const Result<Vec3> at = vector_at(table, row, {"x_mm", "y_mm", "z_mm"});
  if (!at) return at.error();
  seed.at_mm = *at;
  if (table.has("ax") && !table.text(row, "ax").empty()) {
    const Result<Vec3> axis = vector_at(table, row, {"ax", "ay", "az"});
    if (!axis) return axis.error();
    seed.axis = *axis;
    seed.has_axis = true;
  }
  seed.strength_U = strength_U;
  for (const auto& [column, value] : {std::pair("strength_U", &seed.strength_U), std::pair("dwell_s", &seed.dwell_s)}) {
    if (table.text(row, column).empty()) continue;
    const Result<double> number = table.number(row, column);
    if (!number) return number.error();
    *value = *number;
  }
  seed.needle = table.text(row, "needle");
  if (table.text(row, "dwell_s").empty()) ++builder.plan.says.without_dwell_time;
  const Result<std::size_t> kind = builder.kind_of(table.text(row, "source"), table.where(row));
  if (!kind) return kind.error();
  seed.kind = *kind;
  return builder.add(seed, table.where(row));
}

Result<PlanTemplate> template_of(const CsvTable& table) {
  PlanTemplate grid;
  const std::string origin = key_text(table, "template_origin_mm");
  std::vector<double> numbers;
  for (const std::string_view part : split(origin, ' ')) {
    if (trimmed(part).empty()) continue;
    numbers.push_back(to_number(part).value_or(NAN));
  }
  if (numbers.size() != 3 || !std::isfinite(numbers[0] + numbers[1] + numbers[2])) {
    return input_error(table.file,
                       fmt::format("the line '# template_origin_mm: x y z' is missing or wrong ('{}')", origin),
                       "Give the place where the axis of hole D4 meets the base plane, in mm");
  }
  grid.origin_mm = Vec3(numbers[0], numbers[1], numbers[2]);
  for (const auto& [key, value] :
       {std::pair("pitch_mm", &grid.grid.pitch_mm), std::pair("seed_length_mm", &grid.lengths.seed_mm),
        std::pair("spacer_length_mm", &grid.lengths.spacer_mm)}) {
    const Result<double> number = key_number(table, key, *value);
    if (!number) return number.error();
    *value = *number;
  }
  if (table.keys.contains("tip_offset_mm")) {
    const Result<double> tip = key_number(table, "tip_offset_mm", 0.0);
    if (!tip) return tip.error();
    grid.tip_offset_mm = *tip;
  }
  if (Result<> good = check_template(grid, table.file); !good) return good.error();
  return grid;
}

Result<> add_needle(const CsvTable& table, std::size_t row, double strength_U, const PlanTemplate& grid,
                    PlanBuilder& builder) {
  PlanNeedle needle;
  needle.hole = table.text(row, "hole");
  needle.train = table.text(row, "train");
  const Result<double> retraction = table.number(row, "retraction_mm");
  if (!retraction) return retraction.error();
  needle.retraction_mm = *retraction;
  needle.strength_U = strength_U;
  if (!table.text(row, "strength_U").empty()) {
    const Result<double> strength = table.number(row, "strength_U");
    if (!strength) return strength.error();
    needle.strength_U = *strength;
  }
  return builder.add(needle, grid, table.where(row));
}

}  // namespace

Result<DosePlan> parse_plan_csv(const std::filesystem::path& path) {
  const Result<CsvTable> table = read_csv_table(path, kPlanColumns);
  if (!table) return table.error();
  PlanBuilder builder(path.string());
  DosePlan& plan = builder.plan;
  plan.label = key_text(*table, "label");
  plan.source_model = key_text(*table, "source");
  plan.frame_of_reference = key_text(*table, "frame_of_reference");
  plan.source_id = plan.source_model;
  plan.strength_date = key_text(*table, "strength_date");
  plan.plan_date = key_text(*table, "plan_date");
  for (const auto& [key, value] : table->keys) {
    if (is_meant_as_key(key)) plan.says.ignored.push_back(fmt::format("# {}: {}", key, value));
  }
  if (table->keys.contains("implant")) {
    if (Result<> set = set_implant(key_text(*table, "implant"), table->file, plan); !set) return set.error();
  }
  const Result<double> prescription = key_number(*table, "prescription_Gy", 0.0);
  if (!prescription) return prescription.error();
  plan.prescription_Gy = *prescription;
  const Result<double> strength = key_number(*table, "strength_U", 0.0);
  if (!strength) return strength.error();

  if (table->has("hole") && table->has("train") && table->has("retraction_mm")) {
    const Result<PlanTemplate> grid = template_of(*table);
    if (!grid) return grid.error();
    for (std::size_t row = 0; row < table->rows.size(); ++row) {
      if (Result<> added = add_needle(*table, row, *strength, *grid, builder); !added) return added.error();
    }
    return builder.finish();
  }
  if (!table->has("x_mm") || !table->has("y_mm") || !table->has("z_mm")) {
    return input_error(table->file, "the table has neither the columns x_mm, y_mm, z_mm nor hole, retraction_mm, train",
                       "Write the header line as docs/formats.md describes it");
  }
  for (std::size_t row = 0; row < table->rows.size(); ++row) {
    if (Result<> added = add_seed(*table, row, *strength, builder); !added) return added.error();
  }
  return builder.finish();
}

}  // namespace stylet::detail
