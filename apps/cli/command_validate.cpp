// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"
#include "output_path.hpp"
#include "table.hpp"

#include "stylet/evidence/validate/validation.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace stylet::cli {

namespace {

namespace fs = std::filesystem;
using validate::Row;
using validate::RowSpec;
using validate::Validation;
using validate::Verdict;

struct ValidateArguments {
  std::string output;
  std::string data;
  std::vector<std::string> only;
  bool quick = false;
  bool list = false;
  bool sensitivity = false;
};

/// Folder of the shared data: --data, else $STYLET_SHARED_DATA, else a folder beside the current one, which is right if
/// that is the repository.
fs::path data_folder(const ValidateArguments& arguments) {
  if (!arguments.data.empty()) return arguments.data;
  if (const char* named = std::getenv("STYLET_SHARED_DATA"); named != nullptr && *named != '\0') return named;
  return fs::path("..") / "shared" / "data";
}

std::string command_text(const ValidateArguments& arguments) {
  std::string text = "stylet validate -o " + arguments.output;
  if (arguments.quick) text += " --quick";
  if (arguments.sensitivity) text += " --sensitivity";
  if (!arguments.only.empty()) text += fmt::format(" --only {}", fmt::join(arguments.only, " "));
  return text;
}

std::string list_text() {
  Table table({"id", "group", "quick", "claim"});
  for (const RowSpec& row : validate::all_rows())
    table.row({row.id, to_string(row.group), row.quick ? "yes" : "no", row.claim});
  table.row({"sensitivity", "", "yes", "study of how the outputs change with each parameter (--sensitivity)"});
  return table.text();
}

Json list_json() {
  Json rows = Json::array();
  for (const RowSpec& row : validate::all_rows()) {
    rows.push_back({{"id", row.id},
                    {"group", to_string(row.group)},
                    {"claim", row.claim},
                    {"reference", row.reference},
                    {"unit", row.unit},
                    {"tolerance", row.accepted.text()},
                    {"quick", row.quick}});
  }
  return {{"rows", rows}};
}

std::string number(double value) { return std::isnan(value) ? std::string("-") : fmt::format("{:.3g}", value); }

std::string rows_text(const Validation& validation) {
  Table table({"row", "result", "ours", "unit", "accepted", "seconds"});
  for (const Row& row : validation.rows) {
    table.row({row.spec.id, to_string(row.verdict), number(row.finding.value), row.spec.unit, row.spec.accepted.text(),
               fmt::format("{:.1f}", row.seconds)});
  }
  return table.text();
}

std::string outcome_text(const Validation& v) {
  std::string text = fmt::format("{} of {} judged claims pass, {} MISSED", v.count(Verdict::pass),
                                 v.count(Verdict::pass) + v.count(Verdict::missed), v.count(Verdict::missed));
  if (const int skipped = v.count(Verdict::skipped); skipped > 0) text += fmt::format(", {} skipped", skipped);
  if (const int crashed = v.count(Verdict::crashed); crashed > 0) text += fmt::format(", {} crashed", crashed);
  return text + fmt::format(" ({:.0f} s)", v.seconds);
}

std::string sensitivity_text(const validate::Sensitivity& study) {
  const auto lines = validate::sensitivity_lines(study);
  Table table(lines.front());
  for (std::size_t i = 1; i < lines.size(); ++i) table.row(lines[i]);
  return fmt::format(
             "{}: each parameter is changed by {:.0f} %; the table shows the change of the peak force, of the shift of "
             "the target and of the deflection of the tip (unchanged parameters: {:.3g} N, {:.3g} mm, {:.3g} mm)\n",
             study.scenario, 100.0 * study.change, study.base.peak_axial_N, study.base.target_shift_mm,
             study.base.tip_deflection_mm) +
         table.text();
}

Result<> run_validate(const ValidateArguments& arguments, Console& console) {
  if (arguments.list) {
    need(console.print(list_text()));
    return console.write_json(list_json());
  }
  if (arguments.output.empty())
    return input_error("validate", "no folder for the page is given",
                       "Give a folder with -o, or list the rows with --list");
  const fs::path folder = arguments.output;
  need(check_output_folder(folder));
  if (!arguments.data.empty() && !fs::is_directory(arguments.data))
    return input_error("--data", fmt::format("'{}' is not a folder", arguments.data),
                       "Give the folder of the shared data");
  validate::ValidateOptions options;
  options.quick = arguments.quick;
  options.sensitivity = arguments.sensitivity;
  options.only = arguments.only;
  options.data = data_folder(arguments);
  options.command = command_text(arguments);
  const Progress progress = console.progress();
  const auto validation = need(validate::validate(options, progress));
  need(validate::write_validation(validation, folder));

  if (!validation.rows.empty()) console.say(outcome_text(validation) + "\n\n" + rows_text(validation));
  for (const Row& row : validation.rows) {
    if (row.verdict == Verdict::missed)
      console.say(fmt::format("\nMISSED {}: {}. {}", row.spec.id, row.spec.claim, row.note()));
    if (row.verdict == Verdict::skipped) console.say(fmt::format("\nskipped {}: {}", row.spec.id, row.note()));
  }
  if (validation.sensitivity) console.say("\n" + sensitivity_text(*validation.sensitivity));
  console.say(fmt::format("\nPage: {}", (folder / "validate.html").string()));
  need(console.write_json(Json::parse(validate::validation_json(validation))));
  for (const Row& row : validation.rows) {
    if (row.verdict == Verdict::crashed)
      return failure("row " + row.spec.id, row.note(), "See the page for the other rows, which were measured");
  }
  return Ok{};
}

}  // namespace

Command add_validate_command(CLI::App& program) {
  auto arguments = std::make_shared<ValidateArguments>();
  CLI::App* app = program.add_subcommand(
      "validate", "Compare the model with analytical solutions, independent code and published measurements");
  option(app, "-o,--output", arguments->output, "OUT/", "Folder for the page and the numbers");
  option(app, "--only", arguments->only, "ID", "Measure these rows only (--list prints their names)")->expected(1, -1);
  option(app, "--data", arguments->data, "FOLDER",
         "Folder of the shared data (default: $STYLET_SHARED_DATA, or ../shared/data); without this folder the "
         "rows that need it are skipped");
  app->add_flag("--quick", arguments->quick,
                "Measure only rows that take at most a few seconds; takes less than a minute in all");
  app->add_flag("--list", arguments->list, "List the rows and do nothing else");
  app->add_flag(
      "--sensitivity", arguments->sensitivity,
      "Also measure how peak force, shift of the target and deflection of the tip change with each parameter");
  return {app, [arguments](Console& console) { return run_validate(*arguments, console); }};
}

}  // namespace stylet::cli
