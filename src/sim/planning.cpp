// SPDX-License-Identifier: GPL-3.0-or-later
#include "planning.hpp"

#include "stylet/sim/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace stylet {

namespace {

constexpr double kBeforeFarEnd_mm = 2.0;  ///< an automatic depth ends this far before the target's far end
constexpr double kRestAfter_s = 1.0;      ///< pause after the needle is out, in tissue that creeps
constexpr double kLeastDepth_mm = 5.0;    ///< smallest automatic depth

bool contains(const std::vector<int>& regions, int region) {
  return std::find(regions.begin(), regions.end(), region) != regions.end();
}

std::string point_text(const Vec3& x) { return fmt::format("({:.1f}, {:.1f}, {:.1f}) mm", x.x(), x.y(), x.z()); }

Eigen::AlignedBox3d extent(const TetMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vec3& x : mesh.nodes) box.extend(x);
  return box;
}

/// Position of a point relative to the nearest of several ways.
struct OnWay {
  std::size_t way = 0;
  double along_mm = 0.0;
  double distance_mm = std::numeric_limits<double>::infinity();
};

OnWay nearest_way(const std::vector<std::array<Vec3, 2>>& ways, const Vec3& x) {
  OnWay nearest;
  for (std::size_t k = 0; k < ways.size(); ++k) {
    const auto& [from, to] = ways[k];
    const Vec3 way = to - from;
    const double f = std::clamp((x - from).dot(way) / std::max(way.squaredNorm(), 1e-12), 0.0, 1.0);
    const double distance = (x - from - f * way).norm();
    if (distance < nearest.distance_mm) nearest = {k, f * way.norm(), distance};
  }
  return nearest;
}

bool is_gland(const std::string& region) {
  return region == "prostate" || region == "peripheral_zone" || region == "transition_zone" ||
         region == "central_zone" || region == "anterior_stroma";
}

}  // namespace

std::vector<int> find_target(const TetMesh& mesh) {
  const auto pick = [&](auto&& wanted) {
    std::vector<int> found;
    for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
      if (wanted(mesh.regions[r])) found.push_back(static_cast<int>(r));
    }
    return found;
  };
  auto target = pick(is_gland);
  for (const char* volume : {"ctv", "target", "ptv", "gtv"}) {
    if (target.empty()) target = pick([&](const std::string& r) { return r == volume; });
  }
  if (target.empty()) target = pick([](const std::string& r) { return r.rfind("label_", 0) == 0; });
  return target;
}

double deepest_mm(const Scenario& scenario) {
  return scenario.needle.length_mm - kNeedleOutside_mm - (scenario.grid.guide ? scenario.grid.distance_mm : 0.0);
}

Result<Vec3> point_behind_hole(const TemplateGrid& grid, const std::string& hole, const Vec3& target_centre) {
  const auto offset = grid.offset_mm(hole);
  if (!offset) return offset.error();
  const double x = grid.centre_mm ? (*grid.centre_mm)[0] : target_centre.x();
  const double y = grid.centre_mm ? (*grid.centre_mm)[1] : target_centre.y();
  return Vec3(x + (*offset)[0], y - (*offset)[1], target_centre.z());
}

Result<PlannedInsertion> plan_insertion(const InsertionPlan& plan, std::size_t number, const Scenario& scenario,
                                        const Locator& locator, const std::vector<int>& target,
                                        const std::string& where) {
  const TetMesh& mesh = locator.mesh();
  const std::string place = fmt::format("{}, insertion[{}]", where, number);
  const Vec3 centre = centroid(mesh, target);
  const Eigen::AlignedBox3d box = extent(mesh);

  PlannedInsertion result;
  result.name = plan.hole ? "hole " + *plan.hole : fmt::format("needle {}", number + 1);
  Vec3 on_line = centre;
  result.direction = kThroughTemplate;
  if (plan.hole) {
    const auto behind = point_behind_hole(scenario.grid, *plan.hole, centre);
    if (!behind) return behind.error();
    on_line = *behind;
  } else {
    on_line = Vec3(plan.entry_mm->data());
    if (plan.target_mm) {
      result.direction = (Vec3(plan.target_mm->data()) - on_line).normalized();
    } else if (plan.direction) {
      result.direction = Vec3(plan.direction->data()).normalized();
    }
  }

  // The entry is the first surface on the line, seen from far outside.
  const double far = (box.center() - on_line).norm() + box.diagonal().norm();
  const Vec3 from = on_line - far * result.direction;
  const Vec3 to = on_line + far * result.direction;
  const auto entry = locator.first_entry(from, to);
  if (!entry) {
    return input_error(place,
                       fmt::format("the needle misses the patient: the line through {} along ({:.3f}, {:.3f}, {:.3f}) "
                                   "does not meet the tissue, which "
                                   "extends from {} to {}",
                                   point_text(on_line), result.direction.x(), result.direction.y(),
                                   result.direction.z(), point_text(box.min()), point_text(box.max())),
                       "Choose another hole, entry or direction, or set template.centre_mm");
  }
  result.entry = from + entry->t * (to - from);

  result.depth_mm = plan.depth_mm;
  if (result.depth_mm <= 0.0) {
    // Automatic depth: to the far end of the target on this line, or as deep as its centre if the line misses the
    // target.
    double last = -1.0;
    const double reach = deepest_mm(scenario);
    Index hint = entry->tet;
    for (double depth = 0.25; depth < 2.0 * far; depth += 0.5) {
      const auto at = locator.find(result.entry + depth * result.direction, hint);
      if (!at) continue;
      hint = at->tet;
      if (contains(target, mesh.tet_region[static_cast<std::size_t>(at->tet)])) last = depth;
    }
    if (last < 0.0) last = (centre - result.entry).dot(result.direction);
    result.depth_mm = std::max(kLeastDepth_mm, last - kBeforeFarEnd_mm);
    if (result.depth_mm > reach) {
      return input_error(
          place,
          fmt::format(
              "the target's far end lies {:.0f} mm deep, but the needle is {:.0f} mm long and reaches only {:.0f} mm",
              result.depth_mm, scenario.needle.length_mm, reach),
          "Use a longer needle (needle.length_mm), or give a depth (depth_mm)");
    }
  }
  result.motion = BaseMotion::straight(result.entry, result.direction, scenario.needle.length_mm, plan.approach_mm,
                                       result.depth_mm, plan.speed_mm_per_s, plan.dwell_s, plan.retract,
                                       plan.retract_speed_mm_per_s, plan.roll_deg * std::numbers::pi / 180.0);
  if (plan.retract && creep_of(scenario) > 1.0) {
    // Tissue that creeps goes on moving once the needle is out, and the report gives the gland's shift after 1 s.
    std::vector<MotionSample> samples = result.motion.samples();
    samples.push_back({samples.back().time_s + kRestAfter_s, samples.back().base});
    result.motion = BaseMotion(std::move(samples));
  }
  return result;
}

Result<PlannedInsertion> plan_insertion(const Model& model, const InsertionPlan& plan, const std::string& where) {
  return plan_insertion(plan, 0, model.scenario(), model.locator(), model.target_regions(), where);
}

Corridor find_corridor(const TetMesh& mesh, const std::vector<std::array<Vec3, 2>>& ways, double radius_mm,
                       int most_nodes) {
  std::vector<std::pair<double, Index>> near;  // distance of an element, element
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const auto& tet = mesh.tets[static_cast<std::size_t>(t)];
    // The distance of an element is the distance of its bounding ball.
    Vec3 centre = Vec3::Zero();
    for (const Index node : tet) centre += 0.25 * mesh.nodes[static_cast<std::size_t>(node)];
    double ball = 0.0;
    for (const Index node : tet) ball = std::max(ball, (mesh.nodes[static_cast<std::size_t>(node)] - centre).norm());
    const double distance = nearest_way(ways, centre).distance_mm - ball;
    if (distance <= radius_mm) near.emplace_back(distance, t);
  }
  std::sort(near.begin(), near.end());
  Corridor corridor;
  corridor.radius_mm = radius_mm;
  std::vector<char> taken(mesh.nodes.size(), 0);
  int count = 0;
  for (const auto& [distance, t] : near) {
    const auto& tet = mesh.tets[static_cast<std::size_t>(t)];
    for (const Index node : tet) count += taken[static_cast<std::size_t>(node)] ? 0 : 1;
    if (count > most_nodes) {
      corridor.radius_mm = distance;
      break;
    }
    for (const Index node : tet) taken[static_cast<std::size_t>(node)] = 1;
    corridor.elements.push_back(t);
  }
  std::sort(corridor.elements.begin(), corridor.elements.end());
  std::vector<std::pair<OnWay, Index>> nodes;
  for (Index node = 0; node < mesh.node_count(); ++node) {
    if (taken[static_cast<std::size_t>(node)])
      nodes.emplace_back(nearest_way(ways, mesh.nodes[static_cast<std::size_t>(node)]), node);
  }
  std::sort(nodes.begin(), nodes.end(), [](const auto& a, const auto& b) {
    return std::tie(a.first.way, a.first.along_mm, a.second) < std::tie(b.first.way, b.first.along_mm, b.second);
  });
  for (const auto& [place, node] : nodes) corridor.nodes.push_back(node);
  return corridor;
}

}  // namespace stylet
