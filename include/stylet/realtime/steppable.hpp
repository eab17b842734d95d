// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/compliance_worker.hpp"
#include "stylet/realtime/needle_regions.hpp"
#include "stylet/realtime/snapshot.hpp"
#include "stylet/sim/simulation.hpp"
#include "stylet/sim/tip_watch.hpp"

#include <span>

namespace stylet {

/// What a step came to, as far as the loop is concerned.
struct StepOutcome {
  Wrench hand;           ///< what the hand exerts on the base; about the base point
  bool trusted = false;  ///< false: the step did not find its balance, its force must not reach a hand
};

/// Something with a base that the real-time loop moves. None of these calls may allocate, lock, wait or throw; all come
/// from the loop's thread while it runs.
class Steppable {
 public:
  virtual ~Steppable() = default;

  /// Where the base is now.
  [[nodiscard]] virtual Pose base() const noexcept = 0;
  /// Moves the base in dt seconds.
  virtual StepOutcome step(const Pose& base, double dt) noexcept = 0;
  /// Writes what the last step looks like; time_s, clock_s, paused, trusted and counters are the loop's own.
  virtual void describe(Snapshot& out) noexcept = 0;
  /// Copies the last step's events. @return how many; those beyond out.size() are left out
  virtual std::size_t events(std::span<EventSnapshot> out) noexcept = 0;
  /// The last step as it is recorded; step_us is the loop's own. @return false: there is none, or it was not taken
  virtual bool record(Step& /*out*/) noexcept { return false; }
};

/// The forces of a snapshot as a DisplayField takes them. @param out room for Snapshot::kForces
/// @return those that are there
std::span<const TissueForce> tissue_forces(const Snapshot& snapshot, std::span<TissueForce> out);

/// A Simulation in the loop, with a worker that keeps compliance ahead of the tip. Where the tip outruns it, the steps
/// are flagged (Step::compliance_missing).
class SimulationSteppable final : public Steppable {
 public:
  /// Places the needle at the start of one of the model's insertions.
  /// What the first steps need is there afterwards: solves if need be.
  explicit SimulationSteppable(const std::shared_ptr<const Model>& model, std::size_t insertion = 0);

  /// Not while the loop runs.
  [[nodiscard]] Simulation& simulation() { return simulation_; }

  [[nodiscard]] Pose base() const noexcept override;
  StepOutcome step(const Pose& base, double dt) noexcept override;
  void describe(Snapshot& out) noexcept override;
  std::size_t events(std::span<EventSnapshot> out) noexcept override;
  bool record(Step& out) noexcept override;

 private:
  Simulation simulation_;
  std::unique_ptr<ComplianceWorker> worker_;
  std::vector<ContactState> contacts_;  ///< room
  std::vector<TissueForce> forces_;     ///< room
  NeedleRegions regions_;
  TipWatch tip_;
};

}  // namespace stylet
