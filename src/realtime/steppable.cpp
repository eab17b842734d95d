// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/steppable.hpp"

#include "stylet/core/survive.hpp"
#include "stylet/sim/staying_needles.hpp"

#include <algorithm>

namespace stylet {

std::span<const TissueForce> tissue_forces(const Snapshot& snapshot, std::span<TissueForce> out) {
  const auto count = std::min(out.size(), static_cast<std::size_t>(snapshot.force_count));
  for (std::size_t k = 0; k < count; ++k) {
    const ForceSnapshot& f = snapshot.forces[k];
    out[k] = {{f.tet, Vec4(f.weights.data())}, vec3(f.force), vec3(f.along), vec3(f.lasting)};
  }
  return out.first(count);
}

SimulationSteppable::SimulationSteppable(const std::shared_ptr<const Model>& model, std::shared_ptr<TissueProbe> probe)
    : simulation_(model, needles_of(*model)),
      contacts_(static_cast<std::size_t>(model->coupling().capacity) + 1),
      forces_(4 * Snapshot::kForces),
      probe_(std::move(probe)) {}

Result<std::unique_ptr<SimulationSteppable>> SimulationSteppable::create(const std::shared_ptr<const Model>& model,
                                                                         std::size_t insertion,
                                                                         std::shared_ptr<TissueProbe> probe) {
  std::unique_ptr<SimulationSteppable> made(new SimulationSteppable(model, std::move(probe)));
  auto remarks = put_in_staying_needles(made->simulation_, {});
  if (!remarks) return remarks.error();
  made->remarks_ = *std::move(remarks);
  if (model->staying().size() > Snapshot::kResting) {
    made->remarks_.push_back("Of the " + std::to_string(model->staying().size()) + " needles in place, the first " +
                             std::to_string(Snapshot::kResting) + " are drawn; all of them hold the tissue.");
  }
  made->simulation_.place(model->insertions()[insertion]);
  made->simulation_.prepare();
  made->worker_ = std::make_unique<ComplianceWorker>(made->simulation_.supply(), made->simulation_.supply_settings());
  return made;
}

Pose SimulationSteppable::base() const noexcept { return simulation_.insertion().needle().base(); }

StepOutcome SimulationSteppable::step(const Pose& base, double dt) noexcept {
  StepOutcome outcome;  // not trusted
  const auto take = [&] {
    const Step& step = simulation_.step(base, dt);
    regions_.follow(simulation_.insertion());
    tip_.follow(simulation_.insertion(), step);
    outcome = {{step.hand_force_N, step.torque_Nmm}, (step.flags & Step::kDistrusted) == 0};
  };
  survive("a step of the needle", take, [](const Error&) {});
  return outcome;
}

void SimulationSteppable::describe(Snapshot& out) noexcept {
  const Needle& needle = simulation_.insertion().needle();
  out.step = simulation_.last_step();
  constexpr std::size_t last = Snapshot::kCentreline - 1;
  for (std::size_t k = 0; k <= last; ++k)
    out.centreline[k] = plain(needle.point(needle.length() * static_cast<double>(k) / static_cast<double>(last)));
  describe_others(out);
  const std::size_t found = simulation_.insertion().contacts(contacts_);
  const std::size_t shown = std::min(found, Snapshot::kContacts);
  for (std::size_t k = 0; k < shown; ++k) {
    const ContactState& c = contacts_[k];
    out.contacts[k] = {plain(c.position), plain(c.force), c.s, c.sticking, c.tip};
  }
  out.contact_count = static_cast<int>(shown);
  out.contacts_left_out = static_cast<int>(found - shown);
  const std::size_t forces = simulation_.insertion().tissue_forces(forces_);
  const std::size_t kept = std::min(forces, Snapshot::kForces);
  for (std::size_t k = 0; k < kept; ++k) {
    const TissueForce& f = forces_[k];
    out.forces[k] = {f.at.tet,
                     {f.at.weights[0], f.at.weights[1], f.at.weights[2], f.at.weights[3]},
                     plain(f.force),
                     plain(f.along),
                     plain(f.lasting)};
  }
  out.force_count = static_cast<int>(kept);
  out.forces_left_out = static_cast<int>(forces - kept);
  out.forces_left_out_N = 0.0;
  for (std::size_t k = kept; k < std::min(forces, forces_.size()); ++k)
    out.forces_left_out_N += forces_[k].force.norm();
  out.region_count = static_cast<int>(
      regions_.now(simulation_.insertion(), out.step.tip_state, std::span(contacts_).first(found), out.regions));
  out.tip_error = tip_.deepest();
  if (probe_) probe_->serve(simulation_);  // after the step's force has been passed on
}

/// The shapes of the needles at rest, as many as there is room for.
void SimulationSteppable::describe_others(Snapshot& out) const noexcept {
  const Insertion& insertion = simulation_.insertion();
  out.resting_count = 0;
  for (int number = 0; number < insertion.needles(); ++number) {
    if (number == insertion.held() || out.resting_count == static_cast<int>(Snapshot::kResting)) continue;
    const Needle& needle = insertion.needle(number);
    Snapshot::RestingShape& shape = out.resting[static_cast<std::size_t>(out.resting_count++)];
    constexpr std::size_t last = Snapshot::kRestingPoints - 1;
    for (std::size_t k = 0; k <= last; ++k)
      shape[k] = plain(needle.point(needle.length() * static_cast<double>(k) / static_cast<double>(last)));
  }
}

bool SimulationSteppable::record(Step& out) noexcept {
  if ((simulation_.last_step().flags & Step::invalid_input) != 0) return false;
  out = simulation_.last_step();
  return true;
}

std::size_t SimulationSteppable::events(std::span<EventSnapshot> out) noexcept {
  const std::vector<std::string>& regions = simulation_.model().mesh().regions;
  std::size_t count = 0;
  for (const Event& event : simulation_.new_events()) {
    if (count == out.size()) break;
    const auto found = std::find(regions.begin(), regions.end(), event.region);
    const int region = found == regions.end() ? -1 : static_cast<int>(found - regions.begin());
    out[count++] = {event.kind, event.time_s, event.depth_mm, event.force_N, region};
  }
  return count;
}

}  // namespace stylet
