// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/dose/gamma.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stylet {

namespace {

constexpr std::size_t kMostJudged = 10000;
constexpr int kRaysOfPoint = 100;
constexpr int kStepsOfRay = 5;  // along a ray

/// Directions that are spread evenly over a sphere, on the spiral of the golden angle.
std::vector<Vec3> even_directions() {
  std::vector<Vec3> directions;
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (int k = 0; k < kRaysOfPoint; ++k) {
    const double z = 1.0 - (2.0 * k + 1.0) / kRaysOfPoint;
    const double ring = std::sqrt(1.0 - z * z);
    directions.emplace_back(ring * std::cos(golden * k), ring * std::sin(golden * k), z);
  }
  return directions;
}

/// Least γ² on a stretch of a ray, along which distance and difference of dose grow linearly.
/// @param from_r, to_r distance at its ends / distance to agreement @param from_d, to_d difference / allowed difference
double least_square(double from_r, double to_r, double from_d, double to_d) {
  const double dr = to_r - from_r, dd = to_d - from_d;
  const double share = std::clamp(-(from_r * dr + from_d * dd) / (dr * dr + dd * dd), 0.0, 1.0);
  return std::pow(from_r + share * dr, 2) + std::pow(from_d + share * dd, 2);
}

/// A point that has not passed by both criteria yet.
struct OpenPoint {
  Vec3 at_mm;
  double reference_Gy = 0.0;
  double local_Gy = 0.0, global_Gy = 0.0;  ///< allowed differences
  bool local = false, global = false;      ///< whether it has passed
  std::vector<double> last_Gy;             ///< (kRaysOfPoint) evaluated dose at the last step of each ray
};

/// Tries the next step of all rays of a point. @param reached_Gy (kRaysOfPoint) evaluated doses there
void try_step(OpenPoint& point, int step, std::span<const double> reached_Gy) {
  const double from = (step - 1.0) / kStepsOfRay, to = 1.0 * step / kStepsOfRay;
  for (std::size_t ray = 0; ray < reached_Gy.size(); ++ray) {
    const double before = point.last_Gy[ray] - point.reference_Gy, now = reached_Gy[ray] - point.reference_Gy;
    const auto passes = [&](double allowed) { return least_square(from, to, before / allowed, now / allowed) <= 1.0; };
    point.local = point.local || passes(point.local_Gy);
    point.global = point.global || passes(point.global_Gy);
    point.last_Gy[ray] = reached_Gy[ray];
  }
}

}  // namespace

Result<GammaRates> gamma_rates(std::span<const Vec3> points, std::span<const double> reference_Gy,
                               std::span<const double> evaluated_Gy, const DoseAtPoints& evaluated, double global_Gy,
                               const GammaCriteria& criteria) {
  GammaRates rates{.criteria = criteria, .global_Gy = global_Gy};
  std::vector<std::size_t> judged;
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (reference_Gy[p] >= 0.01 * criteria.threshold_percent * global_Gy) judged.push_back(p);
  }
  const std::size_t every = std::max<std::size_t>(1, (judged.size() + kMostJudged - 1) / kMostJudged);
  std::size_t local = 0, global = 0;
  std::vector<OpenPoint> open;
  for (std::size_t k = 0; k < judged.size(); k += every) {
    const std::size_t p = judged[k];
    OpenPoint point{.at_mm = points[p], .reference_Gy = reference_Gy[p], .last_Gy = {}};
    point.local_Gy = 0.01 * criteria.dose_percent * reference_Gy[p];
    point.global_Gy = 0.01 * criteria.dose_percent * global_Gy;
    const double difference = std::abs(evaluated_Gy[p] - reference_Gy[p]);
    point.local = difference <= point.local_Gy;
    point.global = difference <= point.global_Gy;
    ++rates.points;
    if (point.local && point.global) {
      ++local, ++global;
      continue;
    }
    point.last_Gy.assign(kRaysOfPoint, evaluated_Gy[p]);
    open.push_back(std::move(point));
  }
  const std::vector<Vec3> directions = even_directions();
  std::vector<Vec3> places;
  for (int step = 1; step <= kStepsOfRay && !open.empty(); ++step) {
    const double radius_mm = criteria.distance_mm * step / kStepsOfRay;
    places.clear();
    for (const OpenPoint& point : open) {
      for (const Vec3& direction : directions) places.emplace_back(point.at_mm + radius_mm * direction);
    }
    const Result<std::vector<double>> doses = evaluated(places);
    if (!doses) return doses.error();
    for (std::size_t k = 0; k < open.size(); ++k)
      try_step(open[k], step, std::span(*doses).subspan(k * kRaysOfPoint, kRaysOfPoint));
    std::erase_if(open, [&](const OpenPoint& point) {
      const bool done = (point.local && point.global) || step == kStepsOfRay;
      if (done) {
        local += point.local ? 1 : 0;
        global += point.global ? 1 : 0;
      }
      return done;
    });
  }
  if (rates.points > 0) {
    rates.local_percent = 100.0 * static_cast<double>(local) / static_cast<double>(rates.points);
    rates.global_percent = 100.0 * static_cast<double>(global) / static_cast<double>(rates.points);
  }
  return rates;
}

}  // namespace stylet
