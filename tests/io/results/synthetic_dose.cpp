// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic_dose.hpp"

#include "stylet/dose/known_sources.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stylet::testing {
namespace {

constexpr double kPrescription_Gy = 145.0;
const Vec3 kCentre(2.0, -30.0, 15.0);
const Vec3 kHalfAxes(25.0, 18.0, 21.0);

/// A structure of ellipses in transverse planes every 3 mm.
template <class HalfAxes, class Centre>
std::vector<Contour> ellipses(double from_mm, double to_mm, HalfAxes half_axes, Centre centre) {
  constexpr int kCorners = 48;
  std::vector<Contour> contours;
  for (double z = from_mm; z <= to_mm + 1e-9; z += 3.0) {
    const Eigen::Vector2d half = half_axes(z);
    if (half.minCoeff() < 1.0) continue;
    Contour contour;
    for (int k = 0; k < kCorners; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / kCorners;
      contour.points.push_back(centre(z) + Vec3(half.x() * std::cos(angle), half.y() * std::sin(angle), 0.0));
    }
    contours.push_back(std::move(contour));
  }
  return contours;
}

std::vector<Contour> prostate() {
  return ellipses(
      kCentre.z() - 19.5, kCentre.z() + 19.5,
      [](double z) {
        const double share = std::sqrt(std::max(0.0, 1.0 - std::pow((z - kCentre.z()) / kHalfAxes.z(), 2)));
        return Eigen::Vector2d(share * kHalfAxes.x(), share * kHalfAxes.y());
      },
      [](double z) { return Vec3(kCentre.x(), kCentre.y(), z); });
}

std::vector<Contour> urethra() {
  return ellipses(
      kCentre.z() - 25.5, kCentre.z() + 22.5, [](double) { return Eigen::Vector2d(3.0, 3.0); },
      [](double z) { return Vec3(kCentre.x(), kCentre.y() - 2.0 + 0.004 * std::pow(z - kCentre.z(), 2), z); });
}

std::vector<Contour> rectum() {
  return ellipses(
      kCentre.z() - 33.0, kCentre.z() + 30.0, [](double) { return Eigen::Vector2d(15.0, 10.0); },
      [](double z) { return Vec3(kCentre.x(), kCentre.y() + 30.0, z); });
}

/// The 44 places of a grid of 10 mm that are nearest the centre, in the measure of the ellipsoid.
std::vector<PlannedSource> seeds() {
  const auto depth = [](const Vec3& x) { return (x - kCentre).cwiseQuotient(kHalfAxes).norm(); };
  std::vector<PlannedSource> sources;
  for (int k = -2; k <= 2; ++k) {
    for (int j = -2; j <= 1; ++j) {
      for (int i = -3; i <= 2; ++i) {
        PlannedSource seed;
        seed.at_mm = kCentre + 10.0 * Vec3(i + 0.5, j + 0.5, k);
        seed.has_axis = true;
        seed.strength_U = 0.5;
        seed.needle = std::string(1, static_cast<char>('D' + i)) + std::to_string(3 - j);
        sources.push_back(seed);
      }
    }
  }
  std::stable_sort(sources.begin(), sources.end(),
                   [&](const PlannedSource& a, const PlannedSource& b) { return depth(a.at_mm) < depth(b.at_mm); });
  sources.resize(44);
  return sources;
}

std::vector<double> doses(const Tg43& tg43, const std::vector<PlannedSource>& seeds, const std::vector<Vec3>& points) {
  std::vector<PlacedSource> placed;
  for (const PlannedSource& seed : seeds) placed.push_back({seed.at_mm, seed.axis, seed.strength_U});
  std::vector<double> dose(points.size());
  sum_rates(tg43, placed, points, dose);
  for (double& d : dose) d *= permanent_Gy_per_rate(tg43.source().half_life_days);
  return dose;
}

StructureDose structure(const Tg43& tg43, const std::vector<PlannedSource>& seeds, const std::string& name,
                        const std::string& region, std::vector<Contour> contours, double step_mm) {
  Roi roi;
  roi.name = name;
  roi.contours = contours;
  const StructureSamples samples = sample_structure(roi, step_mm).value();
  return {.name = name,
          .region = region,
          .type = region == "prostate" ? "PTV" : "ORGAN",
          .dvh = DoseVolume(doses(tg43, seeds, samples.points), samples.volume_mm3),
          .covered_by_grid_percent = region == "rectum" ? 91.0 : 100.0,
          .contours = std::move(contours),
          .cloud = {}};
}

DoseGrid dose_grid(const Tg43& tg43, const std::vector<PlannedSource>& seeds, double spacing_mm) {
  DoseGrid grid;
  const Vec3 half(44.0, 44.0, 44.0);
  grid.origin_mm = kCentre - half;
  grid.spacing_mm = Vec3::Constant(spacing_mm);
  const auto count = static_cast<Index>(std::lround(2.0 * half.x() / spacing_mm)) + 1;
  grid.size = {count, count, count};
  std::vector<Vec3> points;
  for (Index k = 0; k < count; ++k) {
    for (Index j = 0; j < count; ++j) {
      for (Index i = 0; i < count; ++i) points.push_back(grid.origin_mm + spacing_mm * Vec3(i, j, k));
    }
  }
  for (const double dose : doses(tg43, seeds, points)) grid.dose_Gy.push_back(static_cast<float>(dose));
  return grid;
}

JudgedGoal goal(const std::string& structure, const std::string& metric, bool at_least, double bound,
                const std::optional<double>& value) {
  return {.goal = {structure, metric, at_least, bound, "Invented for this test, 2024"},
          .value = value,
          .met = value && (at_least ? *value >= bound : *value <= bound)};
}

}  // namespace

DoseEvaluation synthetic_dose(double grid_mm, double step_mm) {
  DoseEvaluation e;
  e.plan.file = "synthetic_plan.json";
  e.plan.label = "Invented implant";
  e.plan.sources = seeds();
  e.plan.prescription_Gy = kPrescription_Gy;
  e.prescription_Gy = kPrescription_Gy;
  e.source = find_source("i125_6711").value();
  e.quantity = "total dose until the seeds have decayed [Gy]";
  const Tg43 tg43 = Tg43::create(e.source, e.formalism).value();
  e.structures.push_back(structure(tg43, e.plan.sources, "Prostate", "prostate", prostate(), step_mm));
  e.structures.push_back(structure(tg43, e.plan.sources, "Urethra", "urethra", urethra(), 0.5 * step_mm));
  e.structures.push_back(structure(tg43, e.plan.sources, "Rectum", "rectum", rectum(), step_mm));
  const DoseVolume& target = e.structures[0].dvh;
  const auto percent = [](double dose_Gy) { return 100.0 * dose_Gy / kPrescription_Gy; };
  e.goals = {goal("prostate", "D90_percent", true, 100, percent(target.dose_of_percent(90))),
             goal("prostate", "V150_percent", false, 60, target.percent_above(1.5 * kPrescription_Gy)),
             goal("urethra", "D10_percent", false, 130, percent(e.structures[1].dvh.dose_of_percent(10))),
             goal("rectum", "D2cc_percent", false, 100, percent(e.structures[2].dvh.dose_of_volume(2))),
             goal("bladder", "D2cc_percent", false, 100, std::nullopt)};
  e.points = {kCentre, kCentre + Vec3(0, 0, 30)};
  e.point_Gy = doses(tg43, e.plan.sources, e.points);
  e.grid = dose_grid(tg43, e.plan.sources, grid_mm);
  e.comparison = DoseComparison{.file = "clinic.dcm", .points = 1000, .median_ratio = 1.004, .p1 = 0.96, .p99 = 1.07};
  e.assumptions = {"Water everywhere, no attenuation between the seeds.",
                   "The seeds lie along their needles, as the plan says.",
                   "Each contour stands for a slab that reaches half-way to its neighbours, the end caps included."};
  e.warnings = {"The dose grid holds only 91 % of the rectum; the figures of the rectum are of the whole structure."};
  return e;
}

}  // namespace stylet::testing
