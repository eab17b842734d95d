// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contacts.hpp"
#include "stylet/coupling/paper/condensed_system.hpp"

#include <limits>
#include <vector>

namespace stylet::paper {

/// The condensed system K_W of the present contacts, kept from iteration to iteration. Contacts have numbers there of
/// their own, which change as contacts come and go: their slots. Nothing allocates after construction.
class CondensedTissue {
 public:
  /// @param contacts most contacts, tip included
  explicit CondensedTissue(int contacts);

  /// Goes over to the present contacts: K_W is made anew when the mesh or the set of contacts has changed, else only
  /// the tip moves on.
  /// @param frames of the contacts, columns n1, n2, t
  void take(const Contacts& contacts, std::span<const Mat3> frames);
  /// A contact's rows are from now on in this frame.
  void turn(int load, const Mat3& frame);

  [[nodiscard]] CondensedSystem& system() { return system_; }
  [[nodiscard]] const CondensedSystem& system() const { return system_; }
  /// First of the three rows of a contact.
  [[nodiscard]] int row(int load) const { return 3 * slot_of_[static_cast<std::size_t>(load)]; }
  /// [mm/N] What a row yields to a force on itself, or the inverse where it is held.
  [[nodiscard]] double own(int row) const { return system_(row, row); }

 private:
  void enter(const Contacts& contacts, int load, const Mat3& frame);
  [[nodiscard]] bool has_all(const Contacts& contacts) const;

  CondensedSystem system_;
  MatX across_;                                              ///< room for a contact's columns
  std::vector<Mat3> frames_;                                 ///< (loads) that K_W is written in
  std::vector<int> points_;                                  ///< (loads) numbers in ContactCompliance
  std::vector<int> slot_of_;                                 ///< (loads)
  std::vector<int> load_of_;                                 ///< (slots)
  unsigned version_ = std::numeric_limits<unsigned>::max();  ///< of the compliance that K_W is of
  double share_ = 0.0;                                       ///< TissueResponse::creep_share() that K_W is of
  Vec3 tip_ = Vec3::Zero();                                  ///< [mm] LPS, where the tip was when its column was made
};

}  // namespace stylet::paper
