// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"
#include "describe.hpp"
#include "validators.hpp"

#include "stylet/io/input.hpp"

namespace stylet::cli {

namespace {

struct InfoArguments {
  std::string file;
  double scale = 0;
  int volume = 0;
};

Result<Description> description_of(const InfoArguments& arguments) {
  if (is_meant_as_model(arguments.file)) {
    const Result<ModelFile> model = read_model_file(arguments.file);
    if (!model) return model.error();
    return describe(*model);
  }
  if (is_hdf5_file(arguments.file)) {
    const Result<RunRecording> run = read_recording(arguments.file);
    if (!run) return run.error();
    return describe(*run);
  }
  const Result<PatientInput> input =
      read_input(arguments.file, {.scale = arguments.scale}, {.volume = arguments.volume});
  if (!input) return input.error();
  return std::visit([](const auto& content) { return describe(content); }, *input);
}

Result<> run_info(const InfoArguments& arguments, Console& console) {
  const Result<Description> description = description_of(arguments);
  if (!description) return description.error();
  Json json = {{"file", arguments.file}};
  json.update(description->json);
  for (const std::string& warning : description->warnings) console.warn(arguments.file + ": " + warning);
  console.say(arguments.file + '\n' + description->text);
  return console.write_json(json);
}

}  // namespace

Command add_info_command(CLI::App& program) {
  auto arguments = std::make_shared<InfoArguments>();
  CLI::App* app =
      program.add_subcommand("info", "Say what is in a contour set, mask, mesh, surface, saved model or recording");
  app->add_option("FILE", arguments->file, "File, or folder with one DICOM RTSTRUCT or SEG in it")->required();
  app->add_option("--scale", arguments->scale,
                  "Unit of a mesh file in mm, e.g. 1000 for metres (default: as the file says)")
      ->type_name("S")
      ->check(number_between(1e-6, 1e6, "mm"));
  add_volume_option(*app, arguments->volume);
  return {app, [arguments](Console& console) { return run_info(*arguments, console); }};
}

}  // namespace stylet::cli
