// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contacts.hpp"
#include "coupling/balance/effort.hpp"
#include "coupling/balance/predictor.hpp"
#include "coupling/hand_force.hpp"
#include "coupling/tip/tip_path.hpp"

namespace stylet {

/// The parts of an insertion that a balance solver reads and changes. All of them outlive the solver.
struct BalanceParts {
  const CouplingSettings& settings;
  Contacts contacts;
  TipPath& path;          ///< breaks the surfaces whose strength a balance exceeds
  const HandForce& hand;  ///< gives the hand's force at that moment
  Predictor& predictor;   ///< predicts the end of a sub-step
  int most_contacts = 0;  ///< largest number of shaft contacts of all needles
};

/// Finds the balance of needle, tissue, friction and cutting at the end of a sub-step. No call allocates.
class BalanceSolver {
 public:
  virtual ~BalanceSolver() = default;

  /// Begins a sub-step, whose balance may be sought in several parts.
  virtual void begin() {}

  /// Finds the balance after a sub-step, or a part of one, of h seconds. Sets a flag in `step` where there is none.
  /// @return whether the balance was found in few iterations and the tip kept its state, so that the next sub-step can
  /// be predicted from this one
  virtual bool solve(double h, Effort& effort, Step& step) = 0;

  /// Sets the needle's damping for the next sub-step (Needle::damp()).
  virtual void damp(double /*ratio*/) {}
  /// Reports a motion of the base [mm].
  virtual void base_moved(double /*way_mm*/) {}
  /// Reports that the needle's shape was changed from outside.
  virtual void forget_tangent() {}
  /// Reports that the needle has left the tissue.
  virtual void release() {}
};

}  // namespace stylet
