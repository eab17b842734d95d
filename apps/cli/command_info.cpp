// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"
#include "describe.hpp"
#include "output_path.hpp"
#include "scenario_draft.hpp"
#include "validators.hpp"

#include "stylet/core/nearest_name.hpp"
#include "stylet/dose/known_sources.hpp"
#include "stylet/io/dose_io.hpp"
#include "stylet/io/input.hpp"
#include "stylet/patient/fit.hpp"

#include <fmt/format.h>

namespace stylet::cli {

namespace {

struct InfoArguments {
  std::string file;
  double scale = 0;
  int volume = 0;
  std::string regions_from;
  std::vector<std::string> skip;
  bool scenario = false;
  std::string output;
};

/// Adds what judge_fit() says about a patient.
void add_fit(const PatientInput& input, const InfoArguments& arguments, Description& out) {
  FitOptions options{.scale = arguments.scale};
  options.names.skip = arguments.skip;
  for (const FitFinding& finding : judge_fit(input, options)) {
    if (finding.verdict == FitVerdict::note) {
      out.json["notes"].push_back(finding.message());
      out.text += "\n  note: " + finding.message();
      continue;
    }
    out.warnings.push_back((finding.verdict == FitVerdict::refuse ? "A simulation refuses this patient. " : "") +
                           finding.message());
  }
  if (!out.warnings.empty()) out.json["warnings"] = out.warnings;
}

/// Refuses a word that is no file and nearly the name of a source model.
Result<> not_a_mistyped_source(const std::string& word) {
  std::error_code code;
  if (std::filesystem::path(word).has_parent_path() || std::filesystem::exists(word, code)) return Ok{};
  std::vector<std::string> names;
  for (const SourceModel& source : known_sources()) names.push_back(source.name);
  const std::string near = nearest_name(word, names);
  if (near.empty()) return Ok{};
  return input_error(word, fmt::format("no such file, and no source model; did you mean '{}'?", near),
                     "stylet info sources lists the source models");
}

/// @param notes receives the reader's sentences about a mesh or surfaces; contours and masks hold their own
PatientInput patient_of(const InfoArguments& arguments, std::vector<std::string>& notes) {
  return need(read_input(arguments.file,
                         {.scale = arguments.scale, .notes = &notes, .regions_from = arguments.regions_from},
                         {.volume = arguments.volume}, arguments.skip));
}

Description description_of(const InfoArguments& arguments) {
  if (arguments.file == "sources") return describe_known_sources();
  if (const Result<SourceModel> known = find_source(arguments.file); known) return describe(*known);
  need(not_a_mistyped_source(arguments.file));
  switch (dose_file_kind(arguments.file)) {
    case DoseFileKind::plan:
      return describe(need(read_plan(arguments.file)));
    case DoseFileKind::dose_grid:
      return describe(need(read_rtdose(arguments.file)));
    case DoseFileKind::source_model:
      return describe(need(read_source_model(arguments.file)));
    case DoseFileKind::none:
      break;
  }
  if (is_meant_as_model(arguments.file)) {
    return describe(need(read_model_file(arguments.file)));
  }
  if (is_hdf5_file(arguments.file)) {
    if (is_implant_record(arguments.file)) return describe(need(read_implant_record(arguments.file)));
    return describe(need(read_recording(arguments.file)));
  }
  std::vector<std::string> notes;
  const auto input = patient_of(arguments, notes);
  Description out = std::visit([](const auto& content) { return describe(content); }, input);
  for (const std::string& note : notes) {
    out.json["notes"].push_back(note);
    out.text += "\n  note: " + note;
  }
  add_fit(input, arguments, out);
  return out;
}

/// Writes a drafted scenario.
Result<> run_draft(const InfoArguments& arguments, Console& console) {
  if (is_meant_as_model(arguments.file) || is_hdf5_file(arguments.file)) {
    return input_error(arguments.file, "a saved model or a recording already contains its scenario",
                       is_implant_record(arguments.file)
                           ? "Give the scenario to stylet implant, or give the patient's file"
                           : "Run it with stylet insert, or give the patient's file");
  }
  std::error_code code;
  if (!arguments.output.empty() && std::filesystem::equivalent(arguments.file, arguments.output, code))
    return input_error(arguments.output, "the scenario would replace the patient's file", "Name another file (-o)");
  if (!arguments.output.empty()) {
    need(check_output_file(arguments.output));
  }
  std::vector<std::string> notes;
  const auto input = patient_of(arguments, notes);
  const auto draft =
      need(draft_scenario(input, {arguments.file, source_for(arguments.file, arguments.output), arguments.scale,
                                  arguments.volume, arguments.regions_from, arguments.skip, notes}));
  for (const std::string& warning : draft.warnings) console.warn(warning);
  if (arguments.output.empty()) {
    need(console.print(draft.text));
  } else {
    need(write_text_file(arguments.output, draft.text + '\n'));
    console.say(fmt::format("{} → {}", arguments.file, arguments.output));
  }
  return console.write_json(
      {{"file", arguments.file}, {"output", arguments.output}, {"scenario", draft.text}, {"warnings", draft.warnings}});
}

Result<> run_info(const InfoArguments& arguments, Console& console) {
  if (arguments.scenario) return run_draft(arguments, console);
  const auto description = description_of(arguments);
  Json json = {{"file", arguments.file}};
  json.update(description.json);
  for (const std::string& warning : description.warnings) console.warn(arguments.file + ": " + warning);
  need(console.print(arguments.file + '\n' + description.text));
  return console.write_json(json);
}

}  // namespace

Command add_info_command(CLI::App& program) {
  auto arguments = std::make_shared<InfoArguments>();
  CLI::App* app = program.add_subcommand(
      "info", "Describe contours, a mask, mesh, surface, plan, dose, source model, saved model, recording or implant");
  app->add_option("FILE", arguments->file,
                  "File, or folder that contains one DICOM RTSTRUCT or SEG; or the name of a source model, or "
                  "'sources' for a list of those "
                  "that the program has")
      ->required();
  option(app, "--scale", arguments->scale, "S",
         "Unit of a mesh file in mm, e.g. 1000 for metres (default: as the file says)")
      ->check(number_between(1e-6, 1e6, "mm"));
  add_volume_option(*app, arguments->volume);
  add_regions_from_option(*app, arguments->regions_from);
  repeated_option(app, "--skip", arguments->skip, "NAME",
                  "Ignore the structure NAME if it is damaged; with --scenario leave it out in any case; may be "
                  "repeated");
  CLI::Option* scenario = app->add_flag("--scenario", arguments->scenario,
                                        "Write a commented scenario for this patient instead: the region that each "
                                        "structure is taken as, the structures that are left out and why, and one "
                                        "needle");
  option(app, "-o,--output", arguments->output, "FILE.toml",
         "With --scenario: the file to write; it gives the patient's path relative to its own folder "
         "(default: standard output, with the patient's absolute path)")
      ->needs(scenario);
  return {app, [arguments](Console& console) { return run_info(*arguments, console); }};
}

}  // namespace stylet::cli
