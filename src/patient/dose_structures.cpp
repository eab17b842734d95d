// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/patient/dose_structures.hpp"

#include "stylet/geom/quality.hpp"
#include "stylet/geom/structure_names.hpp"
#include "stylet/patient/judged_contours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

constexpr double kSameVolume = 0.03;   // relative difference between the volume of a structure and of its samples
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

/// Keeps a structure, or says why it is left out. A volume of the samples that differs from that of the structure is
/// said.
void keep(DoseStructures& out, DoseStructure structure, Result<StructureSamples> samples, double volume_cc) {
  if (!samples) {
    out.notes.push_back("No dose to a structure that cannot be sampled: " + samples.error().message());
  } else if (samples->points.empty()) {
    out.notes.push_back(fmt::format("No dose to '{}': its contours enclose no volume.", structure.name));
  } else {
    const double difference = samples->volume_cc() / volume_cc - 1;
    if (!(std::abs(difference) <= kSameVolume)) {
      out.notes.push_back(
          fmt::format("The samples of '{}' stand for {:.3f} cc, {:+.1f} % more than its {:.3f} cc: use a smaller "
                      "distance of samples (--step).",
                      structure.name, samples->volume_cc(), 100 * difference, volume_cc));
    }
    structure.samples = std::move(*samples);
    out.structures.push_back(std::move(structure));
  }
}

double volume_cc(const LabelImage& image, int label) {
  const auto voxels = std::count(image.labels.begin(), image.labels.end(), label);
  return static_cast<double>(voxels) * image.spacing.prod() / 1000;
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
    if (structure.fault) {
      out.notes.push_back("No dose to a damaged structure: " + structure.fault->message());
      continue;
    }
    if (structure.oddity) out.notes.push_back(*structure.oddity);
    if (structure.slices->note) out.notes.push_back(*structure.slices->note);
    keep(out, {roi.name, structure.use.region, roi.type, {}, roi.colour, roi.contours},
         sampled(options.step_mm, [&](double step) { return sample_structure(roi, step); }),
         structure.slices->volume_mm3() / 1000);
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
         sampled(options.step_mm, [&](double step) { return sample_structure(image, use.number, step); }),
         volume_cc(image, use.number));
  }
  return Ok{};
}

Result<> add_structures(const TetMesh& mesh, const DoseStructureOptions& options, const Progress& progress,
                        DoseStructures& out) {
  const std::vector<double> volumes = mesh_quality(mesh).region_volume_cc;
  for (std::size_t k = 0; k < mesh.regions.size(); ++k) {
    report(progress, "structures", static_cast<double>(k) / static_cast<double>(mesh.regions.size()));
    const std::string& name = mesh.regions[k];
    if (is_listed(name, options.skip)) continue;
    std::string region = canonical_region(name);
    for (const auto& [word, assigned] : options.regions) {
      if (!find_region(std::vector{name}, word).empty()) region = assigned;
    }
    keep(out, {name, region, "", {}, {128, 128, 128}, {}},
         sampled(options.step_mm, [&](double step) { return sample_structure(mesh, static_cast<int>(k), step); }),
         volumes[k]);
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
