// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/hole_map.hpp"

#include "planning.hpp"
#include "stylet/geom/region_distance.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet {

namespace {

/// Whether a region is part of a structure. A lumen is part of the organ around it.
bool belongs_to(Spared structure, const std::string& region) {
  switch (structure) {
    case Spared::bone:
      return is_bone(region);
    case Spared::urethra:
      return region == "urethra";
    case Spared::rectum:
      return region == "rectum" || region == "rectal_lumen";
  }
  return false;
}

std::vector<int> regions_of(const TetMesh& mesh, Spared structure) {
  std::vector<int> regions;
  for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
    if (belongs_to(structure, mesh.regions[r])) regions.push_back(static_cast<int>(r));
  }
  return regions;
}

/// The target together with the urethra between the target's ends: a needle along the urethra is in the gland as well.
class Gland {
 public:
  explicit Gland(const Model& model) : mesh_(model.mesh()), regions_(model.target_regions()) {
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      if (std::find(regions_.begin(), regions_.end(), mesh_.tet_region[t]) == regions_.end()) continue;
      for (const Index node : mesh_.tets[t]) extent_.extend(mesh_.nodes[static_cast<std::size_t>(node)]);
    }
    for (const int region : regions_of(mesh_, Spared::urethra)) regions_.push_back(region);
  }

  /// Length [mm] of a straight way within the gland. @param from, to [mm] LPS, with the same x and y; `to` is superior
  [[nodiscard]] double length_of(const Vec3& from, const Vec3& to) const {
    const Vec3 low(from.x(), from.y(), std::max(from.z(), extent_.min().z()));
    const Vec3 high(to.x(), to.y(), std::min(to.z(), extent_.max().z()));
    return low.z() < high.z() ? length_in_regions(mesh_, regions_, low, high) : 0.0;
  }

  /// Whether the infinite line along z through a point leads through the gland.
  [[nodiscard]] bool is_met_through(const Vec3& x) const {
    return length_of({x.x(), x.y(), extent_.min().z()}, {x.x(), x.y(), extent_.max().z()}) > 0.0;
  }

 private:
  const TetMesh& mesh_;
  std::vector<int> regions_;
  Eigen::AlignedBox3d extent_;  ///< [mm] bounding box of the target
};

/// Whether a needle is in place in the hole at this offset; holes have several spellings.
bool is_taken(const TemplateGrid& grid, const std::vector<std::string>& in_place, const std::array<double, 2>& offset) {
  return std::any_of(in_place.begin(), in_place.end(), [&](const std::string& hole) {
    const auto its = grid.offset_mm(hole);
    return its && *its == offset;
  });
}

}  // namespace

HoleEffect effect_of(const HoleRow& row) {
  if (!row.prediction) return {};
  if (const auto& held = row.prediction->in_place)
    return {held->shift_at_break_mm, held->shift_max_mm, held->tip_error_mm};
  return {row.prediction->shift_at_break_mm, row.prediction->shift_max_mm, row.prediction->tip_error_mm};
}

const NeedlesInPlace* needles_in_place(const HoleMap& map) {
  const HoleRow* best = nullptr;
  for (const HoleRow& row : map.holes) {
    if (!row.prediction || !row.prediction->in_place) continue;
    if (best == nullptr || row.hole == map.planned) best = &row;
  }
  return best == nullptr ? nullptr : &*best->prediction->in_place;
}

const char* to_string(Spared structure) {
  switch (structure) {
    case Spared::bone:
      return "bone";
    case Spared::urethra:
      return "urethra";
    case Spared::rectum:
      return "rectum";
  }
  return "";
}

std::vector<Spared> missing_structures(const HoleMap& map) {
  std::vector<Spared> missing;
  for (std::size_t i = 0; i < kSpared.size(); ++i) {
    const bool known = std::any_of(map.holes.begin(), map.holes.end(),
                                   [i](const HoleRow& row) { return row.clearance_mm[i].has_value(); });
    if (!known) missing.push_back(kSpared[i]);
  }
  return missing;
}

InsertionPlan plan_through(const InsertionPlan& plan, const std::string& hole) {
  InsertionPlan through = plan;
  through.hole = hole;
  through.entry_mm.reset();
  through.direction.reset();
  through.target_mm.reset();
  through.motion.clear();
  return through;
}

Result<HoleMap> map_ways(const Model& model, const PlanOfHole& plan_of, const std::string& where) {
  const TetMesh& mesh = model.mesh();
  const TemplateGrid& grid = model.scenario().grid;
  if (model.target_regions().empty()) {
    return input_error(where,
                       fmt::format("the patient has no target for a map of the template's holes: its regions are {}",
                                   fmt::join(mesh.regions, ", ")),
                       "Name the gland with patient.regions, for example \"1\" = \"prostate\"");
  }
  const double radius_mm = 0.5 * model.scenario().needle.diameter_mm;
  std::array<std::vector<int>, kSpared.size()> spared;
  for (std::size_t i = 0; i < kSpared.size(); ++i) spared[i] = regions_of(mesh, kSpared[i]);

  const Gland gland(model);
  const Vec3 centre = centroid(mesh, model.target_regions());
  HoleMap map;
  map.columns = grid.columns;
  map.rows = grid.rows;
  map.pitch_mm = grid.pitch_mm;
  map.planned = model.scenario().insertions.front().hole.value_or("");
  map.in_place = model.scenario().procedure.stabilising;
  for (auto row = grid.rows.rbegin(); row != grid.rows.rend(); ++row) {
    for (const std::string& column : grid.columns) {
      HoleRow line;
      line.hole = column + *row;
      const auto offset = grid.offset_mm(line.hole);
      const auto behind = point_behind_hole(grid, line.hole, centre);
      if (!offset || !behind || !gland.is_met_through(*behind)) {
        ++map.missing;
        continue;
      }
      line.left_mm = (*offset)[0];
      line.anterior_mm = (*offset)[1];
      if (is_taken(grid, map.in_place, *offset)) {
        line.failed = "A needle is in place in this hole.";
        map.holes.push_back(std::move(line));
        continue;
      }
      const auto planned = plan_insertion(model, plan_of(line.hole), "hole " + line.hole);
      if (!planned) {
        line.failed = planned.error().what;
        map.holes.push_back(std::move(line));
        continue;
      }
      const Vec3 end = planned->entry + planned->depth_mm * planned->direction;
      line.depth_mm = planned->depth_mm;
      line.in_target_mm = gland.length_of(planned->entry, end);
      if (line.in_target_mm <= 0.0) {
        ++map.missing;
        continue;
      }
      for (std::size_t i = 0; i < kSpared.size(); ++i) {
        if (const auto distance = distance_to_regions(mesh, spared[i], planned->entry, end))
          line.clearance_mm[i] = std::max(0.0, *distance - radius_mm);
      }
      map.holes.push_back(std::move(line));
    }
  }
  if (map.holes.empty()) {
    return input_error(
        where,
        fmt::format("no hole of the template leads into the target, whose centre is at ({:.1f}, {:.1f}, {:.1f}) mm",
                    centre.x(), centre.y(), centre.z()),
        "Move the template in front of the target (template.centre_mm), or let the needle go deeper "
        "(insertion.depth_mm)");
  }
  return map;
}

Result<> check_mappable(const Scenario& scenario, const std::string& where) {
  if (scenario.insertions.size() != 1) {
    return input_error(fmt::format("{}, [[insertion]]", where),
                       fmt::format("there are {} insertions, and a map puts one needle into each hole of the template",
                                   scenario.insertions.size()),
                       "Keep only the [[insertion]] with the depth, speed and roll for the map");
  }
  const InsertionPlan& plan = scenario.insertions.front();
  if (!plan.motion.empty()) {
    return input_error(
        fmt::format("{}, insertion[0].motion = \"{}\"", where, plan.motion),
        "a recorded motion belongs to one needle and cannot be repeated through every hole of the template",
        "Give a hole and a speed instead, for example hole = \"D4\"");
  }
  if (!plan.hole) {
    return input_error(fmt::format("{}, insertion[0].entry_mm", where),
                       "the needle does not go through a hole of the template, which a map of the holes requires",
                       "Give a hole instead, for example hole = \"D4\"");
  }
  return Ok{};
}

}  // namespace stylet
