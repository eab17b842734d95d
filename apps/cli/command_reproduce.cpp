// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"
#include "output_path.hpp"
#include "table.hpp"

#include "stylet/evidence/reproduce/reproduction.hpp"

#include <fmt/format.h>

namespace stylet::cli {

namespace {

struct ReproduceArguments {
  std::string output;
  bool quick = false;
};

std::string cell_text(const reproduce::TableCell& cell) {
  if (const auto* number = std::get_if<double>(&cell)) return fmt::format("{:.4g}", *number);
  if (const auto* words = std::get_if<std::string>(&cell)) return *words;
  return {};
}

std::string table_text(const std::vector<reproduce::TableRow>& rows) {
  Table table({"quantity", "unit", "paper", "its method here", "default"});
  for (const reproduce::TableRow& row : rows)
    table.row({row.quantity, row.unit, cell_text(row.paper), cell_text(row.reproduced), cell_text(row.ours)});
  return table.text();
}

Result<> run_reproduce(const ReproduceArguments& arguments, Console& console) {
  const std::filesystem::path folder = arguments.output;
  need(check_output_folder(folder));
  reproduce::ReproduceOptions options;
  options.quick = arguments.quick;
  options.command = fmt::format("stylet reproduce -o {}{}", arguments.output, arguments.quick ? " --quick" : "");
  const Progress progress = console.progress();
  const auto reproduction = need(reproduce::reproduce(options, progress));
  need(reproduce::write_reproduction(reproduction, folder));
  for (const std::string& note : reproduction.notes) console.warn(note);
  console.say(table_text(reproduction.table));
  console.say(fmt::format("Page: {}", (folder / "report.html").string()));
  return console.write_json(Json::parse(reproduce::reproduction_json(reproduction)));
}

}  // namespace

Command add_reproduce_command(CLI::App& program) {
  auto arguments = std::make_shared<ReproduceArguments>();
  CLI::App* app = program.add_subcommand(
      "reproduce",
      "Reproduce the figures and numbers of Goksel et al. 2005, beside the results of this program's default");
  option(app, "-o,--output", arguments->output, "OUT/", "Folder for the page and the numbers")->required();
  app->add_flag("--quick", arguments->quick,
                "Use fewer sizes and repeats and one shorter insertion; takes less than a minute");
  return {app, [arguments](Console& console) { return run_reproduce(*arguments, console); }};
}

}  // namespace stylet::cli
