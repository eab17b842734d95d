// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"
#include "early_warnings.hpp"
#include "output_path.hpp"
#include "table.hpp"

#include "stylet/io/files.hpp"
#include "stylet/io/model_file.hpp"
#include "stylet/io/scenario_io.hpp"
#include "stylet/patient/prepared_model.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <filesystem>

namespace stylet::cli {

namespace {

struct PrepareArguments {
  std::string scenario;
  std::string output;
  std::vector<std::string> settings;
};

/// Peak memory of this process [MB].
double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// The file to write. If a folder is given, the file's name is the model's key, by which `stylet serve` finds it.
std::filesystem::path output_file(const PrepareArguments& arguments) {
  const std::filesystem::path output = arguments.output;
  std::error_code code;
  if (!output.has_filename() || std::filesystem::is_directory(output, code)) {
    const auto scenario = need(read_scenario(arguments.scenario, arguments.settings));
    const auto key = need(model_key(scenario));
    return output / (key + ".stylet");
  }
  if (output.extension() == ".stylet") return output;
  throw Failed{input_error(arguments.output, "a saved model has the extension .stylet",
                           "Give a name that ends in .stylet, or a folder (with / at the end)")};
}

Result<> run_prepare(const PrepareArguments& arguments, Console& console) {
  if (is_hdf5_file(arguments.scenario)) {
    return input_error(arguments.scenario, "this is an HDF5 file; a scenario (TOML) is expected",
                       "Give the scenario from which the model is to be made");
  }
  const auto file = output_file(arguments);
  const std::filesystem::path& output = file;
  need(check_output_file(output));
  warn_before_start(arguments.scenario, arguments.settings, Work::preparation, console);
  const auto prepared = need(prepare_model_file(arguments.scenario, arguments.settings, console.progress()));
  const Model& model = *prepared.model;
  const auto start = std::chrono::steady_clock::now();
  need(make_folder(output.has_parent_path() ? output.parent_path() : "."));
  need(save_model(model, output, prepared.notes, console.progress()));
  const double save_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  for (const std::string& warning : prepared.warnings()) console.warn(warning);
  const double megabytes = static_cast<double>(std::filesystem::file_size(output)) / 1048576.0;
  const auto& statistics = model.tissue().statistics();
  Facts facts;
  facts.add("mesh", fmt::format("{} nodes, {} tetrahedra, {}", model.mesh().node_count(), model.mesh().tet_count(),
                                to_string(model.tissue().element())));
  facts.add("corridor", fmt::format("{} nodes", model.tissue().corridor().size()));
  facts.add("time", fmt::format("{:.1f} s to mesh, {:.1f} s to compile ({:.1f} s of it to factorise the stiffness), "
                                "{:.1f} s to save; {:.0f} MB of memory",
                                prepared.mesh_s, prepared.model_s, statistics.factor_seconds, save_s, peak_mb()));
  facts.add("file", fmt::format("{:.0f} MB", megabytes));
  console.say(fmt::format("{} → {}", arguments.scenario, output.string()));
  console.say(facts.text());
  return console.write_json({{"scenario", arguments.scenario},
                             {"output", output.string()},
                             {"nodes", model.mesh().node_count()},
                             {"tets", model.mesh().tet_count()},
                             {"element", to_string(model.tissue().element())},
                             {"corridor_nodes", model.tissue().corridor().size()},
                             {"seconds",
                              {{"mesh", prepared.mesh_s},
                               {"model", prepared.model_s},
                               {"factor", statistics.factor_seconds},
                               {"save", save_s}}},
                             {"factor_mb", statistics.factor_mb},
                             {"peak_memory_mb", peak_mb()},
                             {"file_mb", megabytes},
                             {"warnings", prepared.warnings()}});
}

}  // namespace

Command add_prepare_command(CLI::App& program) {
  auto arguments = std::make_shared<PrepareArguments>();
  CLI::App* app =
      program.add_subcommand("prepare", "Mesh and compile a scenario and save the model, which then starts in seconds");
  option(app, "SCENARIO", arguments->scenario, "SCENARIO.toml", "Scenario file (TOML)")->required();
  option(app, "-o,--output", arguments->output, "MODEL.stylet",
         "Model to write, or a folder in which `stylet serve --models` finds the model")
      ->required();
  settings_option(app, arguments->settings, "mesh.nodes=5000");
  return {app, [arguments](Console& console) { return run_prepare(*arguments, console); }};
}

}  // namespace stylet::cli
