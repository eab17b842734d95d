// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"
#include "describe.hpp"
#include "output_path.hpp"
#include "validators.hpp"

#include "stylet/io/contours_io.hpp"
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
  if (Result<> writable = check_output_folder(folder); !writable) return writable;

  const ContourSet patient = demo_patient({.seed = arguments.seed, .slice_spacing_mm = arguments.spacing_mm});
  const std::filesystem::path dicom = folder / "phantom.dcm";
  const std::filesystem::path contours = folder / "phantom.json";
  if (Result<> made = make_folder(folder); !made) return made;
  if (Result<> written = write_rtstruct(patient, dicom, {.name = "STYLET^PHANTOM", .id = "STYLET"}); !written)
    return written;
  if (Result<> written = write_contour_json(patient, contours); !written) return written;

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
  app->add_option("-o,--output", arguments->folder, "Folder to write phantom.dcm and phantom.json into")
      ->type_name("CASE/")
      ->required();
  app->add_option("--seed", arguments->seed, "Number that varies the anatomy; 0 is the reference patient")
      ->type_name("N")
      ->check(whole_number_between(0, std::numeric_limits<long long>::max()))
      ->capture_default_str();
  app->add_option("--spacing", arguments->spacing_mm, "Distance between slices [mm], 1 to 10")
      ->type_name("MM")
      ->check(number_between(1, 10, "mm"))
      ->capture_default_str();
  return {app, [arguments](Console& console) { return run_phantom(*arguments, console); }};
}

}  // namespace stylet::cli
