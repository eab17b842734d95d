// SPDX-License-Identifier: GPL-3.0-or-later
#include "scenario_draft.hpp"

#include "stylet/core/version.hpp"
#include "stylet/patient/fit.hpp"
#include "stylet/patient/judged_contours.hpp"
#include "stylet/sim/scenario.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace stylet::cli {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kWidth = 100;

std::string toml_text(const std::string& text) {
  return to_string(ScenarioValue{.type = ScenarioValue::Type::text, .text = text});
}

/// Number of bytes of the first UTF-8 character of `rest`; 0 if it is not valid UTF-8.
std::size_t character_length(std::string_view rest) {
  const auto first = static_cast<unsigned char>(rest.front());
  const std::size_t length = first < 0x80                    ? 1
                             : first >= 0xC2 && first < 0xE0 ? 2
                             : first >= 0xE0 && first < 0xF0 ? 3
                             : first >= 0xF0 && first < 0xF5 ? 4
                                                             : 0;
  if (length == 0 || length > rest.size()) return 0;
  const bool whole = std::all_of(rest.begin() + 1, rest.begin() + static_cast<std::ptrdiff_t>(length),
                                 [](char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; });
  return whole ? length : 0;
}

/// Makes a text safe for a comment: replaces line ends, other control characters and bytes that are not UTF-8.
std::string harmless(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    const auto first = static_cast<unsigned char>(text.front());
    if (length == 0) {
      out += '?';
    } else {
      out += length == 1 && (first < 0x20 || first == 0x7f) ? std::string(" ") : std::string(text.substr(0, length));
    }
    text.remove_prefix(std::max<std::size_t>(1, length));
  }
  return out;
}

bool is_text(const std::string& name) { return harmless(name) == name; }

/// The text as a comment of one or more lines.
std::string comment(const std::string& text) {
  std::string out, line = "#";
  std::string rest = harmless(text);
  for (std::size_t at = 0; at < rest.size();) {
    const std::size_t blank = std::min(rest.find(' ', at), rest.size());
    const std::string word = rest.substr(at, blank - at);
    if (line.size() > 1 && line.size() + 1 + word.size() > kWidth) {
      out += line + '\n';
      line = "#";
    }
    line += ' ' + word;
    at = blank + 1;
  }
  return out + line + '\n';
}

/// A line of the table [patient.regions].
struct RegionLine {
  std::string key;     ///< name or number in the file
  std::string region;  ///< empty: the line is commented out and the user has to complete it
  std::string remark;
};

/// The parts of a draft that depend on the kind of file that the patient comes from.
struct Contents {
  std::string kind;                  ///< kind of file, such as "contours of 6 structures"
  std::vector<std::string> remarks;  ///< comments below the source
  std::vector<std::string> skip;
  std::vector<std::string> why_skip;  ///< the reason for each of `skip`
  std::vector<RegionLine> regions;
  std::vector<std::string> left_out;  ///< comments below the regions
  std::string about_regions;          ///< comment above the regions
  Eigen::AlignedBox3d target;         ///< [mm] LPS, box of the gland; empty if there is none
  std::vector<std::string> warnings;
};

std::string size_text(double volume_cc) { return fmt::format("{:.1f} cc", volume_cc); }

std::string remark_of(const StructureUse& use, double volume_cc) {
  return use.why.empty() ? size_text(volume_cc) : fmt::format("{}; {}", size_text(volume_cc), use.why);
}

/// Leaves out the structures that the mesher would use and that have a fault, until no such structure is left: another
/// one may be used in place of one that is left out.
Result<JudgedContours> judge_sound(const ContourSet& contours, MeshOptions& options, Contents& out) {
  for (;;) {
    auto judged = judge_contours(contours, options);
    if (!judged || judged->fault() == nullptr) return judged;
    for (const JudgedStructure& structure : judged->structures) {
      if (!structure.is_used() || !structure.fault) continue;
      options.skip.push_back(structure.roi->name);
      out.skip.push_back(structure.roi->name);
      out.why_skip.push_back(structure.fault->what);
    }
  }
}

/// Enters the structures that the user leaves out into the draft.
/// @return mesh options that leave them out
MeshOptions leave_out(const std::vector<std::string>& skip, Contents& out) {
  out.skip = skip;
  out.why_skip.assign(skip.size(), "named with --skip");
  MeshOptions options;
  options.skip = skip;
  return options;
}

Result<Contents> contents_of(const ContourSet& contours, const std::vector<std::string>& skip) {
  Contents out;
  MeshOptions options = leave_out(skip, out);
  const auto judged = judge_sound(contours, options, out);
  if (!judged) return judged.error();
  const StructureChoice* choice = &judged->choice;
  out.kind = fmt::format("contours of {} structure{}", contours.rois.size(), contours.rois.size() == 1 ? "" : "s");
  out.about_regions =
      "The region that each structure is taken as. Change a region here, or write skip = [\"NAME\"] above to leave a "
      "structure out.";
  out.remarks = contours.notes;
  for (const JudgedStructure& structure : judged->structures) {
    if (!structure.is_used()) continue;
    const double volume_cc = structure.slices ? structure.slices->volume_mm3() / 1000 : 0;
    if (is_target_region(structure.use.region)) {
      for (const Contour& contour : structure.roi->contours) {
        for (const Vec3& x : contour.points) out.target.extend(x);
      }
    }
    out.regions.push_back({structure.roi->name, structure.use.region, remark_of(structure.use, volume_cc)});
    if (structure.oddity) out.remarks.push_back(*structure.oddity);
    if (structure.slices && structure.slices->note) out.remarks.push_back(*structure.slices->note);
  }
  out.left_out = choice->left_out;
  if (!choice->has_target) {
    out.warnings.emplace_back(
        "No structure is recognised as the gland: name the gland's structure below [patient.regions]");
    out.about_regions = "No structure is recognised as the gland. Name the gland's structure: \"NAME\" = \"prostate\"";
    for (const StructureUse& other : choice->uses) {
      if (other.region.empty()) out.regions.push_back({other.name, "", other.why});
    }
  }
  return out;
}

struct LabelSize {
  std::int64_t voxels = 0;
  Eigen::AlignedBox3d box;  ///< [mm] LPS, box of the voxels' centres
};

std::map<int, LabelSize> sizes_of(const LabelImage& image) {
  std::map<int, LabelSize> sizes;
  std::size_t voxel = 0;
  for (Index k = 0; k < image.size[2]; ++k) {
    for (Index j = 0; j < image.size[1]; ++j) {
      for (Index i = 0; i < image.size[0]; ++i, ++voxel) {
        if (image.labels[voxel] == 0) continue;
        LabelSize& size = sizes[image.labels[voxel]];
        ++size.voxels;
        size.box.extend(image.voxel_centre(i, j, k));
      }
    }
  }
  return sizes;
}

Result<Contents> contents_of(const LabelImage& image, const std::vector<std::string>& skip) {
  Contents out;
  const auto choice = choose_structures(image, leave_out(skip, out));
  if (!choice) return choice.error();
  auto sizes = sizes_of(image);
  out.kind = fmt::format("label mask with {} label{}", sizes.size(), sizes.size() == 1 ? "" : "s");
  out.about_regions =
      choice->has_target
          ? "The region that each label is taken as."
          : "No label is recognised as the gland, therefore all labels together are taken as the gland. If you know "
            "what a label is, remove the # and write its region, for example \"peripheral_zone\", \"transition_zone\" "
            "or \"prostate\".";
  for (const StructureUse& use : choice->uses) {
    const LabelSize& size = sizes[use.number];
    if (use.region.empty()) continue;
    if (!choice->has_target || is_target_region(use.region)) out.target.extend(size.box);
    const std::string number = std::to_string(use.number);
    std::string remark = remark_of(use, static_cast<double>(size.voxels) * image.spacing.prod() / 1000);
    if (use.name != number) remark = fmt::format("'{}', {}", use.name, remark);
    out.regions.push_back({number, choice->has_target ? use.region : "", remark});
  }
  out.left_out = choice->left_out;
  return out;
}

Result<Contents> contents_of(const TetMesh& mesh, const std::vector<std::string>& /*skip*/) {
  Contents out;
  out.kind = fmt::format("tetrahedral mesh of {} nodes, used without changes", mesh.node_count());
  out.about_regions =
      "The region that each region of the mesh is taken as. You may use any other name: such a region has the tissue "
      "parameters of the surroundings.";
  std::set<std::string> taken(mesh.regions.begin(), mesh.regions.end());
  std::vector<double> volume(mesh.regions.size(), 0.0);
  std::vector<Eigen::AlignedBox3d> box(mesh.regions.size());
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const auto region = static_cast<std::size_t>(mesh.tet_region[static_cast<std::size_t>(t)]);
    volume[region] += tet_volume(mesh, t) / 1000;
    for (const Index node : mesh.tets[static_cast<std::size_t>(t)])
      box[region].extend(mesh.nodes[static_cast<std::size_t>(node)]);
  }
  bool has_target = false;
  for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
    const std::string& name = mesh.regions[r];
    std::string region = region_meant(name);
    if (region != name && !taken.insert(region).second) region = name;  // another region has this name
    const bool known = !canonical_region(name).empty();
    if (is_target_region(region)) out.target.extend(box[r]);
    has_target = has_target || is_target_region(region) || region.starts_with("label_");
    out.regions.push_back({name, region, size_text(volume[r]) + (known ? "" : "; name not recognised")});
  }
  if (!has_target) {
    out.warnings.emplace_back("No region of the mesh is the gland, so the motion of the gland is not computed");
    out.about_regions +=
        " No region is recognised as the gland: write \"prostate\" behind the region that is the gland.";
  }
  return out;
}

Result<Contents> contents_of(const std::vector<Surface>& surfaces, const std::vector<std::string>& /*skip*/) {
  Contents out;
  out.kind = fmt::format("{} triangulated surface{}", surfaces.size(), surfaces.size() == 1 ? "" : "s");
  out.warnings.emplace_back(
      "surfaces are not meshed: give contours, a label mask or a tetrahedral mesh of the same patient as source");
  out.about_regions = "The region that each surface would be taken as.";
  for (const Surface& surface : surfaces) {
    Eigen::AlignedBox3d box;
    for (const Vec3& p : surface.points) box.extend(p);
    const std::string region = canonical_region(surface.name);
    if (is_target_region(region)) out.target.extend(box);
    out.regions.push_back({surface.name, region, region.empty() ? "name not recognised" : ""});
  }
  return out;
}

/// Adds what judge_fit() says. The gland of a patient that is refused is commented out, because a region that the
/// scenario assigns insists on it.
void tell_fit(const PatientInput& patient, const DraftSource& source, Contents& out) {
  FitOptions options{.scale = source.scale};
  options.names.skip = source.skip;
  const auto findings = judge_fit(patient, options);
  for (const FitFinding& finding : findings) {
    std::string text = finding.message();
    text.pop_back();  // the draft ends the sentence
    (finding.verdict == FitVerdict::note ? out.remarks : out.warnings).push_back(text);
  }
  if (!refusal(findings, source.file)) return;
  for (RegionLine& line : out.regions) {
    if (!is_target_region(line.region)) continue;
    line.region.clear();
    line.remark += "; remove the # to insist on it";
  }
}

/// A hole half way between the target's centre and its left side, so that the needle passes beside the urethra.
struct Hole {
  std::string name;
  double left_mm = 0.0;
};

Hole hole_for(const Eigen::AlignedBox3d& target) {
  const TemplateGrid grid;
  const double half = target.isEmpty() ? 0.0 : 0.5 * target.sizes().x();
  const std::size_t middle = grid.columns.size() / 2;
  const auto beside = static_cast<std::size_t>(std::clamp(std::lround(0.5 * half / grid.pitch_mm), 0L, 4L));
  return {grid.columns[middle + beside] + grid.rows[grid.rows.size() / 2], static_cast<double>(beside) * grid.pitch_mm};
}

std::string regions_text(const Contents& contents) {
  if (contents.regions.empty()) return {};
  const bool any =
      std::any_of(contents.regions.begin(), contents.regions.end(), [](const auto& r) { return !r.region.empty(); });
  std::string out = '\n' + comment(contents.about_regions) + (any ? "[patient.regions]\n" : "#[patient.regions]\n");
  std::set<std::string> written;
  for (const RegionLine& line : contents.regions) {
    const std::string remark = harmless(line.remark);
    if (!is_text(line.key)) {
      out += comment(fmt::format("'{}' is taken as {}: {} (its name cannot be written in a scenario)", line.key,
                                 line.region, remark));
      continue;
    }
    const bool active = !line.region.empty() && written.insert(line.key).second;
    out +=
        fmt::format("{}{} = {}{}\n", active ? "" : "#", toml_text(line.key),
                    toml_text(line.region.empty() ? "prostate" : line.region), remark.empty() ? "" : "  # " + remark);
  }
  return out;
}

std::string patient_text(const Contents& contents, const DraftSource& source) {
  std::string out = fmt::format("\n[patient]\nsource = {}  # {}\n", toml_text(source.source), contents.kind);
  if (source.scale > 0.0) out += fmt::format("scale = {}  # length of the file's unit [mm]\n", source.scale);
  if (source.volume > 0) out += fmt::format("volume = {}  # number of the volume in the file, from 1\n", source.volume);
  if (!source.regions_from.empty())
    out += fmt::format("regions_from = {}  # array that is the regions\n", toml_text(source.regions_from));
  for (const std::string& note : source.notes) out += comment(note);
  for (const std::string& remark : contents.remarks) out += comment(remark);
  if (!contents.skip.empty()) {
    out += comment("Left out:");
    for (std::size_t i = 0; i < contents.skip.size(); ++i)
      out += comment(fmt::format("  {}: {}", contents.skip[i], contents.why_skip[i]));
    std::vector<std::string> names;
    std::transform(contents.skip.begin(), contents.skip.end(), std::back_inserter(names), toml_text);
    out += fmt::format("skip = [{}]\n", fmt::join(names, ", "));
  }
  return out;
}

std::string needle_text() {
  return '\n' +
         comment(
             "An 18 gauge needle. Its bevel deflects the needle to the patient's left; roll_deg below [[insertion]] "
             "turns the bevel.") +
         "[needle]\nbevel_deg = 20\n\n" + comment("The hole of the template holds the needle sideways.") +
         "[template]\nguide = true\n";
}

std::string insertion_text(const Contents& contents) {
  const Hole hole = hole_for(contents.target);
  const std::string centre = contents.target.isEmpty() ? "the patient" : "the gland";
  const std::string where = hole.left_mm > 0.0
                                ? fmt::format("hole {} is {:g} mm to the patient's left of the middle of {} (hole D4)",
                                              hole.name, hole.left_mm, centre)
                                : fmt::format("hole {} is in front of the middle of {}", hole.name, centre);
  return '\n' +
         comment(fmt::format(
             "One needle through the template, straight to superior: {}. Without depth_mm the tip goes to the far end "
             "of the gland. Repeat the table [[insertion]] for more needles.",
             where)) +
         fmt::format("[[insertion]]\nhole = \"{}\"\n#depth_mm = 60\n#speed_mm_per_s = 20", hole.name);
}

}  // namespace

std::string source_for(const fs::path& file, const fs::path& output) {
  const fs::path there = fs::absolute(file).lexically_normal();
  if (output.empty()) return there.string();
  const fs::path relative = there.lexically_relative(fs::absolute(output).lexically_normal().parent_path());
  return relative.empty() ? there.string() : relative.string();
}

Result<ScenarioDraft> draft_scenario(const PatientInput& patient, const DraftSource& source) {
  Result<Contents> contents =
      std::visit([&](const auto& content) { return contents_of(content, source.skip); }, patient);
  if (!contents) return contents.error();
  tell_fit(patient, source, *contents);
  ScenarioDraft draft;
  draft.warnings = contents->warnings;
  std::string name = fs::path(source.file).lexically_normal().stem().string();
  if (name.empty() || !is_text(name)) name = "patient";
  draft.text =
      comment(fmt::format(
          "A scenario for {}, drafted by stylet info --scenario (Stylet {}). Read it, change it, and run it with: "
          "stylet insert THIS_FILE -o out",
          source.file, version())) +
      comment(
          "All lengths are in mm. Directions are the patient's: DICOM LPS, x to the left, y to posterior, z to "
          "superior. stylet insert --print-schema prints all other keys with their defaults.");
  for (const std::string& warning : contents->warnings) draft.text += comment("Note: " + warning + '.');
  draft.text +=
      fmt::format("\nname = {}\n", toml_text(name)) + patient_text(*contents, source) + regions_text(*contents);
  for (const std::string& left_out : contents->left_out) draft.text += comment(left_out);
  draft.text += needle_text() + insertion_text(*contents);
  return draft;
}

}  // namespace stylet::cli
