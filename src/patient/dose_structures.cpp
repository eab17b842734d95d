// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/patient/dose_structures.hpp"

#include "stylet/geom/structure_names.hpp"
#include "stylet/patient/judged_contours.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet {

namespace {

constexpr double kFirstStep_mm = 1.0;  // a structure is sampled so coarsely first, to know its volume

/// Samples a structure with the step that its volume asks for.
template <class Sample>
Result<StructureSamples> sampled(double step_mm, const Sample& sample) {
  if (step_mm > 0.0) return sample(step_mm);
  Result<StructureSamples> coarse = sample(kFirstStep_mm);
  if (!coarse) return coarse;
  const double step = sampling_step_mm(coarse->volume_cc());
  return step == kFirstStep_mm ? std::move(coarse) : sample(step);
}

/// Keeps a structure, or says why it is left out.
void keep(DoseStructures& out, DoseStructure structure, Result<StructureSamples> samples) {
  if (!samples) {
    out.notes.push_back("No dose to a structure that cannot be sampled: " + samples.error().message());
  } else if (samples->points.empty()) {
    out.notes.push_back(fmt::format("No dose to '{}': its contours enclose no volume.", structure.name));
  } else {
    structure.samples = std::move(*samples);
    out.structures.push_back(std::move(structure));
  }
}

Result<> add_structures(const ContourSet& contours, const DoseStructureOptions& options, const Progress& progress,
                        DoseStructures& out) {
  MeshOptions names;
  names.regions = options.regions;
  names.skip = options.skip;
  const Result<JudgedContours> judged = judge_contours(contours, names);
  if (!judged) return judged.error();
  out.frame_of_reference = contours.frame_of_reference;
  for (std::size_t k = 0; k < judged->structures.size(); ++k) {
    const JudgedStructure& structure = judged->structures[k];
    report(progress, "structures", static_cast<double>(k) / static_cast<double>(judged->structures.size()));
    const Roi& roi = *structure.roi;
    if (is_listed(roi.name, options.skip)) continue;
    if (const Result<> good = check_roi(roi, contours.source); !good) {
      out.notes.push_back("No dose to a damaged structure: " + good.error().message());
      continue;
    }
    if (const auto odd = long_closing_side(roi)) out.notes.push_back(*odd);
    keep(out, {roi.name, structure.use.region, roi.type, {}, roi.colour, roi.contours},
         sampled(options.step_mm, [&](double step) { return sample_structure(roi, step); }));
  }
  for (const StructureUse& use : judged->choice.uses) {
    if (use.region == "prostate" && !use.why.empty())
      out.notes.push_back(fmt::format("'{}' is taken as the target: {}.", use.name, use.why));
  }
  return Ok{};
}

Result<> add_structures(const LabelImage& image, const DoseStructureOptions& options, const Progress& progress,
                        DoseStructures& out) {
  MeshOptions names;
  names.regions = options.regions;
  names.skip = options.skip;
  const Result<StructureChoice> choice = choose_structures(image, names);
  if (!choice) return choice.error();
  for (std::size_t k = 0; k < choice->uses.size(); ++k) {
    const StructureUse& use = choice->uses[k];
    report(progress, "structures", static_cast<double>(k) / static_cast<double>(choice->uses.size()));
    if (is_listed(use.name, options.skip)) continue;
    keep(out, {use.name, use.region, "", {}, {128, 128, 128}, {}},
         sampled(options.step_mm, [&](double step) { return sample_structure(image, use.number, step); }));
  }
  return Ok{};
}

Result<> add_structures(const TetMesh& mesh, const DoseStructureOptions& options, const Progress& progress,
                        DoseStructures& out) {
  for (std::size_t k = 0; k < mesh.regions.size(); ++k) {
    report(progress, "structures", static_cast<double>(k) / static_cast<double>(mesh.regions.size()));
    const std::string& name = mesh.regions[k];
    if (is_listed(name, options.skip)) continue;
    const auto assigned = options.regions.find(name);
    const std::string region = assigned != options.regions.end() ? assigned->second : canonical_region(name);
    keep(out, {name, region, "", {}, {128, 128, 128}, {}},
         sampled(options.step_mm, [&](double step) { return sample_structure(mesh, static_cast<int>(k), step); }));
  }
  return Ok{};
}

Result<> add_structures(const std::vector<Surface>&, const DoseStructureOptions&, const Progress&, DoseStructures&) {
  return input_error("structures", "the file has triangulated surfaces, which are not sampled",
                     "Give contours, a label mask or a tetrahedral mesh");
}

}  // namespace

Result<DoseStructures> dose_structures(const PatientInput& input, const DoseStructureOptions& options,
                                       const Progress& progress) {
  DoseStructures out;
  if (const auto* contours = std::get_if<ContourSet>(&input)) out.notes = contours->notes;
  if (const auto* image = std::get_if<LabelImage>(&input)) out.notes = image->notes;
  const Result<> added =
      std::visit([&](const auto& content) { return add_structures(content, options, progress, out); }, input);
  if (!added) return added.error();
  if (!out.structures.empty()) return out;
  std::string why;
  for (const std::string& note : out.notes) why += " " + note;
  return input_error("structures", "no structure has a volume." + why, "Give the structure set of this plan");
}

}  // namespace stylet
