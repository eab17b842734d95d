// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contacts.hpp"

#include <span>

namespace stylet {

/// Where friction is decided: whether each contact sticks, slides forward or backward, slowly or fast, and whether the
/// tip is held, cuts, or has come away. A solution of the balance is tried against the law of each contact's state
/// (docs/theory/coupling.md §3); the state changes where the solution contradicts it. When a sub-step's balance has
/// been found, contacts that hardly slid in it stick. The numbers of friction are in the contacts: ContactRows::soften
/// puts them there.
class ContactStates {
 public:
  explicit ContactStates(const Contacts& contacts) : contacts_(contacts) {}

  /// Force and motion of a contact in a solution that is tried.
  struct Trial {
    double axial = 0.0;    ///< [N] axial force on the tissue
    double slides = 0.0;   ///< [mm] way it slides in this sub-step, in the sense of its state
    double opening = 0.0;  ///< [N] what an open tip would take if it were held
  };

  /// A balance is looked for. @param most_toggles a contact that changes its state more often than this keeps it for
  /// the rest of the sub-step
  void begin(int most_toggles);
  /// By how much [N] a solution contradicts the state of a contact; 0 where it does not, or where the state is kept.
  [[nodiscard]] double contradiction(int load, const Trial& trial) const;
  /// Changes the state of a contact as a solution that contradicts it asks for.
  void change(int load, const Trial& trial, Step& step);

  /// Lets contacts stick that slid more slowly than Karnopp's zero band in a sub-step of h seconds.
  /// @cite Karnopp1985
  static void stick_where_slow(std::span<ShaftContact> contacts, double h, double zero_band_mm_per_s);

  /// [mm] By how much a sliding contact slides in this sub-step, in the sense of its state, under an axial force [N].
  [[nodiscard]] static double way(const ShaftContact& contact, double axial) {
    return contact.slip * (contact.sense() * axial - contact.coulomb);
  }
  /// Whether a contact stands for so little length that it carries no friction: it follows the tissue.
  [[nodiscard]] static bool is_frictionless(const ShaftContact& contact);

 private:
  [[nodiscard]] double contradiction_of_tip(const Trial& trial) const;
  void change_tip(const Trial& trial);

  Contacts contacts_;
  int most_toggles_ = 0;
};

}  // namespace stylet
