// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contact_system.hpp"
#include "coupling/balance/contacts.hpp"

#include <vector>

namespace stylet {

/// Keeps the tissue's compliance among the present contacts, A of ContactSystem, from iteration to iteration: what has
/// not changed is not read again. Also tells how A changes as the cut goes on, which the last cut says. Nothing
/// allocates after construction.
class TissueBlock {
 public:
  /// @param system outlives this; its A is written
  TissueBlock(ContactSystem& system, int most_contacts);

  /// Goes over to the present contacts.
  /// @return how many of the first contacts were there before, in this order
  int renew(const Contacts& contacts);
  /// How many contacts there were before renew().
  [[nodiscard]] int before() const { return before_; }
  /// The matrix in use is of these points' contacts.
  void take_points(std::span<const int> points);

  /// Brings A up to date. The system's matrix is outdated where a compliance among contacts that were there before has
  /// changed.
  /// @param same what renew() returned
  void gather(const Contacts& contacts, int same);
  /// Takes off what tissue that stiffens under the tip does not give way to a little more force: from now on A is the
  /// tangent at the present forces. To be called once after each gather().
  void stiffen(const TipRelief& relief);
  /// By how much the gaps change as the cut goes on: the tip moves in the direction of the cut, which need not be that
  /// of the needle, and its compliance is another one there. What lasts of earlier forces is left out.
  /// @param relief at the present forces @param rows of the present contacts, with their forces; the drift is written
  void gather_drift(const Contacts& contacts, const TipRelief& relief, ContactRows& rows) const;

 private:
  void gather_tip(const Contacts& contacts, double share, int same);

  ContactSystem& system_;
  std::vector<int> points_;  ///< points whose compliance A holds
  int before_ = 0;
  unsigned version_ = 0;          ///< of the compliance that A is of
  double share_ = -1.0;           ///< TissueResponse::creep_share() that A is of
  Vec3 tip_ = Vec3::Zero();       ///< [mm] LPS, place of the tip that A is of
  bool stale_ = false;            ///< whether the tip's compliance was that of another place
  MatX tip_columns_;              ///< [mm/N] (3 contacts × 3) A's columns of the tip before stiffen()
  MatX slope_;                    ///< [1/N] (3 contacts × 3) their change per mm of cut
  Vec3 slope_at_ = Vec3::Zero();  ///< [mm] LPS, where the tip was when that was told
};

}  // namespace stylet
