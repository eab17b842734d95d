// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contacts.hpp"
#include "stylet/coupling/paper/condensed_system.hpp"

#include <limits>
#include <vector>

namespace stylet::paper {

/// The condensed system K_W of the present contacts, kept from iteration to iteration. In it, contacts have their own
/// numbers, the slots, which change as contacts come and go. Nothing allocates after construction.
class CondensedTissue {
 public:
  /// @param contacts largest number of contacts, tip included
  explicit CondensedTissue(int contacts);

  /// Changes to the present contacts. K_W is made anew when the mesh or the set of contacts has changed; otherwise only
  /// the tip is moved.
  /// @param frames of the contacts, columns n1, n2, t
  void take(const Contacts& contacts, std::span<const Mat3> frames);
  /// Turns the frame of a contact's rows.
  void turn(int load, const Mat3& frame);

  [[nodiscard]] CondensedSystem& system() { return system_; }
  [[nodiscard]] const CondensedSystem& system() const { return system_; }
  /// Number of the first of a contact's three rows.
  [[nodiscard]] int row(int load) const { return 3 * slot_of_[static_cast<std::size_t>(load)]; }
  /// (rows of K_W) The controlled quantity of each row, displacement [mm] or force [N], and the other one.
  [[nodiscard]] VecX& controlled() { return y_; }
  [[nodiscard]] VecX& other() { return x_; }
  /// [mm/N] Displacement of a row by its own force; the inverse where the row is displacement-controlled.
  [[nodiscard]] double own(int row) const { return system_(row, row); }

 private:
  void enter(const Contacts& contacts, int load, const Mat3& frame);
  [[nodiscard]] bool has_all(const Contacts& contacts) const;

  CondensedSystem system_;
  VecX y_, x_;
  MatX across_;                                              ///< work space for a contact's columns
  std::vector<Mat3> frames_;                                 ///< (contacts) frames of the rows of K_W
  std::vector<int> points_;                                  ///< (contacts) numbers in ContactCompliance
  std::vector<int> slot_of_;                                 ///< (contacts) slot of each
  std::vector<int> load_of_;                                 ///< (slots) contact in each
  unsigned version_ = std::numeric_limits<unsigned>::max();  ///< version of the compliance that K_W was made from
  double share_ = 0.0;                                       ///< TissueResponse::creep_share() of K_W
  Vec3 tip_ = Vec3::Zero();                                  ///< [mm] LPS, place of the tip for which its column was
                                                             ///< made
};

}  // namespace stylet::paper
