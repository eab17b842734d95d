// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/balance_solver.hpp"
#include "coupling/balance/contact_rows.hpp"
#include "coupling/balance/contact_states.hpp"
#include "coupling/paper/condensed_tissue.hpp"
#include "coupling/paper/damped_needle.hpp"

namespace stylet::paper {

/// The balance by the method of Goksel et al. 2005: needle and tissue are solved in turn.
class StaggeredBalance : public BalanceSolver {
 public:
  explicit StaggeredBalance(const BalanceParts& parts);

  bool solve(double h, Effort& effort, Step& step) override;

 private:
  void impose_needle_on_tissue(double h);
  void solve_tissue(double h);
  bool switch_contacts(Step& step);
  void load_needle();
  bool cut(bool nearly);
  void bend_needle();
  [[nodiscard]] double imbalance() const;

  BalanceParts parts_;
  ContactRows rows_;
  ContactStates states_;
  CondensedTissue tissue_;
  DampedNeedle bent_;
  VecX force_;            ///< [N] (3 contacts) on the tissue, in the contacts' frames
  double advance_ = 0.0;  ///< [mm] length of cut in this sub-step
  double change_ = 0.0;   ///< [N] last change of friction and cutting forces from one iteration to the next
};

/// Arc length [mm] at which a contact's force acts on the needle: the nearest node as in the paper, or the contact
/// itself.
[[nodiscard]] double loaded_arc(const CouplingSettings& settings, double length, double s);

}  // namespace stylet::paper
