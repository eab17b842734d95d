// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"
#include "describe.hpp"
#include "mesh_report.hpp"
#include "output_path.hpp"
#include "validators.hpp"

#include "stylet/geom/flat_tets.hpp"
#include "stylet/io/files.hpp"
#include "stylet/patient/patient_file.hpp"
#include "stylet/patient/patient_mesh.hpp"
#include "stylet/sim/choices.hpp"

#include <fmt/format.h>

#include <chrono>

namespace stylet::cli {

namespace {

constexpr Index kFewestNodes = 100;
constexpr Index kMostNodes = 1'000'000;

using RegionNames = std::map<std::string, std::string>;  ///< name in the input → name in the model

struct MeshArguments {
  std::string input;
  std::string output;
  Index nodes = 0;     ///< 0 = not given
  std::string preset;  ///< empty = not given
  double scale = 0;    ///< 0 = not given
  int volume = 0;      ///< 0 = not given
  std::string regions_from;
  std::vector<std::string> regions;
  std::vector<std::string> skip;
  double cull_mm = -1;  ///< < 0 = not given
  bool no_band = false;
};

/// Parses arguments NAME=CANONICAL.
RegionNames parse_regions(const std::vector<std::string>& arguments) {
  RegionNames regions;
  for (const std::string& argument : arguments) {
    const std::size_t split = argument.rfind('=');
    if (split == std::string::npos || split == 0 || split + 1 == argument.size()) {
      throw Failed{input_error(fmt::format("--region {}", argument), "NAME=CANONICAL is expected",
                               "Write e.g. --region 'PTV 1=prostate'")};
    }
    if (!regions.emplace(argument.substr(0, split), argument.substr(split + 1)).second) {
      throw Failed{
          input_error(fmt::format("--region {}", argument), "this name is given twice", "Give each name only once")};
    }
  }
  return regions;
}

/// The error for an option that has no meaning for this kind of input.
Error pointless(const MeshArguments& arguments, const char* option, const char* kind) {
  return input_error(arguments.input, fmt::format("{} has no meaning for {}", option, kind),
                     fmt::format("Leave {} out", option));
}

/// Options of the mesher, from the command line.
MeshOptions mesher_options(const MeshArguments& arguments, const RegionNames& regions) {
  MeshOptions options;
  options.preset = choice<MeshPreset>(arguments.preset).value_or(MeshPreset::standard);
  options.nodes = arguments.nodes;
  options.regions = regions;
  options.skip = arguments.skip;
  options.stiff_band = !arguments.no_band;
  if (arguments.cull_mm >= 0) options.cull_tolerance_mm = arguments.cull_mm;
  return options;
}

Result<MeshedAnatomy> model_of(const ContourSet& contours, const MeshArguments& arguments, const MeshOptions& options,
                               Console& console) {
  if (arguments.scale > 0) return pointless(arguments, "--scale", "contours, which are in mm");
  return mesh_contours(contours, options, console.progress());
}

Result<MeshedAnatomy> model_of(const LabelImage& image, const MeshArguments& arguments, const MeshOptions& options,
                               Console& console) {
  if (arguments.scale > 0) return pointless(arguments, "--scale", "a mask, which is in mm");
  if (arguments.cull_mm >= 0) return pointless(arguments, "--cull", "a mask, which has no contour points");
  return mesh_labels(image, options, console.progress());
}

/// A mesh from a file is used without changes, but its regions may get other names.
Result<MeshedAnatomy> model_of(const TetMesh& mesh, const MeshArguments& arguments, const MeshOptions& options,
                               Console&) {
  constexpr const char* kind = "a tetrahedral mesh, which is used without changes";
  if (arguments.nodes > 0) return pointless(arguments, "--nodes", kind);
  if (!arguments.preset.empty()) return pointless(arguments, "--preset", kind);
  if (arguments.cull_mm >= 0) return pointless(arguments, "--cull", kind);
  if (arguments.no_band) return pointless(arguments, "--no-band", kind);
  if (!arguments.skip.empty()) return pointless(arguments, "--skip", kind);

  auto out = take_mesh(mesh, options.regions, arguments.input);
  if (out) out->report.notes.emplace_back("the tetrahedral mesh was checked and converted without changes");
  return out;
}

Result<MeshedAnatomy> model_of(const std::vector<Surface>& surfaces, const MeshArguments& arguments, const MeshOptions&,
                               Console&) {
  return input_error(
      arguments.input,
      fmt::format("the file contains {} triangulated surface{}; surfaces are not meshed", surfaces.size(),
                  surfaces.size() == 1 ? "" : "s"),
      "Give contours (DICOM RTSTRUCT, contour JSON), a label mask (NIfTI, NRRD, MetaImage, DICOM SEG) or a "
      "tetrahedral mesh");
}

Result<> run_mesh(const MeshArguments& arguments, Console& console) {
  const std::filesystem::path output = arguments.output;
  if (output.extension() != ".vtu") {
    return input_error(arguments.output, "the model is written as VTU", "Give a name that ends in .vtu");
  }
  need(check_output_file(output));

  const auto regions = parse_regions(arguments.regions);

  const MeshOptions options = mesher_options(arguments, regions);

  const auto start = std::chrono::steady_clock::now();
  const auto input =
      need(read_patient(arguments.input, {.scale = arguments.scale, .regions_from = arguments.regions_from}, options,
                        {.volume = arguments.volume}));
  auto model = need(
      std::visit([&](const auto& content) { return model_of(content, arguments, options, console); }, input.content));
  model.report.notes.insert(model.report.notes.begin(), input.notes.begin(), input.notes.end());
  model.report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  need(make_folder(output.has_parent_path() ? output.parent_path() : "."));
  need(write_vtu(model.mesh, output));

  std::vector<std::string> warnings = input.warnings;
  if (const std::string flat = nearly_flat_warning(model.mesh); !flat.empty()) warnings.push_back(flat);
  for (const std::string& warning : warnings) console.warn(arguments.output + ": " + warning);
  console.say(fmt::format("{} → {}", arguments.input, arguments.output));
  console.say(report_text(model.report));
  Json json = {{"input", arguments.input}, {"output", arguments.output}};
  json.update(report_json(model.report));
  json["warnings"] = warnings;
  return console.write_json(json);
}

}  // namespace

Command add_mesh_command(CLI::App& program) {
  auto arguments = std::make_shared<MeshArguments>();
  CLI::App* app = program.add_subcommand(
      "mesh", "Mesh contours or a label mask with tetrahedra, or check and convert a tetrahedral mesh");
  app->add_option("INPUT", arguments->input,
                  "Contours (DICOM RTSTRUCT or a folder with one, contour JSON), label mask (NIfTI, NRRD, MetaImage, "
                  "DICOM SEG) or tetrahedral mesh (VTU, legacy VTK, gmsh MSH, MEDIT, TetGen)")
      ->required();
  option(app, "-o,--output", arguments->output, "MODEL.vtu", "Model to write")->required();
  option(app, "--nodes", arguments->nodes, "N",
         "Number of nodes; the mesh has this number within 3 % (default: the number of the preset)")
      ->check(whole_number_between(kFewestNodes, kMostNodes));
  option(app, "--preset", arguments->preset, "standard|paper",
         "standard: all anatomy, about 3,000 nodes; paper: prostate and surroundings only, 570 nodes")
      ->check(one_of({"standard", "paper"}));
  option(app, "--scale", arguments->scale, "S",
         "Unit of length of a mesh file in mm, e.g. 1000 for metres (default: as the file says)")
      ->check(number_between(1e-6, 1e6, "mm"));
  add_volume_option(*app, arguments->volume);
  add_regions_from_option(*app, arguments->regions_from);
  repeated_option(app, "--region", arguments->regions, "NAME=CANONICAL",
                  "Take the structure, label or region NAME as CANONICAL, e.g. 'PTV 1=prostate' or 2=prostate; may be "
                  "repeated, also to make one region of several; the others are recognised by their names");
  repeated_option(app, "--skip", arguments->skip, "NAME",
                  "Leave out the structure or label NAME, for example because it is drawn wrongly; may be repeated");
  option(app, "--cull", arguments->cull_mm, "MM",
         "Drop a contour point if it is closer than this to the contour without it [mm] (default: 0.3)")
      ->check(number_between(0, 5, "mm"));
  app->add_flag("--no-band", arguments->no_band,
                "Do not add the stiff band that holds the gland if the input has no pubic arch");
  return {app, [arguments](Console& console) { return run_mesh(*arguments, console); }};
}

}  // namespace stylet::cli
