// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contact_system.hpp"
#include "coupling/balance/contacts.hpp"
#include "coupling/balance/effort.hpp"
#include "stylet/coupling/step_phases.hpp"

#include <vector>

namespace stylet {

/// The needle's tangent that the equations are made with, and the next one. A tangent and the matrix made of it cost as
/// much as many iterations, but a balance can do without new ones: an iteration with an old tangent converges to the
/// same balance, linearly. So it is kept over many steps; meanwhile the next one is made beside it, one piece after
/// each balance that left time for it, and then takes its place. All pieces but the first are of a shape some steps
/// old, which is as good: the tangent that they replace is of a much older one.
///
/// A needle that is pressed harder than it can bear on its own has no definite tangent. It is lent springs at its
/// contacts (docs/theory/coupling.md §4).
class NeedleTangent {
 public:
  /// All outlive the tangent. @param system its part of the needle is written @param rows loads on the needle
  NeedleTangent(Needle& needle, ContactSystem& system, const ContactRows& rows, int most_contacts,
                PhaseObserver* const& phases);

  /// Whether the tangent is of the present contacts.
  [[nodiscard]] bool fits() const { return fits_; }
  /// It is to be made anew at the next occasion.
  void outdate() { fits_ = false; }
  /// It is to be made anew, and what was prepared is of no use.
  void forget();
  /// The needle is out of the tissue: in air it needs no springs.
  void release();

  /// Makes the tangent at the present shape; the system's matrix no longer fits it.
  /// @param advances whether the hand pushes the needle on: one that needed springs will need them again
  void linearise(const Contacts& contacts, bool advances, Effort& effort);
  /// Takes the needle's step with the tangent that is there. @return false where that is of other contacts
  [[nodiscard]] bool relax();
  /// Adds a contact that has come alive, which follows those there, to tangent and matrix where they fit.
  void append(int load);

  /// Damps the needle in this sub-step (Needle::damp()).
  void damp(double ratio);
  /// The base has moved by so much [mm], which wears the tangent.
  void wear(double way_mm) { worn_mm_ += way_mm; }
  /// An iteration with the tangent left so much of the error that the next one is to be begun.
  void wear_out();

  /// At the end of a balance: makes the next piece of the next tangent, if the present one is worn.
  void prepare(const Contacts& contacts);
  /// At the start of a balance: a tangent that is complete is in use from now on.
  /// @return the contacts' points that it is of; none where nothing was taken
  [[nodiscard]] std::span<const int> take_prepared(const Contacts& contacts);

 private:
  enum class Stage { none, begun, tangent, compliance, filled, matrix };

  void lend_springs(const Contacts& contacts, int most, std::vector<LentSpring>& lent);
  [[nodiscard]] bool prepare_on_springs(const Contacts& contacts);
  [[nodiscard]] bool prepared_contacts_are_there(const Contacts& contacts) const;
  [[nodiscard]] bool expects_springs();

  Needle& needle_;
  ContactSystem& system_;
  const ContactRows& rows_;
  PhaseObserver* const& phases_;
  bool fits_ = false;
  int on_springs_for_ = 0;        ///< tangents on springs since one without was tried
  double damping_ = 0.0;          ///< ratio of this sub-step
  double tangent_damping_ = 0.0;  ///< ratio of the sub-step that the tangent is of
  double worn_mm_ = 0.0;          ///< way of the base since the tangent was made
  std::vector<Mat3> springs_;     ///< [N/mm] lent at each load
  Stage stage_ = Stage::none;     ///< how far the next tangent has come
  int lent_ = 0;                  ///< most springs of the next tangent, 0 = none
  std::vector<int> points_;       ///< of the contacts that the next tangent is of
};

}  // namespace stylet
