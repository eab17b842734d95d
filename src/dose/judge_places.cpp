// SPDX-License-Identifier: GPL-3.0-or-later
// Rules about where the sources are: to each other and to the target.
#include "dose/rules.hpp"

#include <Eigen/Geometry>

#include <algorithm>

namespace stylet::dose {

namespace {

constexpr std::size_t kLooked = 20000;  // samples of a structure that are looked at

/// Smallest distance of each source from some samples of the structures that `counts` chooses [mm].
template <class Counts>
std::vector<double> distances(const Judged& judged, const Counts& counts) {
  std::vector<double> nearest(judged.plan.sources.size(), INFINITY);
  for (const DoseStructure& structure : judged.structures) {
    if (!counts(structure)) continue;
    const std::vector<Vec3>& points = structure.samples.points;
    const std::size_t stride = std::max<std::size_t>(1, points.size() / kLooked);
    for (std::size_t p = 0; p < points.size(); p += stride) {
      for (std::size_t k = 0; k < nearest.size(); ++k)
        nearest[k] = std::min(nearest[k], (points[p] - judged.plan.sources[k].at_mm).squaredNorm());
    }
  }
  for (double& distance : nearest) distance = std::sqrt(distance);
  return nearest;
}

bool is_target(const DoseStructure& structure) { return structure.region == "prostate"; }

void judge_each_other(const Judged& judged, Findings& found) {
  const std::vector<PlannedSource>& sources = judged.plan.sources;
  double thick = INFINITY;
  for (const SourceModel& model : judged.models) {
    if (model.outer_diameter_mm > 0.0) thick = std::min(thick, model.outer_diameter_mm);
  }
  if (!std::isfinite(thick)) thick = 0.5;
  std::size_t twins = 0, overlapping = 0;
  std::string first;
  for (std::size_t a = 0; a < sources.size(); ++a) {
    bool twin = false, overlaps = false;
    for (std::size_t b = 0; b < a; ++b) {
      const double distance = (sources[a].at_mm - sources[b].at_mm).norm();
      twin = twin || distance < kSamePlace_mm;
      overlaps = overlaps || (distance >= kSamePlace_mm && distance < thick);
      if (first.empty() && distance < thick) first = fmt::format("sources {} and {}", b + 1, a + 1);
    }
    twins += twin ? 1 : 0;
    overlapping += overlaps ? 1 : 0;
  }
  const char* name = judged.temporary() ? "dwell positions" : "seeds";
  if (twins > 0) {
    found.warn(Rule::same_place, fmt::format("{} {} stand at the place of another one (such as {}); all are counted",
                                             twins, name, first));
  }
  if (overlapping > 0 && !judged.temporary()) {
    found.warn(Rule::overlap, fmt::format("{} seed{} nearer to another one than the capsule's diameter of {:g} mm "
                                          "(such as {}); check the unit of the coordinates",
                                          overlapping, overlapping == 1 ? " is" : "s are", thick, first));
  }
  Eigen::AlignedBox3d box;
  for (const PlannedSource& s : sources) box.extend(s.at_mm);
  const double width = box.sizes().maxCoeff();
  if (width > kWidest_mm || (sources.size() >= 10 && width < kNarrowest_mm)) {
    found.warn(Rule::extent, fmt::format("The {} {} are spread over {:.3g} mm; check the unit of the coordinates (mm)",
                                         sources.size(), name, width));
  }
}

void judge_target(const Judged& judged, Findings& found) {
  const auto target = std::find_if(judged.structures.begin(), judged.structures.end(), is_target);
  const bool has_target = target != judged.structures.end();
  const double volume = has_target ? target->samples.volume_cc() : 0.0;
  if (!has_target) {
    found.warn(Rule::target,
               "No structure is taken as the target, so neither figures of a target nor its goals are "
               "given; --region NAME=prostate names it");
  } else if (!kTarget_cc.plausible(volume)) {
    found.warn(Rule::target, fmt::format("The target '{}' has {:.3g} cc, {:g} … {:g} cc is expected", target->name,
                                         volume, kTarget_cc.low, kTarget_cc.high));
  }
  const std::vector<double> away =
      distances(judged, [&](const DoseStructure& s) { return !has_target || is_target(s); });
  const double nearest = *std::min_element(away.begin(), away.end());
  if (nearest > kOtherPatient_mm) {
    found.refuse(Rule::other_patient, judged.plan.file,
                 fmt::format("the nearest source is {:.0f} mm away from {}", nearest,
                             has_target ? fmt::format("the target '{}'", target->name) : "all structures"),
                 "Give the structures of this plan's patient, in the same frame of reference");
    return;
  }
  if (!has_target) return;
  const auto far = std::count_if(away.begin(), away.end(), [](double d) { return d > kFarFromTarget_mm; });
  const auto beside = std::count_if(away.begin(), away.end(), [](double d) { return d <= kBesideTarget_mm; });
  const auto furthest = std::max_element(away.begin(), away.end());
  if (far > 0) {
    found.warn(Rule::far_from_target,
               fmt::format("{} of {} sources lie more than {:g} mm from the target '{}'; source {} is {:.0f} mm away",
                           far, away.size(), kFarFromTarget_mm, target->name, furthest - away.begin() + 1, *furthest));
  } else if (2 * static_cast<std::size_t>(beside) < away.size()) {
    found.warn(Rule::far_from_target, fmt::format("Only {} of {} sources lie within {:g} mm of the target '{}'", beside,
                                                  away.size(), kBesideTarget_mm, target->name));
  }
  const bool few = !judged.temporary() && away.size() < kFewSeeds && volume > 5.0;
  if (few) {
    found.warn(Rule::number_of_sources, fmt::format("The plan has {} seed{} for a target of {:.3g} cc", away.size(),
                                                    away.size() > 1 ? "s" : "", volume));
  }
}

}  // namespace

void judge_places(const Judged& judged, Findings& found) {
  if (judged.plan.sources.empty()) return;
  judge_each_other(judged, found);
  if (!judged.structures.empty()) judge_target(judged, found);
  const std::size_t many = judged.temporary() ? kManyDwells : kManySeeds;
  if (judged.plan.sources.size() > many) {
    found.warn(Rule::number_of_sources, fmt::format("The plan has {} {}", judged.plan.sources.size(),
                                                    judged.temporary() ? "dwell positions" : "seeds"));
  }
}

}  // namespace stylet::dose
