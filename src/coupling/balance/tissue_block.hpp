// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contact_system.hpp"
#include "coupling/balance/contacts.hpp"

#include <cstdint>
#include <vector>

namespace stylet {

/// Holds the tissue's compliance among the present contacts, A of ContactSystem, and reads only those parts again that
/// have changed. Also computes the derivative of A along the cut from the last cut. Nothing allocates after
/// construction.
class TissueBlock {
 public:
  /// @param system outlives this; its A is written
  TissueBlock(ContactSystem& system, int most_contacts);

  /// Changes to the present contacts.
  /// @return how many of the first contacts are the same as before, in the same order
  int renew(const Contacts& contacts);
  /// Number of contacts before the last renew().
  [[nodiscard]] int before() const { return before_; }
  /// Records the points whose contacts the matrix in use belongs to.
  void take_points(std::span<const int> points);

  /// Updates A. Marks the system's matrix as outdated where a compliance among the contacts that were there before has
  /// changed.
  /// @param same what renew() returned
  void gather(const Contacts& contacts, int same);
  /// Subtracts from A the derivative of the relief, so that A is the tangent at the present forces in tissue that
  /// stiffens under the tip. To be called once after each gather().
  void stiffen(const TipRelief& relief);
  /// Computes the drift, the change of the gaps per length of cut: the tip moves along the cut, which may differ from
  /// the needle's direction, and its compliance changes. The effect of lasting forces on it is neglected.
  /// @param relief at the present forces @param rows of the present contacts, with their forces; the drift is written
  void gather_drift(const Contacts& contacts, const TipRelief& relief, ContactRows& rows) const;

 private:
  void gather_tip(const Contacts& contacts, double share, int same);

  ContactSystem& system_;
  std::vector<int> points_;  ///< points whose compliance A holds
  int before_ = 0;
  std::uint64_t version_ = 0;     ///< version of the tissue that A was read from
  double share_ = -1.0;           ///< TissueResponse::creep_share() of A
  Vec3 tip_ = Vec3::Zero();       ///< [mm] LPS, place of the tip of A
  bool stale_ = false;            ///< whether the tip's compliance was taken from another place
  MatX tip_columns_;              ///< [mm/N] (3 contacts × 3) the tip's columns of A before stiffen()
  MatX slope_;                    ///< [1/N] (3 contacts × 3) their derivative per mm of cut
  std::uint64_t held_by_ = 0;     ///< version of the hold that the tip's columns belong to
  MatX held_;                     ///< [mm/N] (3 contacts × 3) work space: what needles at rest take off the tip's
                                  ///< columns
  Vec3 slope_at_ = Vec3::Zero();  ///< [mm] LPS, place of the tip at which slope_ was computed
};

}  // namespace stylet
