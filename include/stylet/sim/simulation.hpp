// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/model.hpp"
#include "stylet/sim/turn_watch.hpp"

namespace stylet {

/// Simulation of needles in one patient: the mutable, preallocated state that belongs to a Model. A loop calls only
/// step(), which does not allocate once prepare() has made the compliance around the tip available.
///
/// The hand holds one needle, the first one unless another has been taken up. Needles at rest hold the tissue, bend and
/// slip (docs/theory/several_needles.md). Unless said otherwise, a function is about the needle that the hand holds.
class Simulation {
 public:
  /// Places the first needle at the start of the model's first insertion.
  /// @param needles largest number of needles at the same time
  explicit Simulation(std::shared_ptr<const Model> model, int needles = 1);

  /// Lays the held needle to rest and takes up another. A needle that has not been in the hand before is in the air:
  /// place() has to be called next. Call it between steps; it allocates.
  /// @param needle 0 … the number of needles given to the constructor − 1
  /// @return an error where there is no such needle or no room for another contact
  Result<> take_up(int needle);

  /// Starts an insertion with the needle straight and outside of the patient. Simulated time continues.
  /// @param base pose of the needle's base @param entry [mm] LPS, skin point on the needle's line
  /// @param direction LPS, into the patient
  void place(const Pose& base, const Vec3& entry, const Vec3& direction);
  /// Starts a planned insertion at the beginning of its motion.
  void place(const PlannedInsertion& insertion) {
    place(insertion.motion.at(0.0), insertion.entry, insertion.direction);
  }

  /// Moves the base to the pose `base` during `dt`.
  /// @param dt [s]; rounded to whole nanoseconds, so that times do not drift
  /// @return last_step(); its step_us is 0, since the caller measures computing time
  const Step& step(const Pose& base, double dt);

  /// Counts time from now on: the time of the last step becomes 0. Nothing else depends on the time.
  void start_clock();

  /// Makes the compliance near the tip available; call between steps. Allocates when the tip has left the corridor.
  void prepare();

  /// Insertion::displacement_at() after the last step.
  std::optional<Insertion::PointDisplacement> displacement_at(const MaterialPoint& at, const Vec3& x) {
    return insertion_.displacement_at(at, x);
  }

  /// The last step, or the state after place() if there has been none. If the last step was refused, this is the step
  /// before it with Step::invalid_input as its only flag.
  [[nodiscard]] const Step& last_step() const { return step_; }
  /// The events of the last step.
  [[nodiscard]] std::span<const Event> new_events() const {
    return {events_.data(), static_cast<std::size_t>(event_count_)};
  }

  /// The residual of the balance of forces on the tissue: the sum of the forces of supports and contacts. The hand's
  /// force is not part of this sum, because it is computed as the sum of the forces of contacts and guide and would
  /// always balance them.
  struct Balance {
    double force_N = 0.0;   ///< |sum of forces|
    double torque_N = 0.0;  ///< |sum of moments about the entry| / 100 mm
  };
  /// The present state for display. Solves for the displacement of all nodes, so it must not be called in the loop.
  /// @param balance if given, is set to the balance at this moment
  [[nodiscard]] Frame frame(const std::string& label = {}, Balance* balance = nullptr) const;

  [[nodiscard]] const Model& model() const { return *model_; }
  [[nodiscard]] const Insertion& insertion() const { return insertion_; }
  /// The supply of compliance around the needle, which a worker thread may serve ahead of the tip.
  [[nodiscard]] ComplianceSupply& supply() { return insertion_.supply(); }
  /// Radius and distance ahead of the tip for which the worker should compute compliance.
  [[nodiscard]] ComplianceSupply::Settings supply_settings() const;
  [[nodiscard]] double time_s() const { return step_.time_s; }

 private:
  [[nodiscard]] Balance balance_of(const ContactCompliance::Nodes& nodes) const;
  void add_event(EventKind kind, double force_N, int region);
  void notice_turn(double advance_mm, bool in_tissue);
  [[nodiscard]] double base_depth_mm(const Pose& base) const;

  /// The state of a needle while it rests.
  struct Resting {
    Vec3 entry = Vec3::Zero();
    Vec3 direction = Vec3::UnitZ();
    Step step;
    TurnWatch turns;
    bool slipping = true;
  };

  std::shared_ptr<const Model> model_;
  Insertion insertion_;
  std::vector<Resting> resting_;  ///< (needles)
  Vec3 entry_ = Vec3::Zero();
  Vec3 direction_ = Vec3::UnitZ();
  Step step_;
  std::array<Event, 24> events_;
  int event_count_ = 0;
  std::int64_t time_ns_ = 0;
  TurnWatch turns_;
  bool slipping_ = true;  ///< more than half of the inserted shaft has begun to slide since the last turn
};

}  // namespace stylet
