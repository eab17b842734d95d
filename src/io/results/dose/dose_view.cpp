// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/dose_view.hpp"

#include "dose/round_number.hpp"
#include "dose/structure_look.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace stylet::results {
namespace {

constexpr double kRoom_mm = 14.0;      // around target and sources
constexpr double kLargest_mm = 120.0;  // of half the view

Eigen::AlignedBox3d box_of(const StructureDose& structure) {
  Eigen::AlignedBox3d box;
  for (const Contour& contour : structure.contours) {
    for (const Vec3& x : contour.points) box.extend(x);
  }
  for (const Vec3& x : structure.cloud) box.extend(x);
  return box;
}

/// The box around all points of a grid.
Eigen::AlignedBox3d box_of(const DoseGrid& grid) {
  Eigen::AlignedBox3d box;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 steps = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      if ((corner >> k & 1) != 0) steps[k] = grid.spacing_mm[k] * (grid.size[static_cast<std::size_t>(k)] - 1);
    }
    box.extend(Vec3(grid.origin_mm + grid.direction * steps));
  }
  return box;
}

/// A dose that stands for all: the median of the target, or of the hottest structure, or of the grid.
double usual_dose(const DoseEvaluation& evaluation) {
  double dose = 0.0;
  if (const StructureDose* target = find_region(evaluation, "prostate")) {
    dose = target->dvh.dose_of_percent(50.0);
  } else {
    for (const StructureDose& s : evaluation.structures) dose = std::max(dose, s.dvh.dose_of_percent(50.0));
  }
  if (dose > 0.0 || evaluation.grid.dose_Gy.empty()) return dose;
  std::vector<float> sorted = evaluation.grid.dose_Gy;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

}  // namespace

DoseView dose_view(const DoseEvaluation& evaluation) {
  Eigen::AlignedBox3d sources, target;
  for (const PlannedSource& source : evaluation.plan.sources) sources.extend(source.at_mm);
  if (const StructureDose* found = find_region(evaluation, "prostate")) target = box_of(*found);
  if (target.isEmpty()) target = sources;
  DoseView view;
  if (target.isEmpty()) return view;
  view.centre_mm = target.center();
  Eigen::AlignedBox3d both = target;
  both.extend(sources);
  const Vec3 reach = (both.max() - view.centre_mm).cwiseMax(view.centre_mm - both.min());
  view.half_mm = std::min(reach.maxCoeff() + kRoom_mm, kLargest_mm);
  return view;
}

std::vector<IsodoseLevel> isodose_levels(const DoseEvaluation& evaluation) {
  // From cold to hot as clinics have it; Okabe & Ito's colours differ with every kind of colour vision.
  constexpr std::array kColours{"#0072b2", "#00805d", "#d98200", "#c8102e"};
  std::vector<IsodoseLevel> levels;
  const bool prescribed = evaluation.prescription_Gy > 0.0;
  const double usual = prescribed ? evaluation.prescription_Gy : usual_dose(evaluation);
  if (!(usual > 0.0) || !std::isfinite(usual)) return levels;
  const double base = prescribed ? usual : round_below(usual);
  for (std::size_t k = 0; k < kColours.size(); ++k) {
    const double times = 0.5 * static_cast<double>(k + 1);
    levels.push_back(
        {.dose_Gy = times * base,
         .label = prescribed ? fmt::format("{:.0f} %", 100.0 * times) : fmt::format("{:g} Gy", times * base),
         .colour = kColours[k],
         .main = prescribed && k == 1});
  }
  return levels;
}

ViewedDose viewed_dose(const DoseGrid& grid, const DoseView& view, double ceiling_Gy, double most_points) {
  ViewedDose dose;
  if (grid.dose_Gy.empty() || !(ceiling_Gy > 0.0)) return dose;
  const Vec3 half = Vec3::Constant(view.half_mm);
  const Eigen::AlignedBox3d box =
      box_of(grid).intersection(Eigen::AlignedBox3d(Vec3(view.centre_mm - half), Vec3(view.centre_mm + half)));
  if (box.isEmpty()) return dose;
  dose.spacing_mm = std::max(grid.spacing_mm.minCoeff(), std::cbrt(box.volume() / most_points));
  // Along the axes of the patient the points are those of the grid, so that nothing is interpolated twice.
  Vec3 first = box.min();
  if (grid.direction.isIdentity(1e-9))
    first = grid.origin_mm.array() + ((box.min() - grid.origin_mm).array() / dose.spacing_mm).ceil() * dose.spacing_mm;
  dose.origin_mm = first;
  for (int k = 0; k < 3; ++k) {
    dose.size[static_cast<std::size_t>(k)] =
        std::max(1, static_cast<int>(std::floor((box.max()[k] - first[k]) / dose.spacing_mm + 1e-6)) + 1);
  }
  dose.ceiling_Gy = ceiling_Gy;
  constexpr double kLargestInteger = std::numeric_limits<std::uint16_t>::max();
  dose.scale_Gy = ceiling_Gy / kLargestInteger;
  for (int k = 0; k < dose.size[2]; ++k) {
    for (int j = 0; j < dose.size[1]; ++j) {
      for (int i = 0; i < dose.size[0]; ++i) {
        const double at = grid.at(first + dose.spacing_mm * Vec3(i, j, k));
        const double share = std::isfinite(at) ? std::clamp(at / ceiling_Gy, 0.0, 1.0) : 0.0;
        dose.value.push_back(static_cast<std::uint16_t>(std::lround(kLargestInteger * share)));
      }
    }
  }
  return dose;
}

}  // namespace stylet::results
