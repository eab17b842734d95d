// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/implant/seed_fate.hpp"

#include <algorithm>
#include <random>

namespace stylet {

namespace {

/// A line through points, continued straight beyond its ends.
class Polyline {
 public:
  explicit Polyline(std::vector<Vec3> points) : points_(std::move(points)) {
    along_.assign(1, 0.0);
    for (std::size_t k = 1; k < points_.size(); ++k)
      along_.push_back(along_.back() + (points_[k] - points_[k - 1]).norm());
  }
  [[nodiscard]] double along(std::size_t point) const { return along_[point]; }
  [[nodiscard]] Vec3 at(double way) const {
    std::size_t k = 1;
    while (k + 1 < points_.size() && along_[k] < way) ++k;
    const double length = along_[k] - along_[k - 1];
    const double f = length > 0.0 ? (way - along_[k - 1]) / length : 0.0;
    return points_[k - 1] + f * (points_[k] - points_[k - 1]);
  }

 private:
  std::vector<Vec3> points_;
  std::vector<double> along_;
};

/// Puts the seeds of a strand at their planned distances, along the line through the places where they were dropped.
/// The strand as a whole lies where the sum of the squared shifts is least.
void keep_spacing(std::vector<SeedHistory>& seeds) {
  if (seeds.size() < 2) return;
  std::vector<Vec3> points;
  points.reserve(seeds.size());
  for (const SeedHistory& seed : seeds) points.push_back(seed.rest_mm);
  const Polyline line(points);
  std::vector<double> planned(1, 0.0);
  for (std::size_t k = 1; k < seeds.size(); ++k)
    planned.push_back(planned.back() + (seeds[k].planned_mm - seeds[k - 1].planned_mm).norm());
  double shift = 0.0;
  for (std::size_t k = 0; k < seeds.size(); ++k)
    shift += (line.along(k) - planned[k]) / static_cast<double>(seeds.size());
  for (std::size_t k = 0; k < seeds.size(); ++k) {
    const Vec3 at = line.at(planned[k] + shift);
    seeds[k].by(SeedCause::strand) = at - seeds[k].rest_mm;
    seeds[k].rest_mm = at;
  }
}

}  // namespace

void settle_seeds(std::vector<SeedHistory>& seeds, const Scenario::Seed& choice, std::size_t needle) {
  if (choice.stranded) keep_spacing(seeds);
  std::seed_seq start{static_cast<std::uint32_t>(choice.random), static_cast<std::uint32_t>(needle)};
  std::mt19937 engine(start);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  double jump = 0.0;
  for (std::size_t k = 0; k < seeds.size(); ++k) {
    // Both numbers are drawn for each seed, so that one setting does not change the other's result.
    const double drawn = choice.release_mm + choice.release_sd_mm * normal(engine);
    const bool lost = uniform(engine) < choice.loss_percent / 100.0;
    if (k == 0 || !choice.stranded) jump = drawn;
    SeedHistory& seed = seeds[k];
    seed.by(SeedCause::release) = jump * seed.axis;
    seed.rest_mm += seed.by(SeedCause::release);
    seed.lost = lost;
  }
}

SeedHistory as_dropped(SeedHistory settled) {
  for (const SeedCause cause : {SeedCause::release, SeedCause::strand}) {
    settled.rest_mm -= settled.by(cause);
    settled.by(cause).setZero();
  }
  settled.lost = false;
  return settled;
}

}  // namespace stylet
