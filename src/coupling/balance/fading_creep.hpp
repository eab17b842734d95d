// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contacts.hpp"

#include <utility>

namespace stylet {

/// The displacement of the contacts at rest by which the tissue has still to creep, after a look at all laws
/// (RestingHold). Under constant forces λ the memory m goes to λ, and (r − 1) F (m − λ) fades by the same factor in
/// each sub-step. Nothing allocates after construction.
class FadingCreep {
 public:
  /// @param points largest number of points of the compliance
  explicit FadingCreep(int points) : forces_(VecX::Zero(3 * static_cast<Eigen::Index>(points))) {}

  /// At a look, with the forces at its end. @param moves [mm] (3 contacts at rest) (r − 1) F (m − λ), written
  void look(const Contacts& all, Eigen::Ref<VecX> moves);
  /// Begins a sub-step after a look. @return the part of `moves` that fades in it
  [[nodiscard]] double fades(const TissueMemory& memory) {
    if (!memory.on()) return 0.0;
    const double kept = memory.kept();
    return kept * (1.0 - kept) * std::exchange(left_, left_ * kept);
  }

 private:
  double left_ = 1.0;  ///< the part that has not faded since the look
  VecX forces_;        ///< [N] (3 points) work space: (r − 1) (m − λ)
};

}  // namespace stylet
