// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/contacts/marks.hpp"
#include "stylet/needle/needle.hpp"

#include <vector>

namespace stylet {

/// The shaft contacts of the needle that the hand moves, in the order of the track: contact k is at mark k. A contact
/// is created when the tip passes its mark, and removed when it slides off the tip. The contacts of needles at rest
/// come before them: they take part in each balance, but none of them is created or removed.
///
/// A contact that is less than three needle diameters behind the tip is young and yields by a softness c₀(1/ρ − 1). Its
/// age ρ is its distance from the tip over three diameters, and c₀ is the tissue's own compliance there; its share of
/// the friction grows with ρ. A contact is created and removed with zero force, so neither changes the force on the
/// hand.
class ShaftContacts {
 public:
  /// All arguments outlive the contacts.
  ShaftContacts(const InsertionTissue& mesh, const CouplingSettings& settings, const Needle& needle,
                const TissueResponse& tissue);

  /// The contacts of all needles.
  [[nodiscard]] std::span<ShaftContact> all() { return contacts_; }
  [[nodiscard]] std::span<const ShaftContact> all() const { return contacts_; }
  [[nodiscard]] std::size_t count() const { return contacts_.size(); }
  /// The contacts of the needle that the hand moves, and the number of contacts before them.
  [[nodiscard]] std::span<ShaftContact> own() { return all().subspan(others_); }
  [[nodiscard]] std::span<const ShaftContact> own() const { return all().subspan(others_); }
  [[nodiscard]] std::size_t others() const { return others_; }
  [[nodiscard]] bool empty() const { return contacts_.size() == others_; }

  /// Creates contacts at the marks that the tip has passed, and removes contacts that slid off the tip.
  void wake_and_drop(Track& track, Marks& marks, const Vec3& tip_force, Step& step);
  /// Updates the tributary length and the softness of each contact.
  /// @return share of the tip's lateral hold that the shaft has taken over, 0…1
  double share_length(const Track& track);
  /// Removes the needle's own contacts: it is out of the tissue.
  void clear() { contacts_.resize(others_); }
  /// Appends a contact that is not at a mark: the tip of a needle that is about to rest.
  void add(const ShaftContact& contact) { contacts_.push_back(contact); }
  /// Takes over all contacts from `before`, whose needle comes to rest: those of this needle become its own. Each
  /// needle's contacts stay together and in their order. Keeps its memory.
  void take_over(ShaftContacts& before);
  /// Removes the needle's own last contact.
  void remove_last() { contacts_.pop_back(); }

 private:
  [[nodiscard]] double passed_by(const ShaftContact& contact, const Track& track) const;

  const InsertionTissue& mesh_;
  const CouplingSettings& settings_;
  const Needle& needle_;
  const TissueResponse& tissue_;
  std::vector<ShaftContact> contacts_;
  std::size_t others_ = 0;  ///< number of contacts of needles at rest
};

}  // namespace stylet
