// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"
#include "output_path.hpp"
#include "probe_text.hpp"
#include "validators.hpp"

#include "stylet/geom/centroid.hpp"
#include "stylet/imaging/scan_conversion.hpp"
#include "stylet/imaging/ultrasound_scanner.hpp"
#include "stylet/io/files.hpp"
#include "stylet/io/picture_io.hpp"
#include "stylet/measure/timing.hpp"
#include "stylet/patient/imaged_patient.hpp"
#include "stylet/probe/probe_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace stylet::cli {

namespace {

namespace fs = std::filesystem;

struct ImageArguments {
  std::string file, output, array, seeds;
  std::vector<std::string> settings;
  double z_mm = std::numeric_limits<double>::quiet_NaN();
  double time_s = std::numeric_limits<double>::quiet_NaN();
  double pixel_mm = 0.2;
  bool all = false, grid = false;
};

/// A picture that has been made, and where.
struct MadePicture {
  GreyPicture picture;
  UltrasoundBeams beams;
  double z_mm = 0.0;
  double cpu_ms = 0.0;
};

const char* name_of(UltrasoundArray array) { return array == UltrasoundArray::transverse ? "transverse" : "sagittal"; }

std::optional<double> given(double value) { return std::isnan(value) ? std::nullopt : std::optional<double>(value); }

Result<> check_arguments(const ImageArguments& arguments) {
  const std::string ending = fs::path(arguments.output).extension().string();
  if (ending != ".png" && ending != ".mha")
    return input_error(arguments.output, fmt::format("the ending '{}' names no format of pictures", ending),
                       "Give a name that ends in .png or .mha");
  if (arguments.grid && ending == ".mha")
    return input_error("--template", "a volume has no marks", "Leave --template out, or write a .png file");
  if (arguments.all && given(arguments.z_mm))
    return input_error("--z", "with --all the planes go through the whole gland", "Leave out --z or --all");
  return check_output_file(arguments.output);
}

/// The depths of the stepper at which its planes meet the gland, from apex to base [mm] LPS.
std::vector<double> planes_through(const ImagedPatient& patient, double step_mm) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t t = 0; t < patient.mesh.tets.size(); ++t) {
    const auto& glands = patient.gland_regions;
    if (std::find(glands.begin(), glands.end(), patient.mesh.tet_region[t]) == glands.end()) continue;
    for (const Index node : patient.mesh.tets[t]) {
      const double z = patient.mesh.nodes[static_cast<std::size_t>(node)].z();
      low = std::min(low, z);
      high = std::max(high, z);
    }
  }
  // The planes count from the base, where a plan of the stepper begins.
  std::vector<double> planes;
  for (double z = high; z > low - step_mm; z -= step_mm) planes.push_back(z);
  std::reverse(planes.begin(), planes.end());
  return planes;
}

/// The directions of a picture, in words.
const char* directions_of(ProbeKind kind, UltrasoundArray array) {
  const bool transverse = array == UltrasoundArray::transverse;
  if (kind == ProbeKind::endfire)
    return transverse ? "superior up, patient's left at the right" : "superior up, anterior at the right";
  return transverse ? "anterior up, patient's left at the right" : "anterior up, superior at the left";
}

PictureMarks marks_of(const MadePicture& made, const ImageArguments& arguments, const ImagedPatient& patient,
                      ProbeKind kind, UltrasoundArray array) {
  PictureMarks marks;
  const GreyPicture& picture = made.picture;
  const auto place = [&](const Vec3& x) {
    const Vec3 from = (x - picture.corner_mm) / picture.mm_per_pixel;
    return std::array<double, 2>{from.dot(picture.right), from.dot(picture.down)};
  };
  marks.surface_row = place(made.beams.point_mm(0.5 * (made.beams.lines - 1), 0.0))[1];
  marks.title = fmt::format("{}, z = {:.1f} mm; {}", name_of(array), made.z_mm, directions_of(kind, array));
  marks.notice = kPictureNotice;
  if (!arguments.grid) return marks;
  const TemplateGrid& grid = patient.scenario.grid;
  const Vec3 target = centroid(patient.mesh, patient.gland_regions);
  const double x = grid.centre_mm ? (*grid.centre_mm)[0] : target.x();
  const double y = grid.centre_mm ? (*grid.centre_mm)[1] : target.y();
  const Vec3 normal = made.beams.normal();
  for (const std::string& row : grid.rows) {
    for (const std::string& column : grid.columns) {
      const auto offset = grid.offset_mm(column + row);
      if (!offset || std::abs(normal.z()) < 0.5) continue;
      // Needles through the template run along z.
      Vec3 hole(x + (*offset)[0], y - (*offset)[1], 0.0);
      hole.z() = normal.dot(made.beams.origin_mm - hole) / normal.z();
      marks.dots.push_back(place(hole));
    }
  }
  return marks;
}

/// Name of picture number k of several: us.png becomes us_01.png.
fs::path numbered(const fs::path& path, std::size_t k) {
  return path.parent_path() / fmt::format("{}_{:02}{}", path.stem().string(), k + 1, path.extension().string());
}

Json rows_of(const Eigen::Matrix4d& matrix) {
  Json rows = Json::array();
  for (int i = 0; i < 4; ++i) {
    Json row = Json::array();
    for (int k = 0; k < 4; ++k) row.push_back(matrix(i, k));
    rows.push_back(row);
  }
  return rows;
}

std::vector<MadePicture> make(const ImageArguments& arguments, const ImagedPatient& patient, ProbeKind kind,
                              UltrasoundArray array) {
  const auto seat = need(probe_seat(patient.mesh, patient.gland_regions, arguments.file));
  auto scanner = need(UltrasoundScanner::create(patient.mesh, patient.echoes, patient.scenario.ultrasound));
  ProbeSettings probe = patient.scenario.probe;
  probe.kind = kind;
  std::vector<double> planes{probe.depth_mm.value_or(seat.gland_mm)};
  if (arguments.all) planes = planes_through(patient, probe.step_mm);
  ScanConversion conversion(arguments.pixel_mm);
  std::vector<MadePicture> made;
  for (const double z : planes) {
    probe.depth_mm = z;
    const Moment moment = pressed(patient, probe);
    const double before = measure::thread_cpu_s();
    const PolarPicture polar = scanner.scan(moment, kind, probe_place(probe, seat), array);
    const double cpu_ms = 1e3 * (measure::thread_cpu_s() - before);
    made.push_back({conversion.convert(polar), polar.beams, z, cpu_ms});
  }
  return made;
}

Result<> run_image(const ImageArguments& arguments, Console& console) {
  need(check_arguments(arguments));
  std::vector<std::string> settings_of_probe = arguments.settings;
  if (const auto z = given(arguments.z_mm)) settings_of_probe.push_back(fmt::format("probe.depth_mm={}", *z));
  auto patient = need(imaged_patient(arguments.file, settings_of_probe, given(arguments.time_s), console.progress()));
  if (!arguments.seeds.empty()) need(add_planned_seeds(patient, arguments.seeds));
  UltrasoundArray array = patient.scenario.ultrasound.array;
  if (!arguments.array.empty())
    array = arguments.array == "sagittal" ? UltrasoundArray::sagittal : UltrasoundArray::transverse;
  const bool has_probe = patient.scenario.probe.kind != ProbeKind::none;
  const ProbeKind kind = has_probe ? patient.scenario.probe.kind : ProbeKind::biplane;
  if (array == UltrasoundArray::sagittal && (arguments.all || arguments.grid))
    return input_error(arguments.all ? "--all" : "--template", "it belongs to transverse pictures",
                       "Leave it out, or give --array transverse");
  const auto made = make(arguments, patient, kind, array);
  for (const std::string& note : patient.notes) console.warn(note);
  if (!has_probe)
    console.detail("The scenario has no probe; the pictures are made as if one of two planes lay in the rectum");

  const fs::path output = arguments.output;
  const bool volume = output.extension() == ".mha";
  if (output.has_parent_path()) need(make_folder(output.parent_path()));
  Json pictures = Json::array();
  for (std::size_t k = 0; k < made.size(); ++k) {
    const MadePicture& one = made[k];
    const fs::path path = arguments.all && !volume ? numbered(output, k) : output;
    if (!volume) {
      need(write_picture_png(one.picture, marks_of(one, arguments, patient, kind, array), path));
    }
    pictures.push_back({{"file", path.string()},
                        {"z_mm", one.z_mm},
                        {"columns", one.picture.columns},
                        {"rows", one.picture.rows},
                        {"mm_per_pixel", one.picture.mm_per_pixel},
                        {"pixel_to_lps", rows_of(one.picture.pixel_to_lps())},
                        {"cpu_ms", one.cpu_ms}});
  }
  if (volume) {
    std::vector<GreyPicture> planes;
    for (const MadePicture& one : made) planes.push_back(one.picture);
    const double thickness = arguments.all ? patient.scenario.probe.step_mm : patient.scenario.ultrasound.elevation_mm;
    need(write_picture_mha(planes, thickness, output));
  }
  const UltrasoundSettings& settings = patient.scenario.ultrasound;
  console.say(fmt::format("{} picture{} ({} array, {} lines of {} samples, {:.1f} ms each) → {}", made.size(),
                          made.size() == 1 ? "" : "s", name_of(array), settings.lines, settings.samples,
                          made.back().cpu_ms, pictures.back()["file"].get<std::string>()));
  const Json probe = say_probe(patient, console);
  console.say("The pictures are simulated. Not a medical device.");
  return console.write_json({{"notice", kPictureNotice},
                             {"array", name_of(array)},
                             {"time_s", patient.moment.time_s},
                             {"nodes", patient.mesh.node_count()},
                             {"lines", settings.lines},
                             {"samples", settings.samples},
                             {"needles", patient.moment.needles.size()},
                             {"seeds", patient.moment.seeds.size()},
                             {"probe", probe},
                             {"pictures", pictures}});
}

}  // namespace

Command add_image_command(CLI::App& program) {
  auto arguments = std::make_shared<ImageArguments>();
  CLI::App* app = program.add_subcommand(
      "image",
      "Make ultrasound pictures of a patient at rest, or of a recorded run, as a transrectal probe shows them");
  option(app, "CASE", arguments->file, "SCENARIO.toml|run.h5",
         "Scenario (TOML): the patient at rest, without a needle; or the run.h5 of a run")
      ->required();
  option(app, "-o,--output", arguments->output, "FILE",
         "Picture: .png with a scale, or .mha with its place in the patient; with --all several .png or one "
         "volume")
      ->required();
  option(app, "--array", arguments->array, "WORD", "Array of the probe (default: ultrasound.array of the scenario)")
      ->check(one_of({"transverse", "sagittal"}));
  option(app, "--z", arguments->z_mm, "MM", "LPS z of the transverse array in mm; the same as --set probe.depth_mm=MM")
      ->check(number_between(-1e4, 1e4, "mm"));
  option(app, "--time", arguments->time_s, "S", "Time of a recorded run in s (default: when the needle was deepest)")
      ->check(number_between(0, 1e6, "s"));
  option(app, "--seeds", arguments->seeds, "PLAN",
         "Also show the seeds of this plan at their planned places in the tissue (DICOM RTPLAN, JSON or CSV)");
  app->add_flag("--all", arguments->all, "All planes of the stepper through the gland, probe.step_mm apart");
  app->add_flag("--template", arguments->grid, "Draw the template's holes as dots on a transverse picture");
  option(app, "--pixel", arguments->pixel_mm, "MM", "Side of a pixel in mm (default: 0.2)")
      ->check(number_between(0.05, 2, "mm"));
  settings_option(app, arguments->settings, "probe.roll_deg=20");
  return {app, [arguments](Console& console) { return run_image(*arguments, console); }};
}

}  // namespace stylet::cli
