// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"
#include "describe.hpp"
#include "output_path.hpp"
#include "validators.hpp"

#include "stylet/io/contours_io.hpp"
#include "stylet/io/files.hpp"
#include "stylet/phantom/phantom.hpp"

#include <fmt/format.h>

#include <limits>

namespace stylet::cli {

namespace {

struct PhantomArguments {
  std::string folder;
  std::uint64_t seed = 0;
  double spacing_mm = 5.0;
};

Result<> run_phantom(const PhantomArguments& arguments, Console& console) {
  const std::filesystem::path folder = arguments.folder;
  need(check_output_folder(folder));

  const ContourSet patient = demo_patient({.seed = arguments.seed, .slice_spacing_mm = arguments.spacing_mm});
  const std::filesystem::path dicom = folder / "phantom.dcm";
  const std::filesystem::path contours = folder / "phantom.json";
  need(make_folder(folder));
  need(write_rtstruct(patient, dicom, {.name = "STYLET^PHANTOM", .id = "STYLET"}));
  need(write_contour_json(patient, contours));

  Description description = describe(patient);
  description.json["seed"] = arguments.seed;
  description.json["files"] = {dicom.string(), contours.string()};
  console.say(description.text);
  console.say(fmt::format("\nWrote {} and {}.\nNext: stylet mesh {} -o model.vtu", dicom.string(), contours.string(),
                          dicom.string()));
  return console.write_json(description.json);
}

}  // namespace

Command add_phantom_command(CLI::App& program) {
  auto arguments = std::make_shared<PhantomArguments>();
  CLI::App* app =
      program.add_subcommand("phantom", "Write the contours of the demo patient as DICOM RTSTRUCT and as JSON");
  option(app, "-o,--output", arguments->folder, "CASE/", "Folder to write phantom.dcm and phantom.json into")
      ->required();
  option(app, "--seed", arguments->seed, "N", "Number that varies the anatomy; 0 is the reference patient")
      ->check(whole_number_between(0, std::numeric_limits<long long>::max()))
      ->capture_default_str();
  option(app, "--spacing", arguments->spacing_mm, "MM", "Distance between slices [mm], 1 to 10")
      ->check(number_between(1, 10, "mm"))
      ->capture_default_str();
  return {app, [arguments](Console& console) { return run_phantom(*arguments, console); }};
}

}  // namespace stylet::cli
