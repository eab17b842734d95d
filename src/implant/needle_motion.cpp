// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle_motion.hpp"

#include "stylet/implant/needle_insertion.hpp"

#include <algorithm>

namespace stylet {

namespace {

constexpr double kApproach_mm = 3.0;
constexpr double kBehindTrain_mm = 2.0;  // way at the slow speed after the last seed has been passed

/// A motion under construction.
class Way {
 public:
  Way(const Vec3& entry, const Vec3& direction, double length_mm)
      : entry_(entry), direction_(direction), length_mm_(length_mm) {
    samples_.push_back({0.0, pose(-kApproach_mm)});
  }
  void go_to(double depth_mm, double speed_mm_per_s) {
    if (depth_mm == depth_mm_) return;
    const double way = std::abs(depth_mm - depth_mm_);
    depth_mm_ = depth_mm;
    samples_.push_back({now() + way / speed_mm_per_s, pose(depth_mm)});
  }
  void wait(double seconds) {
    if (seconds > 0.0) samples_.push_back({now() + seconds, pose(depth_mm_)});
  }
  [[nodiscard]] double now() const { return samples_.back().time_s; }
  [[nodiscard]] BaseMotion motion() && { return BaseMotion(std::move(samples_)); }

 private:
  [[nodiscard]] Pose pose(double depth) const {
    return pose_along(entry_ + (depth - length_mm_) * direction_, direction_);
  }
  Vec3 entry_, direction_;
  double length_mm_;
  double depth_mm_ = -kApproach_mm;
  std::vector<MotionSample> samples_;
};

}  // namespace

NeedleMotion plan_needle_motion(const NeedleLoad& load, const Vec3& entry, const Scenario& scenario,
                                double seed_length_mm) {
  const Scenario::Procedure& procedure = scenario.procedure;
  NeedleMotion result;
  PlannedInsertion& insertion = result.insertion;
  insertion.name = load.name;
  insertion.entry = entry;
  insertion.direction = load.direction;
  insertion.depth_mm = (load.tip_mm - entry).dot(load.direction);
  Way way(entry, load.direction, scenario.needle.length_mm);
  way.go_to(insertion.depth_mm, procedure.speed_mm_per_s);
  result.in_s = way.now();
  if (load.seeds.empty() || load.implant == Implant::temporary) {
    insertion.motion = std::move(way).motion();
    return result;
  }
  if (procedure.technique == SeedTechnique::preloaded) {
    way.wait(procedure.pause_s);
    result.drops.assign(load.seeds.size(), {way.now()});
    const double train = load.seeds.back().behind_tip_mm + 0.5 * seed_length_mm + kBehindTrain_mm;
    way.go_to(insertion.depth_mm - train, procedure.drop_speed_mm_per_s);
  } else {
    for (const LoadedSeed& seed : load.seeds) {
      way.go_to(drop_depth_mm(insertion.depth_mm, seed, seed_length_mm), procedure.drop_speed_mm_per_s);
      way.wait(procedure.pause_s);
      result.drops.push_back({way.now()});
    }
  }
  way.go_to(-kApproach_mm, procedure.retract_speed_mm_per_s);
  insertion.motion = std::move(way).motion();
  return result;
}

}  // namespace stylet
