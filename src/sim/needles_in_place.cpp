// SPDX-License-Identifier: GPL-3.0-or-later
#include "needles_in_place.hpp"

#include "stylet/sim/material_search.hpp"

#include <fmt/format.h>

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

/// Puts the needle that the hand holds in, to its full depth, and waits as its plan says.
Result<std::vector<std::string>> put_in(Simulation& simulation, const PlannedInsertion& insertion) {
  const BaseSteps motion = planned_steps(simulation.model(), insertion);
  StepRemarks watch;
  simulation.place(insertion);
  const auto add = [&](long, const Step&, double) -> Result<> {
    watch.add(simulation);
    return Ok{};
  };
  if (Result<> done = drive(simulation, motion, motion.count, add); !done) return done.error();
  std::vector<std::string> remarks = watch.sentences();
  for (std::string& remark : remarks) remark = fmt::format("Needle in place, {}: {}", insertion.name, remark);
  return remarks;
}

}  // namespace

int needles_of(const Model& model) { return static_cast<int>(model.staying().size()) + 1; }

Result<std::vector<std::string>> put_in_staying_needles(Simulation& simulation, const Progress& progress) {
  const std::vector<PlannedInsertion>& staying = simulation.model().staying();
  std::vector<std::string> remarks;
  if (staying.empty()) return remarks;
  for (std::size_t k = 0; k < staying.size(); ++k) {
    report(progress, "needle in place, " + staying[k].name,
           static_cast<double>(k) / static_cast<double>(staying.size()));
    if (Result<> taken = simulation.take_up(static_cast<int>(k)); !taken) return taken.error();
    const auto of_needle = put_in(simulation, staying[k]);
    if (!of_needle) return of_needle.error();
    remarks.insert(remarks.end(), of_needle->begin(), of_needle->end());
  }
  if (Result<> taken = simulation.take_up(static_cast<int>(staying.size())); !taken) return taken.error();
  simulation.start_clock();
  simulation.place(simulation.model().insertions().front());
  return remarks;
}

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
