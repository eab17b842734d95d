// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/contacts/marks.hpp"
#include "stylet/needle/needle.hpp"

#include <vector>

namespace stylet {

/// The contacts between shaft and tissue, in the order of the track: contact k sits on mark k. They come alive as the
/// tip passes their marks, and go when they slide off the tip.
///
/// A contact that is nearer to the tip than three diameters of the needle is young and yields: its softness is c₀(1/ρ −
/// 1), ρ being its distance from the tip over three diameters and c₀ what the tissue yields there by itself, and its
/// share of the friction grows with ρ. It is born and dies with zero force, so neither moves the force on the hand.
class ShaftContacts {
 public:
  /// All outlive the contacts.
  ShaftContacts(const InsertionTissue& mesh, const CouplingSettings& settings, const Needle& needle,
                const TissueResponse& tissue);

  [[nodiscard]] std::span<ShaftContact> all() { return contacts_; }
  [[nodiscard]] std::span<const ShaftContact> all() const { return contacts_; }
  [[nodiscard]] std::size_t count() const { return contacts_.size(); }
  [[nodiscard]] bool empty() const { return contacts_.empty(); }

  /// Contacts that the tip has passed come alive; contacts that slid off the tip are dropped.
  void wake_and_drop(Track& track, Marks& marks, const Vec3& tip_force, Step& step);
  /// Gives each contact its length of shaft and the softness of its age.
  /// @return share of the tip's lateral hold that the shaft has taken over, 0…1
  double share_length(const Track& track);
  /// The needle is out.
  void clear() { contacts_.clear(); }

 private:
  [[nodiscard]] double passed_by(const ShaftContact& contact, const Track& track) const;

  const InsertionTissue& mesh_;
  const CouplingSettings& settings_;
  const Needle& needle_;
  const TissueResponse& tissue_;
  std::vector<ShaftContact> contacts_;
};

}  // namespace stylet
