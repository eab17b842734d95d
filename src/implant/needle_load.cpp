// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/implant/needle_load.hpp"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <map>

namespace stylet {

namespace {

constexpr double kSameLine_mm = 1.0;  // seeds without a name that lie on a line within this distance share a needle
constexpr double kStraight_mm = 5.0;  // a needle whose seeds lie further from a straight line is none

Vec3 superior(const Vec3& direction) { return direction.z() < 0.0 ? Vec3(-direction) : direction; }

Vec3 axis_of(const PlannedSource& seed) { return seed.has_axis ? superior(seed.axis.normalized()) : Vec3::UnitZ(); }

/// Numbers of the seeds of each needle.
struct Group {
  std::string name;
  std::vector<std::size_t> seeds;
};

std::vector<Group> group_by_needle(const DosePlan& plan) {
  const char* const needle_word = plan.implant == Implant::temporary ? "catheter" : "needle";
  std::vector<Group> groups;
  std::map<std::string, std::size_t> by_name;
  for (std::size_t k = 0; k < plan.sources.size(); ++k) {
    const PlannedSource& seed = plan.sources[k];
    if (!seed.needle.empty()) {
      const auto [found, is_new] = by_name.emplace(seed.needle, groups.size());
      if (is_new) groups.push_back({seed.needle, {}});
      groups[found->second].seeds.push_back(k);
      continue;
    }
    const auto on_line = std::find_if(groups.begin(), groups.end(), [&](const Group& group) {
      const PlannedSource& first = plan.sources[group.seeds.front()];
      if (!first.needle.empty()) return false;
      const Vec3 apart = seed.at_mm - first.at_mm;
      const Vec3 axis = axis_of(first);
      return (apart - apart.dot(axis) * axis).norm() < kSameLine_mm;
    });
    if (on_line != groups.end()) {
      on_line->seeds.push_back(k);
    } else {
      groups.push_back({"", {k}});
    }
  }
  for (std::size_t k = 0; k < groups.size(); ++k) {
    if (groups[k].name.empty()) groups[k].name = fmt::format("{} {}", needle_word, k + 1);
  }
  return groups;
}

/// Direction of the line through several points that fits them best.
Vec3 direction_of(const std::vector<Vec3>& points, const Vec3& centre) {
  Mat3 spread = Mat3::Zero();
  for (const Vec3& x : points) spread += (x - centre) * (x - centre).transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(spread);
  return superior(eigen.eigenvectors().col(2));
}

/// The words of messages for the needles of a plan and for the seeds or dwell positions in them.
struct PlanWords {
  const char* needle;
  const char* seeds;
};
PlanWords words_of(const DosePlan& plan) {
  return plan.implant == Implant::temporary ? PlanWords{"catheter", "dwell positions"} : PlanWords{"needle", "seeds"};
}

/// @param before_first_mm from the tip to the centre of the first seed or dwell position
Result<NeedleLoad> load_needle(const DosePlan& plan, const Group& group, double before_first_mm) {
  std::vector<Vec3> points;
  Vec3 centre = Vec3::Zero();
  for (const std::size_t k : group.seeds) points.push_back(plan.sources[k].at_mm);
  for (const Vec3& x : points) centre += x / static_cast<double>(points.size());
  NeedleLoad load;
  load.implant = plan.implant;
  load.name = group.name;
  load.direction = points.size() > 1 ? direction_of(points, centre) : axis_of(plan.sources[group.seeds.front()]);
  double deepest = -1e300;
  for (const Vec3& x : points) {
    const double along = (x - centre).dot(load.direction);
    deepest = std::max(deepest, along);
    load.beside_line_mm = std::max(load.beside_line_mm, (x - centre - along * load.direction).norm());
  }
  if (load.beside_line_mm > kStraight_mm) {
    const auto [needle, seeds] = words_of(plan);
    return input_error(
        fmt::format("{}, {} {}", plan.file, needle, load.name),
        fmt::format("its {} lie up to {:.1f} mm beside a straight line", seeds, load.beside_line_mm),
        fmt::format("Give the plan with the {0} of each {1} on a line, or name the {1}s of the {0}", seeds, needle));
  }
  const double tip = deepest + before_first_mm;
  load.tip_mm = centre + tip * load.direction;
  for (const std::size_t k : group.seeds) {
    const PlannedSource& seed = plan.sources[k];
    load.seeds.push_back({.number = k,
                          .planned_mm = seed.at_mm,
                          .axis = seed.has_axis ? axis_of(seed) : load.direction,
                          .behind_tip_mm = tip - (seed.at_mm - centre).dot(load.direction)});
  }
  std::sort(load.seeds.begin(), load.seeds.end(),
            [](const LoadedSeed& a, const LoadedSeed& b) { return a.behind_tip_mm < b.behind_tip_mm; });
  return load;
}

/// Checks that the seeds of a needle have room beside each other.
Result<> check_train(const NeedleLoad& load, double seed_length_mm, const std::string& file) {
  for (std::size_t k = 1; k < load.seeds.size(); ++k) {
    const double apart = load.seeds[k].behind_tip_mm - load.seeds[k - 1].behind_tip_mm;
    if (apart >= 0.5 * seed_length_mm) continue;
    return input_error(fmt::format("{}, needle {}", file, load.name),
                       fmt::format("two of its seeds, of {:g} mm, are {:.2f} mm apart", seed_length_mm, apart),
                       "Leave one of them out, or give them to different needles");
  }
  return Ok{};
}

}  // namespace

Result<std::vector<NeedleLoad>> load_needles(const DosePlan& plan, double seed_length_mm, double plug_mm) {
  if (plan.implant == Implant::temporary) {
    return input_error(plan.file, "the plan is a temporary implant, which has dwell positions and no seeds",
                       "Give a plan of permanent seeds");
  }
  if (plan.sources.empty()) return input_error(plan.file, "the plan has no seeds", "Give a plan with seeds");
  std::vector<NeedleLoad> needles;
  for (const Group& group : group_by_needle(plan)) {
    Result<NeedleLoad> load = load_needle(plan, group, 0.5 * seed_length_mm + plug_mm);
    if (!load) return load.error();
    if (Result<> fits = check_train(*load, seed_length_mm, plan.file); !fits) return fits.error();
    needles.push_back(*std::move(load));
  }
  return needles;
}

Result<std::vector<NeedleLoad>> load_catheters(const DosePlan& plan, double tip_mm) {
  if (plan.implant == Implant::permanent) {
    return input_error(plan.file, "the plan is a permanent implant, whose seeds are left by needles",
                       "Give a plan with dwell times of a source");
  }
  const bool dwells =
      std::any_of(plan.sources.begin(), plan.sources.end(), [](const PlannedSource& s) { return s.dwell_s > 0.0; });
  if (!dwells) {
    return input_error(plan.file, "no dwell position of the temporary implant has a dwell time above 0 s",
                       "Give the dwell times (dwell_s)");
  }
  std::vector<NeedleLoad> catheters;
  for (const Group& group : group_by_needle(plan)) {
    Result<NeedleLoad> load = load_needle(plan, group, tip_mm);
    if (!load) return load.error();
    catheters.push_back(*std::move(load));
  }
  return catheters;
}

void aim(NeedleLoad& needle, const Vec3& shift) {
  needle.aim_mm += shift;
  needle.tip_mm += shift;
}

void order_needles(std::vector<NeedleLoad>& needles, NeedleOrder order) {
  if (order == NeedleOrder::plan) return;
  const double sign = order == NeedleOrder::anterior_first ? 1.0 : -1.0;  // anterior is −y
  std::stable_sort(needles.begin(), needles.end(), [sign](const NeedleLoad& a, const NeedleLoad& b) {
    return sign * a.tip_mm.y() < sign * b.tip_mm.y();
  });
}

}  // namespace stylet
