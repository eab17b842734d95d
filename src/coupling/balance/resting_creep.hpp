// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contacts.hpp"

#include <span>
#include <utility>

namespace stylet {

/// The displacements by the forces m that creeping tissue remembers at all contacts (TissueMemory), while the needles
/// at rest follow the moved needle (RestingHold). In each sub-step m goes towards the present forces λ.
/// - The contacts at rest have still to be moved by (r − 1) F (m − λ), which fades by the same factor in each sub-step.
/// - The moved needle's contacts are displaced by F_or m of the contacts at rest, which goes towards F_or λ, so that
///   only contacts whose λ changes are read.
/// Nothing allocates after construction.
class RestingCreep {
 public:
  /// @param points largest number of points of the compliance @param most_own largest number of contacts of the moved
  /// needle, its tip included
  RestingCreep(int points, int most_own)
      : forces_(VecX::Zero(3 * static_cast<Eigen::Index>(points))),
        remembered_(VecX::Zero(3 * static_cast<Eigen::Index>(most_own))),
        by_forces_(remembered_) {}

  /// At a look, with the forces at its end. @param moves [mm] (3 contacts at rest) (r − 1) F (m − λ), written
  void look(const Contacts& all, Eigen::Ref<VecX> moves);
  /// Begins a sub-step after a look. @return the part of `moves` that fades in it
  [[nodiscard]] double fades(const TissueMemory& memory) {
    if (!memory.on()) return 0.0;
    const double kept = memory.kept();
    return kept * (1.0 - kept) * std::exchange(left_, left_ * kept);
  }

  /// Takes the present forces and memory of the contacts at rest. @param own points of the moved needle's shaft
  /// contacts
  void take(const Contacts& all, std::span<const int> own);
  /// The force on a point at rest changes by `force`, and its memory by `memory` [N].
  void change(const ContactCompliance& tissue, std::span<const int> own, int point, const Vec3& force,
              const Vec3& memory);
  /// Ends a sub-step. @param kept TissueMemory::kept()
  void end(double kept) { remembered_ = kept * remembered_ + (1.0 - kept) * by_forces_; }
  /// [mm] F_or m of a contact. @param row first row of a contact of the moved needle; not the tip's
  [[nodiscard]] Vec3 remembered(Eigen::Index row) const { return remembered_.segment<3>(row); }

 private:
  double left_ = 1.0;  ///< the part that has not faded since the look
  VecX forces_;        ///< [N] (3 points) work space: (r − 1) (m − λ)
  VecX remembered_;    ///< [mm] (3 own) F_or m
  VecX by_forces_;     ///< [mm] (3 own) F_or λ
};

}  // namespace stylet
