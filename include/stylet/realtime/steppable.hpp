// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/compliance_worker.hpp"
#include "stylet/realtime/needle_regions.hpp"
#include "stylet/realtime/snapshot.hpp"
#include "stylet/realtime/tissue_probe.hpp"
#include "stylet/sim/simulation.hpp"
#include "stylet/sim/tip_watch.hpp"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace stylet {

/// The part of a step's result that the real-time loop needs.
struct StepOutcome {
  Wrench hand;           ///< force and torque that the hand exerts on the base, about the base point
  bool trusted = false;  ///< false: the step found no balance, and its force must not reach a hand
};

/// Interface of a simulation whose base the real-time loop moves. No function may allocate, lock, wait or throw; while
/// the loop runs, all are called from its thread.
class Steppable {
 public:
  virtual ~Steppable() = default;

  /// Present pose of the base.
  [[nodiscard]] virtual Pose base() const noexcept = 0;
  /// Takes a step: moves the base to a pose in dt seconds.
  virtual StepOutcome step(const Pose& base, double dt) noexcept = 0;
  /// Writes the state after the last step, except for time_s, clock_s, paused, trusted and counters, which the loop
  /// sets.
  virtual void describe(Snapshot& out) noexcept = 0;
  /// Copies the last step's events. @return number of events written; events beyond out.size() are left out
  virtual std::size_t events(std::span<EventSnapshot> out) noexcept = 0;
  /// Copies the last step for a recording, except for step_us, which the loop sets. @return false if there is no step
  /// or it was refused
  virtual bool record(Step& /*out*/) noexcept { return false; }
};

/// Converts the forces of a snapshot to the input of a DisplayField. @param out with room for Snapshot::kForces
/// @return the part of `out` that was written
std::span<const TissueForce> tissue_forces(const Snapshot& snapshot, std::span<TissueForce> out);

/// A Simulation for the real-time loop, with a worker thread that computes compliance ahead of the tip. If the tip
/// outruns the worker, steps are flagged (Step::compliance_missing).
class SimulationSteppable final : public Steppable {
 public:
  /// Puts the needles that stay (Model::staying()) into the tissue, which takes as long as their steps, places the
  /// needle at the start of one of the model's insertions, and makes the compliance for the first steps available,
  /// solving for it if necessary.
  /// @param probe is answered after each step; may be null. Errors: those of put_in_staying_needles()
  static Result<std::unique_ptr<SimulationSteppable>> create(const std::shared_ptr<const Model>& model,
                                                             std::size_t insertion = 0,
                                                             std::shared_ptr<TissueProbe> probe = nullptr);

  /// The simulation; must not be used while the loop runs.
  [[nodiscard]] Simulation& simulation() { return simulation_; }
  /// Sentences about the needles that stay: what happened on their way in, and whether all of them are drawn.
  [[nodiscard]] const std::vector<std::string>& remarks() const { return remarks_; }

  [[nodiscard]] Pose base() const noexcept override;
  StepOutcome step(const Pose& base, double dt) noexcept override;
  void describe(Snapshot& out) noexcept override;
  std::size_t events(std::span<EventSnapshot> out) noexcept override;
  bool record(Step& out) noexcept override;

 private:
  SimulationSteppable(const std::shared_ptr<const Model>& model, std::shared_ptr<TissueProbe> probe);

  void describe_others(Snapshot& out) const noexcept;

  Simulation simulation_;
  std::vector<std::string> remarks_;
  std::unique_ptr<ComplianceWorker> worker_;
  std::vector<ContactState> contacts_;  ///< scratch
  std::vector<TissueForce> forces_;     ///< scratch
  NeedleRegions regions_;
  TipWatch tip_;
  std::shared_ptr<TissueProbe> probe_;
};

}  // namespace stylet
