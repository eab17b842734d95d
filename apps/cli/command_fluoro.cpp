// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"
#include "output_path.hpp"
#include "probe_text.hpp"
#include "validators.hpp"

#include "stylet/imaging/fluoroscope.hpp"
#include "stylet/io/files.hpp"
#include "stylet/io/picture_io.hpp"
#include "stylet/measure/timing.hpp"
#include "stylet/patient/imaged_patient.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace stylet::cli {

namespace {

namespace fs = std::filesystem;

struct FluoroArguments {
  std::string file;
  std::string output;
  std::string seeds;
  std::optional<double> time_s;
  std::optional<double> second_keV;
  std::vector<std::string> settings;
};

Result<> check_fluoro_output(const FluoroArguments& arguments) {
  const fs::path path = arguments.output;
  if (path.extension() != ".png" && path.extension() != ".mha")
    return input_error(
        arguments.output.empty() ? "fluoro" : arguments.output,
        arguments.output.empty() ? "no file for the picture is given" : "the name of a picture ends in .png or .mha",
        "Give -o picture.png, or -o picture.mha for grey values with their place in the patient");
  return check_output_file(path);
}

/// A picture and the processor time that the exposures took.
struct Exposed {
  GreyPicture picture;
  double cpu_ms = 0.0;
};

Exposed exposed(const TetMesh& mesh, const Moment& moment, const FluoroscopySettings& settings,
                std::optional<double> second_keV) {
  const auto unit = need(Fluoroscope::create(mesh, settings));
  Exposed result;
  result.cpu_ms = 1e3 * measure::cpu_seconds([&] { unit->expose(moment); });
  if (!second_keV) {
    result.picture = unit->picture();
    return result;
  }
  FluoroscopySettings other = settings;
  other.energy_keV = *second_keV;
  other.random += 1;  // the photons of the second exposure are other photons
  const auto second = need(Fluoroscope::create(mesh, other));
  result.cpu_ms += 1e3 * measure::cpu_seconds([&] { second->expose(moment); });
  result.picture = need(without_soft_tissue(*unit, *second));
  return result;
}

std::string title_of(const FluoroscopySettings& s, std::optional<double> second_keV) {
  std::string text = second_keV
                         ? fmt::format("X-ray, {:g} keV without soft tissue by {:g} keV", s.energy_keV, *second_keV)
                         : fmt::format("X-ray, {:g} keV", s.energy_keV);
  text += fmt::format(", C-arm at {:g} degrees", s.angle_deg);
  if (s.cranial_deg != 0.0)
    text += fmt::format(", {:g} degrees {}", std::abs(s.cranial_deg), s.cranial_deg > 0.0 ? "cranial" : "caudal");
  return text;
}

PictureMarks marks_of(const FluoroscopySettings& s, std::optional<double> second_keV) {
  PictureMarks marks;
  marks.title = title_of(s, second_keV);
  marks.notice = kPictureNotice;
  marks.bar_note = "at the gland";
  return marks;
}

Result<> run_fluoro(const FluoroArguments& arguments, Console& console) {
  need(check_fluoro_output(arguments));
  auto imaged = need(imaged_patient(arguments.file, arguments.settings, arguments.time_s, console.progress()));
  if (!arguments.seeds.empty()) {
    need(add_planned_seeds(imaged, arguments.seeds));
  }
  const Moment moment = pressed(imaged, imaged.scenario.probe);
  const FluoroscopySettings& settings = imaged.scenario.fluoroscopy;
  const auto result = exposed(imaged.mesh, moment, settings, arguments.second_keV);

  const fs::path path = arguments.output;
  if (path.has_parent_path()) {
    need(make_folder(path.parent_path()));
  }
  const GreyPicture& picture = result.picture;
  const Result<> written = path.extension() == ".png"
                               ? write_picture_png(picture, marks_of(settings, arguments.second_keV), path)
                               : write_picture_mha(std::span(&picture, 1), picture.mm_per_pixel, path);
  if (!written) return written;
  for (const std::string& note : imaged.notes) console.warn(note);
  console.say(fmt::format(
      "{}: {} × {} pixels of {:.3f} mm at the gland, {} needle{}, {} seed{}; simulated, not a medical device",
      path.string(), picture.columns, picture.rows, picture.mm_per_pixel, moment.needles.size(),
      moment.needles.size() == 1 ? "" : "s", moment.seeds.size(), moment.seeds.size() == 1 ? "" : "s"));
  const Json probe = say_probe(imaged, console);
  Json json{{"file", path.string()},
            {"case", arguments.file},
            {"time_s", moment.time_s},
            {"angle_deg", settings.angle_deg},
            {"cranial_deg", settings.cranial_deg},
            {"energy_keV", settings.energy_keV},
            {"second_energy_keV", arguments.second_keV ? Json(*arguments.second_keV) : Json()},
            {"pixels", picture.columns},
            {"mm_per_pixel", picture.mm_per_pixel},
            {"nodes", imaged.mesh.node_count()},
            {"needles", moment.needles.size()},
            {"seeds", moment.seeds.size()},
            {"probe", probe},
            {"cpu_ms", result.cpu_ms},
            {"notice", kPictureNotice}};
  return console.write_json(json);
}

}  // namespace

Command add_fluoro_command(CLI::App& program) {
  auto arguments = std::make_shared<FluoroArguments>();
  CLI::App* app = program.add_subcommand(
      "fluoro", "Make an X-ray picture of the deformed patient with needle and seeds. Not a medical device");
  option(app, "CASE", arguments->file, "SCENARIO.toml|run.h5",
         "Scenario file or saved model, whose patient is shown at rest, or the run.h5 of a recording")
      ->required();
  option(app, "-o,--output", arguments->output, "FILE",
         "GreyPicture: .png with a scale, or .mha with grey values and their place in the patient");
  option(app, "--time", arguments->time_s, "S", "Moment of the recording [s] (default: when the needle is deepest)");
  // Before the short options, which add to the same list.
  settings_option(app, arguments->settings, "fluoroscopy.pixels=1024");
  const auto shorthand = [&](const char* option, const char* key, double low, double high, const char* unit,
                             const char* meaning) {
    app->add_option_function<std::string>(
           option,
           [arguments, key](const std::string& value) {
             arguments->settings.push_back(fmt::format("fluoroscopy.{}={}", key, value));
           },
           fmt::format("{}; the same as --set fluoroscopy.{}=…", meaning, key))
        ->type_name(unit)
        ->check(number_between(low, high, unit));
  };
  shorthand("--angle", "angle_deg", -180, 180, "DEG",
            "Angle of the C-arm; positive = the detector goes to the patient's left");
  shorthand("--cranial", "cranial_deg", -60, 60, "DEG", "Angle of the C-arm; positive = the detector goes superior");
  shorthand("--energy", "energy_keV", 20, 150, "KEV", "Energy of the photons");
  option(app, "--second-energy", arguments->second_keV, "KEV",
         "Make a second exposure with this higher energy and subtract it, so that soft tissue vanishes")
      ->check(number_between(20, 150, "keV"));
  option(app, "--seeds", arguments->seeds, "PLAN",
         "Also show the seeds of this plan at their planned places in the tissue (DICOM RTPLAN, JSON or CSV)");
  return {app, [arguments](Console& console) { return run_fluoro(*arguments, console); }};
}

}  // namespace stylet::cli
