// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets.hpp"

#include "reading/tasks.hpp"
#include "results/stored_run.hpp"
#include "scenario/toml_document.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

namespace stylet::fuzz {

namespace fs = std::filesystem;
using detail::FileKind;

namespace {

struct Kind {
  std::string_view task;
  FileKind kind;
  const char* name;
  const char* ending;
};

constexpr std::array kKinds{
    Kind{detail::kMask.name, FileKind::dicom, "dicom", ".dcm"},
    Kind{detail::kMask.name, FileKind::nifti, "nifti", ".nii"},
    Kind{detail::kMask.name, FileKind::nrrd, "nrrd", ".nrrd"},
    Kind{detail::kMask.name, FileKind::metaimage, "metaimage", ".mha"},
    Kind{detail::kTetMesh.name, FileKind::vtu, "vtu", ".vtu"},
    Kind{detail::kTetMesh.name, FileKind::vtk_legacy, "vtk", ".vtk"},
    Kind{detail::kTetMesh.name, FileKind::gmsh, "gmsh", ".msh"},
    Kind{detail::kTetMesh.name, FileKind::medit, "medit", ".mesh"},
    Kind{detail::kTetMesh.name, FileKind::tetgen, "tetgen", ".node"},
    Kind{detail::kSurfaces.name, FileKind::stl, "stl", ".stl"},
    Kind{detail::kSurfaces.name, FileKind::ply, "ply", ".ply"},
    Kind{detail::kSurfaces.name, FileKind::obj, "obj", ".obj"},
    Kind{detail::kSurfaces.name, FileKind::vtp, "vtp", ".vtp"},
    Kind{detail::kSurfaces.name, FileKind::glb, "glb", ".glb"},
};

/// Tasks that look into files of which others make more.
const std::map<std::string, std::string> kSeeds{
    {"only_patient_in", "parse_rtstruct"}, {"parse_patient_record", "parse_rtplan"},
    {"modality_of_dicom", "parse_rtdose"}, {"is_dicom_seg", "parse_mask-dicom"},
    {"format_of_json", "parse_plan_text"}, {"is_implant_file", "parse_implant_file"},
    {"parse_run_heads", "parse_run_file"},
};

std::string name_of(const Kind& kind) { return std::string(kind.task) + "-" + kind.name; }

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

std::vector<Target> targets_of(const std::string& task) {
  std::vector<Target> targets;
  for (const Kind& kind : kKinds)
    if (kind.task == task) targets.push_back({name_of(kind), task, kind.kind, kind.ending});
  const auto seeds = kSeeds.find(task);
  if (targets.empty())
    targets.push_back({.name = task, .task = task, .seeds = seeds != kSeeds.end() ? seeds->second : task});
  return targets;
}

std::string arguments_of(const Target& target, std::string_view input) {
  detail::WireWriter wire;
  FileKind kind = target.kind;
  double scale = 1.0;
  int volume = 0;
  std::vector<std::string> skip, others;
  std::string text;
  if (target.task == detail::kRtstruct.name || target.task == detail::kContourJson.name) wire(skip);
  if (target.task == detail::kMask.name) wire(kind, volume, skip);
  if (target.task == detail::kTetMesh.name) wire(kind, scale, text);
  if (target.task == detail::kSurfaces.name) wire(kind, scale);
  if (target.task == results::kRunHeads.name) wire(others);
  if (target.task == detail::kToml.name) {
    text = input;
    wire(text);
  }
  return wire.bytes;
}

std::string target_of(const std::string& task, std::string_view arguments) {
  FileKind kind{};
  for (const Kind& known : kKinds) {
    if (known.task != task) continue;
    detail::WireReader wire(arguments);
    wire(kind);
    if (kind == known.kind) return name_of(known);
  }
  return task;
}

std::vector<std::string> inputs_of(const std::string& task, const std::string& path, std::string_view arguments) {
  if (task == detail::kToml.name) {
    std::string text;
    detail::WireReader wire(arguments);
    wire(text);
    return {text};
  }
  std::error_code code;
  std::vector<std::string> inputs;
  for (fs::directory_iterator entry(path, code), end; !code && entry != end; entry.increment(code))
    inputs.push_back(content_of(entry->path()));
  if (!inputs.empty()) return inputs;
  const fs::path nodes = fs::path(path).replace_extension(".node"), elements = fs::path(path).replace_extension(".ele");
  const bool two_files = target_of(task, arguments).ends_with("-tetgen");
  return {two_files ? content_of(nodes) + kBetweenFiles + content_of(elements) : content_of(path)};
}

}  // namespace stylet::fuzz
