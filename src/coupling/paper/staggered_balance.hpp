// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/balance_solver.hpp"
#include "coupling/balance/contact_rows.hpp"
#include "coupling/balance/contact_states.hpp"
#include "coupling/paper/condensed_tissue.hpp"
#include "coupling/paper/damped_needle.hpp"

namespace stylet::paper {

/// The balance as Goksel et al. 2005 find it: needle and tissue in turn.
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
  VecX y_;                ///< (rows of K_W) displacement [mm] or force [N], as each row is controlled
  VecX x_;                ///< (rows of K_W) the other one
  VecX force_;            ///< [N] (3 contacts) on the tissue, in the frames
  double advance_ = 0.0;  ///< [mm] of the cut in this sub-step
  double change_ = 0.0;   ///< [N] by which friction and cutting forces still change from one iteration to the next
};

/// Where on the needle a force at arc length s is put [mm]: the nearest node as in the paper, or where it acts.
[[nodiscard]] double loaded_arc(const CouplingSettings& settings, double length, double s);

}  // namespace stylet::paper
