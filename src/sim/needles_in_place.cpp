// SPDX-License-Identifier: GPL-3.0-or-later
#include "needles_in_place.hpp"

#include "base_steps.hpp"

#include "stylet/sim/material_search.hpp"

namespace stylet {

namespace {

/// The displacement of the material that is at a place in the room; empty where none is known.
std::optional<Vec3> displacement_of_material_at(Simulation& simulation, const Vec3& place) {
  MaterialSearch search(place);
  while (!search.is_done()) {
    const auto at = simulation.model().locator().find(search.x());
    search.add(at ? simulation.displacement_at(*at, search.x()) : std::nullopt);
  }
  // The distance by which the nearest point misses the place counts as motion of the tissue.
  return search.found() ? std::optional(Vec3(place - search.found()->x)) : std::nullopt;
}

}  // namespace

BesideNeedles::BesideNeedles(Simulation& simulation, TargetMotion* gland, std::vector<std::string> targets,
                             const Pose& deepest, std::vector<std::string> remarks) {
  before_.holes = simulation.model().scenario().procedure.stabilising;
  before_.remarks = std::move(remarks);
  if (gland != nullptr) {
    before_.shift_mm = gland->now(simulation.insertion()).motion.shift_mm;
    further_.emplace(std::move(targets));
  }
  moved_mm_ =
      displacement_of_material_at(simulation, rigid_tip(deepest, simulation.model().scenario().needle.length_mm));
}

void BesideNeedles::add(const Step& step, std::span<const Event> events, VolumeMotion motion, bool at_rest,
                        bool deepest) {
  if (!further_) return;
  motion.shift_mm -= *before_.shift_mm;
  further_->add(step, events, motion, at_rest, deepest);
}

NeedlesInPlace BesideNeedles::result(const std::optional<Vec3>& tip_error_mm) const {
  NeedlesInPlace out = before_;
  if (further_) {
    const GlandMotion further = further_->result();
    out.shift_at_break_mm = further.shift_at_break_mm;
    out.shift_max_mm = further.shift_max_mm;
  }
  if (tip_error_mm && moved_mm_) out.tip_error_mm = *tip_error_mm + *moved_mm_;
  return out;
}

}  // namespace stylet
