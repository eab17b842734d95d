// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet {

/// What a step spends its time on.
enum class StepPhase {
  other,           ///< none of those below: friction, states, reports
  needle_tangent,  ///< the needle's compliance at its present shape
  needle_relax,    ///< the needle's motion with the tangent of before
  needle_advance,  ///< the needle's new shape
  gather,          ///< frames, yields, compliances and gaps of the contacts
  factorise,       ///< matrix of the shaft's contacts
  solve,           ///< its solutions, the tip's border, changes of state
  balance,         ///< how far from balance the iterate is
  tip,             ///< the cut: search, surfaces, compliance of the tip with all contacts, near field included
  contacts         ///< contacts laid, woken and dropped
};
inline constexpr int kStepPhases = 10;

const char* to_string(StepPhase phase);

/// Told when a step goes over from one phase to another; for measurements. Must not throw.
class PhaseObserver {
 public:
  virtual ~PhaseObserver() = default;
  virtual void enter(StepPhase phase) noexcept = 0;
  /// Back to what was before the last enter().
  virtual void leave() noexcept = 0;
};

/// A phase for as long as it lives; nothing where nobody observes.
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
