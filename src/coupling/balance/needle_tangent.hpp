// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contact_system.hpp"
#include "coupling/balance/contacts.hpp"
#include "coupling/balance/effort.hpp"

#include <vector>

namespace stylet {

/// The needle's tangent that the equations use, and the next one. A tangent and its matrix cost as much as many
/// iterations, but a balance does not need a new one: an iteration with an old tangent converges to the same balance,
/// linearly. So a tangent is kept over many steps. Meanwhile the next one is made in pieces, one after each balance
/// that left time for it, and then replaces the present one. By then the next tangent belongs to a shape some steps
/// old, which does no harm: the tangent that it replaces belongs to a much older one.
///
/// A needle under more load than it can bear by itself has no positive definite tangent. It is then lent springs at its
/// contacts (docs/theory/balance.md). So is each needle at rest, since the load that the hand has put on it stays.
class NeedleTangent {
 public:
  /// All arguments outlive the tangent. @param system its needle's side is written @param rows loads on the needle
  NeedleTangent(Needle& needle, ContactSystem& system, const ContactRows& rows, int most_contacts);

  /// Whether the tangent belongs to the present contacts.
  [[nodiscard]] bool fits() const { return fits_; }
  /// Marks the tangent as outdated: it will be made anew in the next balance.
  void outdate() { fits_ = false; }
  /// Discards the tangent and the prepared pieces of the next one.
  void forget();
  /// The needle has left the tissue; in the air it needs no springs.
  void release();

  /// Makes the tangent at the present shape; the system's matrix no longer fits it. Needles at rest keep their
  /// tangents, because their shapes hardly change.
  /// @param resting_too whether they need new ones, too
  /// @param advances whether the hand pushes the needle forward; a needle that needed springs will then need them again
  void linearise(const Contacts& contacts, bool resting_too, bool advances, Effort& effort);
  /// Takes a Newton step of the needle with the present tangent. @return false where the tangent belongs to other
  /// contacts
  [[nodiscard]] bool relax();
  /// The same for needles at rest alone. @return whether all their tangents fit
  bool relax_resting(const Contacts& contacts);
  /// Appends a new contact after the present ones to the tangent and the matrix, where they fit.
  void append(int load);

  /// Sets the needle's damping in this sub-step (Needle::damp()).
  void damp(double ratio);
  [[nodiscard]] bool is_damped() const { return damping_ != 0.0; }
  /// Adds a motion of the base [mm], after which the tangent fits less well.
  void wear(double way_mm) { worn_mm_ += way_mm; }
  /// Has the next tangent begun, because an iteration with the present one left too much of the error.
  void wear_out();

  /// At the end of a balance: makes the next piece of the next tangent, if the present one is worn.
  void prepare(const Contacts& contacts);
  /// At the start of a balance: puts a complete next tangent in the place of the present one.
  /// @return points of the contacts that it belongs to; empty where nothing was replaced
  [[nodiscard]] std::span<const int> take_prepared(const Contacts& contacts);

 private:
  enum class Stage { none, begun, tangent, compliance, filled, matrix };

  void lend_springs(const Contacts& contacts, int most, NeedleSide& side);
  void lend_springs_at_rest(const Contacts& contacts, NeedleSide& side);
  int lend_springs_to(const Contacts& contacts, int first, int end, int most, NeedleSide& side);
  void lend_spring(const Contacts& contacts, int load, int stands_for, NeedleSide& side);
  [[nodiscard]] bool prepare_on_springs(const Contacts& contacts);
  [[nodiscard]] bool prepared_contacts_are_there(const Contacts& contacts) const;
  [[nodiscard]] bool expects_springs();

  Needle& needle_;
  ContactSystem& system_;
  const ContactRows& rows_;
  bool fits_ = false;
  int on_springs_for_ = 0;        ///< tangents with springs since a tangent without was tried
  double damping_ = 0.0;          ///< Needle::damp() ratio of this sub-step
  double tangent_damping_ = 0.0;  ///< Needle::damp() ratio for which the tangent was made
  double worn_mm_ = 0.0;          ///< motion of the base since the tangent was made
  std::vector<Mat3> springs_;     ///< [N/mm] lent at each load
  Stage stage_ = Stage::none;     ///< progress of the next tangent
  int lent_ = 0;                  ///< springs lent to the moved needle in the next tangent
  int resting_lent_ = 0;          ///< springs lent to each needle at rest
  bool resting_made_ = false;     ///< whether the needles at rest have tangents
  std::vector<int> points_;       ///< points of the contacts that the next tangent belongs to
};

}  // namespace stylet
