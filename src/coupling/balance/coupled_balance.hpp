// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/balance_solver.hpp"
#include "coupling/balance/contact_rows.hpp"
#include "coupling/balance/contact_states.hpp"
#include "coupling/balance/cut_search.hpp"
#include "coupling/balance/iterate.hpp"
#include "coupling/balance/needle_tangent.hpp"
#include "coupling/balance/tissue_block.hpp"

namespace stylet {

/// Solves needle, tissue and laws in one system: Newton's iteration over the needle's shape, the frames of the contacts
/// and the place of the cut, with the linear equations of ContactSystem. Their matrix is expensive and changes little
/// from step to step, so it is kept, while the errors are exact: an iteration with an old matrix converges to the same
/// balance, linearly. Sliding and cutting are soft rows of the system (viscous friction is a compliance h/(bℓ)), so a
/// change of state changes D only.
class CoupledBalance : public BalanceSolver {
 public:
  explicit CoupledBalance(const BalanceParts& parts);

  bool solve(double h, Effort& effort, Step& step) override;
  void damp(double ratio) override { tangent_.damp(ratio); }
  void begin() override { largest_at_start_ = parts_.contacts.largest_force(); }
  void base_moved(double way_mm) override { tangent_.wear(way_mm); }
  void forget_tangent() override { tangent_.forget(); }
  void release() override { tangent_.release(); }

  /// Needles at rest follow the moved one (RestingHold): takes one Newton step of them alone, with unchanged forces on
  /// the moved needle. @return false, with nothing changed, where their matrix is outdated
  [[nodiscard]] bool settle_rest(double h);
  [[nodiscard]] ContactRows& rows() { return rows_; }
  [[nodiscard]] ContactSystem& system() { return system_; }
  [[nodiscard]] ContactStates& states() { return states_; }
  void begin_states() { states_.begin(kMostToggles); }

 private:
  /// The state of a solve between its iterations.
  struct Progress;

  double look(double h);
  void gather();
  [[nodiscard]] ContactSystem::TipRows tip_rows() const;
  [[nodiscard]] ContactStates::Trial trial(int load) const;
  [[nodiscard]] bool pivot(double h, Effort& effort, Step& step, bool& changed);
  void change_and_tell(int load, Step& step);
  void take_solution();
  void slide(int load);
  bool cut_on(double h);
  [[nodiscard]] double error_of(int first, int end) const;
  [[nodiscard]] double error_of_tip() const;
  [[nodiscard]] bool resting_needles_lag() const;
  [[nodiscard]] double moment() const;
  [[nodiscard]] double of_tangent(double error) const;
  double shorten(double h, double error, double before);
  void watch_tangent(const Progress& progress, int iteration);
  [[nodiscard]] bool is_astray() const;
  void give_way();

  /// A contact that changes its state more often than this in a sub-step keeps it. Raised, cycling costs more.
  static constexpr int kMostToggles = 6;

  BalanceParts parts_;
  ContactRows rows_;
  ContactSystem system_;
  ContactStates states_;
  TissueBlock tissue_;
  NeedleTangent tangent_;
  Iterate kept_;
  double largest_at_start_ = 0.0;  ///< [N] largest force of a contact at the start of the sub-step
  double error_of_rest_ = 0.0;     ///< error of needle and shaft contacts in the last look(), over the tolerance
  CutSearch search_;               ///< the length of cut
};

}  // namespace stylet
