// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/model.hpp"
#include "stylet/sim/turn_watch.hpp"

namespace stylet {

/// One needle in one patient, moving: the preallocated state of a Model. step() is the only call of the loop; it does
/// not allocate once the compliance around the tip is there (prepare()).
class Simulation {
 public:
  /// The needle is placed where the model's first insertion starts.
  explicit Simulation(std::shared_ptr<const Model> model);

  /// Starts an insertion: the needle, straight, at its base pose outside the patient. Time goes on from where it was.
  /// @param base of the needle @param entry [mm] LPS, skin point on its line @param direction LPS, into the patient
  void place(const Pose& base, const Vec3& entry, const Vec3& direction);
  /// The same, where a planned insertion starts.
  void place(const PlannedInsertion& insertion) {
    place(insertion.motion.at(0.0), insertion.entry, insertion.direction);
  }

  /// Moves the base to `base`.
  /// @param dt [s] taken as a whole number of nanoseconds, so that times do not drift
  /// @return last_step(); step_us is left at 0 (the caller owns the clock)
  const Step& step(const Pose& base, double dt);

  /// Makes the compliance near the tip available; call between steps. Allocates when the tip has left the corridor.
  void prepare();

  /// The last step that was taken, or what there was after the placing. Where a step was not taken, the one before it,
  /// with no flag but Step::invalid_input.
  [[nodiscard]] const Step& last_step() const { return step_; }
  [[nodiscard]] std::span<const Event> new_events() const {
    return {events_.data(), static_cast<std::size_t>(event_count_)};
  }

  /// Everything visible now. Solves for the whole displacement: not in the loop.
  [[nodiscard]] Frame frame(const std::string& label = {}) const;

  /// Action against reaction on the tissue (not in the loop). force: of supports and contacts together, over `scale_N`;
  /// torque: their moments about the entry, over scale_N × 100 mm. The hand is not in it: its force is computed as the
  /// sum of the contacts' and the guide's, so that those balance whatever the needle does.
  struct Balance {
    double force = 0.0;
    double torque = 0.0;
  };
  [[nodiscard]] Balance balance(double scale_N) const;

  [[nodiscard]] const Model& model() const { return *model_; }
  [[nodiscard]] const Insertion& insertion() const { return insertion_; }
  /// What brings compliance to the needle, and around what a worker should have it ahead of the tip.
  [[nodiscard]] ComplianceSupply& supply() { return insertion_.supply(); }
  [[nodiscard]] ComplianceSupply::Settings supply_settings() const;
  /// Insertion::observe_phases().
  void observe_phases(PhaseObserver* observer) { insertion_.observe_phases(observer); }
  [[nodiscard]] double time_s() const { return step_.time_s; }

 private:
  void add_event(EventKind kind, double force_N, int region);
  void notice_turn(double advance_mm, bool in_tissue);
  [[nodiscard]] double base_depth_mm(const Pose& base) const;

  std::shared_ptr<const Model> model_;
  Insertion insertion_;
  Vec3 entry_ = Vec3::Zero();
  Vec3 direction_ = Vec3::UnitZ();
  Step step_;
  std::array<Event, 24> events_;
  int event_count_ = 0;
  std::int64_t time_ns_ = 0;
  TurnWatch turns_;
  bool slipping_ = true;  ///< since the last reversal more than half of the shaft has begun to slide
};

}  // namespace stylet
