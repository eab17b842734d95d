// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/covered_percent.hpp"
#include "dose/grid_of_plan.hpp"
#include "stylet/dose/evaluate.hpp"
#include "stylet/dose/rate_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace stylet {

namespace {

double median_of(std::vector<double> values) {
  if (values.empty()) return NAN;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Leaves the first and the last frame of a grid out of the comparison where their ratios differ by more than 5 % from
/// all others, while those of the frame beside them do not: some planning systems write an end frame without meaning.
void drop_strange_ends(std::vector<double>& ratio, std::vector<Index>& frames, const DoseGrid& grid,
                       std::vector<std::string>& warnings) {
  constexpr double strange = 0.05, usual = 0.01;
  const double all = median_of(ratio);
  const auto of_frame = [&](Index frame) {
    std::vector<double> values;
    for (std::size_t p = 0; p < ratio.size(); ++p) {
      if (frames[p] == frame) values.push_back(ratio[p]);
    }
    return median_of(std::move(values)) / all;
  };
  const Index last = grid.size[2] - 1;
  for (const auto& [frame, beside] : {std::pair<Index, Index>(0, 1), std::pair<Index, Index>(last, last - 1)}) {
    if (last < 2 || !(std::abs(of_frame(frame) - 1.0) > strange) || !(std::abs(of_frame(beside) - 1.0) < usual))
      continue;
    warnings.push_back(fmt::format(
        "The {} frame of {} (z = {:.1f} mm) does not fit the frames beside it; it is left out of the comparison.",
        frame == 0 ? "lowest" : "highest", grid.file, grid.point(0, 0, frame).z()));
    std::size_t kept = 0;
    for (std::size_t p = 0; p < ratio.size(); ++p) {
      if (frames[p] == frame) continue;
      ratio[kept] = ratio[p];
      frames[kept++] = frames[p];
    }
    ratio.resize(kept);
    frames.resize(kept);
  }
}

template <class T>
void keep_only(std::vector<T>& values, const std::vector<bool>& kept) {
  std::size_t to = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (kept[k]) values[to++] = values[k];
  }
  values.resize(to);
}

/// Our dose − theirs [Gy] on the points of their grid; NaN at all others. @param places of the points in the grid
DoseGrid difference_grid(const DoseGrid& grid, const std::vector<std::size_t>& places, const std::vector<double>& ours,
                         const std::vector<double>& theirs, const Vec3& shift_mm) {
  DoseGrid difference = grid;
  difference.origin_mm += shift_mm;
  difference.notes.clear();
  std::fill(difference.dose_Gy.begin(), difference.dose_Gy.end(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t p = 0; p < places.size(); ++p)
    difference.dose_Gy[places[p]] = static_cast<float>(ours[p] - theirs[p]);
  return difference;
}

}  // namespace

Result<> compare_with_grid(DoseEvaluation& e, const DoseGrid& grid, std::span<const DoseStructure> structures,
                           const DoseOptions& options, const Vec3& shift_mm) {
  constexpr double near_mm = 4.0, least_share = 0.1, least_steps = 50.0;
  if (Result<> belongs = dose::check_belongs(e, grid, structures, options, shift_mm); !belongs) return belongs;
  double least = least_share * e.prescription_Gy;
  if (least <= 0.0) {
    std::vector<double> doses;
    std::copy_if(grid.dose_Gy.begin(), grid.dose_Gy.end(), std::back_inserter(doses), [](float d) { return d > 0.0F; });
    if (!doses.empty()) least = least_share * median_of(std::move(doses));
  }
  least = std::max(least, least_steps * grid.quantum_Gy);
  const double most = grid.largest_Gy > 0.0 ? grid.largest_Gy * (1.0 - 1e-6) : INFINITY;
  const auto gives_dose = [&](const PlannedSource& s) {
    return s.strength_U > 0.0 && (e.plan.implant == Implant::permanent || s.dwell_s > 0.0);
  };
  std::vector<Vec3> points;
  std::vector<double> theirs;
  std::vector<std::size_t> places;  // of the points in the grid
  std::vector<bool> apart;          // whether they are far enough from the sources to be compared
  std::vector<Index> frames;        // of the points that are
  std::size_t n = 0;
  for (Index k = 0; k < grid.size[2]; ++k) {
    for (Index j = 0; j < grid.size[1]; ++j) {
      for (Index i = 0; i < grid.size[0]; ++i, ++n) {
        const auto dose = static_cast<double>(grid.dose_Gy[n]);
        if (!(dose >= least) || dose <= 0.0 || dose >= most) continue;
        const Vec3 x = grid.point(i, j, k) + shift_mm;
        points.push_back(x);
        theirs.push_back(dose);
        places.push_back(n);
        apart.push_back(std::none_of(e.plan.sources.begin(), e.plan.sources.end(), [&](const PlannedSource& s) {
          return gives_dose(s) && (x - s.at_mm).squaredNorm() < near_mm * near_mm;
        }));
        if (apart.back()) frames.push_back(k);
      }
    }
  }
  if (frames.empty()) {
    return input_error(grid.file,
                       "no point of the dose grid can be compared: all lie near a source or have hardly any dose",
                       "Give the dose grid that belongs to this plan");
  }
  const DoseAtPoints dose_at = [&](std::span<const Vec3> at) { return doses_at(e, options, at); };
  Result<std::vector<double>> computed = dose_at(points);
  if (!computed) return computed.error();
  std::vector<double>& ours = *computed;
  DoseGrid difference = difference_grid(grid, places, ours, theirs, shift_mm);
  keep_only(points, apart);
  keep_only(ours, apart);
  keep_only(theirs, apart);
  std::vector<double> ratio(ours.size());
  for (std::size_t p = 0; p < ratio.size(); ++p) ratio[p] = ours[p] / theirs[p];
  drop_strange_ends(ratio, frames, grid, e.warnings);
  std::sort(ratio.begin(), ratio.end());
  const auto at = [&](double share) {
    return ratio[static_cast<std::size_t>(share * static_cast<double>(ratio.size() - 1))];
  };
  if (Result<> alike = dose::check_ratio(e, grid, at(0.5), options); !alike) return alike;
  const double global_Gy =
      e.prescription_Gy > 0.0 ? e.prescription_Gy : *std::max_element(theirs.begin(), theirs.end());
  const Result<GammaRates> gamma = gamma_rates(points, theirs, ours, dose_at, global_Gy);
  if (!gamma) return gamma.error();
  e.comparison = DoseComparison{grid.file, ratio.size(), at(0.5), at(0.01), at(0.99), *gamma, std::move(difference)};
  if (std::abs(at(0.5) - 1.0) > 0.02) {
    e.warnings.push_back(fmt::format(
        "The computed dose is {:.3f} times that of {} (median). Formalism, source model or strength may differ.",
        at(0.5), grid.file));
  }
  for (std::size_t k = 0; k < structures.size() && k < e.structures.size(); ++k) {
    const double covered = dose::covered_percent(structures[k].samples, grid, shift_mm);
    e.structures[k].covered_by_grid_percent = covered;
    if (covered < 99.5) {
      e.warnings.push_back(fmt::format(
          "The dose grid {} holds only {:.1f} % of '{}'; figures that a planning system reads from it miss the rest.",
          grid.file, covered, structures[k].name));
    }
  }
  return Ok{};
}

}  // namespace stylet
