// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contacts.hpp"

#include <span>

namespace stylet {

/// Decides friction and contact: whether each shaft contact sticks, slides forward or backward, slowly or fast, and
/// whether the tip is held, cuts or is open. A trial solution is compared with the law of each contact's state
/// (docs/theory/coupling.md §3), and the state changes where the solution contradicts it. After the balance of a
/// sub-step, contacts that slid very slowly stick. ContactRows::soften writes the friction terms of each contact.
class ContactStates {
 public:
  explicit ContactStates(const Contacts& contacts) : contacts_(contacts) {}

  /// Force and motion of a contact in a trial solution.
  struct Trial {
    double axial = 0.0;    ///< [N] axial force on the tissue
    double slides = 0.0;   ///< [mm] distance that it slides in this sub-step, positive in the sense of its state
    double opening = 0.0;  ///< [N] force that an open tip would have if it were held
  };

  /// Begins the search for a balance. @param most_toggles a contact that changes its state more often than this keeps
  /// it for the rest of the sub-step
  void begin(int most_toggles);
  /// How much [N] a solution contradicts the state of a contact; 0 where it does not, or where the state is kept.
  [[nodiscard]] double contradiction(int load, const Trial& trial) const;
  /// Changes the state of a contact that a solution contradicts.
  void change(int load, const Trial& trial, Step& step);

  /// Makes contacts stick that slid more slowly than Karnopp's zero band in a sub-step of h seconds. @cite Karnopp1985
  static void stick_where_slow(std::span<ShaftContact> contacts, double h, double zero_band_mm_per_s);

  /// [mm] Distance that a sliding contact slides in this sub-step under an axial force [N], positive in the sense of
  /// its state.
  [[nodiscard]] static double way(const ShaftContact& contact, double axial) {
    return contact.slip * (contact.sense() * axial - contact.coulomb);
  }
  /// Whether a contact stands for so little length that it carries no friction; it then follows the tissue.
  [[nodiscard]] static bool is_frictionless(const ShaftContact& contact);

 private:
  [[nodiscard]] double contradiction_of_tip(const Trial& trial) const;
  void change_tip(const Trial& trial);

  Contacts contacts_;
  int most_toggles_ = 0;
};

}  // namespace stylet
