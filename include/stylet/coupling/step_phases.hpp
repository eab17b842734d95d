// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet {

/// Phases of a step, for time measurements.
enum class StepPhase {
  other,           ///< everything else: friction, states, reports
  needle_tangent,  ///< the needle's tangent compliance at its present shape
  needle_relax,    ///< the needle's Newton step with the tangent that is kept
  needle_advance,  ///< the needle's new shape
  gather,          ///< frames, yields, compliances and gaps of the contacts
  factorise,       ///< factorisation of the matrix of the shaft's contacts
  solve,           ///< solutions with that matrix, the border of the tip, changes of contact states
  balance,         ///< computes the residual of the iterate
  tip,      ///< the tip's cut: search of the element, surfaces, compliance between tip and contacts with near field
  contacts  ///< creation and removal of contacts
};
inline constexpr int kStepPhases = 10;

const char* to_string(StepPhase phase);

/// Receives the phase changes of a step, for measurements. Its functions must not throw.
class PhaseObserver {
 public:
  virtual ~PhaseObserver() = default;
  virtual void enter(StepPhase phase) noexcept = 0;
  /// Returns to the phase that was active before the last enter().
  virtual void leave() noexcept = 0;
};

/// Reports a phase during its own lifetime; does nothing without an observer.
class InPhase {
 public:
  InPhase(PhaseObserver* observer, StepPhase phase) : observer_(observer) {
    if (observer_ != nullptr) observer_->enter(phase);
  }
  ~InPhase() {
    if (observer_ != nullptr) observer_->leave();
  }
  InPhase(const InPhase&) = delete;
  InPhase& operator=(const InPhase&) = delete;

 private:
  PhaseObserver* observer_;
};

}  // namespace stylet
