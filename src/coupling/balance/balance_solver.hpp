// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contacts.hpp"
#include "coupling/balance/effort.hpp"
#include "coupling/balance/predictor.hpp"
#include "coupling/hand_force.hpp"
#include "coupling/tip/tip_path.hpp"
#include "stylet/coupling/step_phases.hpp"

namespace stylet {

/// The parts of an insertion that a solver of the balance reads and changes. All outlive the solver.
struct BalanceParts {
  const CouplingSettings& settings;
  Contacts contacts;
  TipPath& path;          ///< breaks the surfaces that a balance says break
  const HandForce& hand;  ///< what the hand bore when they did
  Predictor& predictor;   ///< where a sub-step probably ends
  PhaseObserver* const& phases;
};

/// Finds one sub-step's balance of needle, tissue, friction and cutting. No call allocates.
class BalanceSolver {
 public:
  virtual ~BalanceSolver() = default;

  /// Finds the balance after a sub-step of h seconds. Where there is none the step has a flag.
  /// @return whether it was found soon, the tip having kept its state: the next sub-step will be like this one
  virtual bool solve(double h, Effort& effort, Step& step) = 0;

  /// The needle is damped in the sub-step that begins (Needle::damp()).
  virtual void damp(double /*ratio*/) {}
  /// The base has moved by so much [mm].
  virtual void base_moved(double /*way_mm*/) {}
  /// The needle's shape was changed by somebody else.
  virtual void forget_tangent() {}
  /// The needle is out of the tissue.
  virtual void release() {}
};

}  // namespace stylet
