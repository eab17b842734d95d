// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/resting_grips.hpp"

#include <span>
#include <vector>

namespace stylet {

/// The forces of contacts at rest along their needles, which decide whether they slip: by the forces of a reference and
/// by the solved columns of RestingForces. Nothing allocates after construction.
class AxialForces {
 public:
  /// @param most_own largest number of contacts of the moved needle, its tip included
  AxialForces(int grips, int most_own);

  /// Takes the forces of a reference. @param frames of the contacts, with the direction along the needle in the last
  /// column @param forces [N] (3 grips)
  void take(std::span<const Mat3> frames, const Eigen::Ref<const VecX>& forces);
  /// Takes the columns W of the moved needle's contacts, and two others (rows × 2); none is known of contacts that
  /// slide.
  void take_columns(const RestingGrips& grips, const Eigen::Ref<const MatX>& others);
  /// Takes the column Z of a contact that slides, if it is not known.
  void know(int grip, RestingGrips& grips);

  /// [N] (grips) the forces of the reference.
  [[nodiscard]] auto reference() const { return force_.head(count()); }
  /// Changes per change of a force on the moved needle (grips × 3 own).
  [[nodiscard]] auto own(Eigen::Index columns) const { return own_.topLeftCorner(count(), columns); }
  /// The two other columns (grips × 2).
  [[nodiscard]] auto others() const { return others_.topRows(count()); }
  /// A column of Z that is known (grips).
  [[nodiscard]] auto slid(int grip) const { return slid_.col(grip).head(count()); }

 private:
  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(t_.size()); }
  void write(const Eigen::Ref<const VecX>& z, const RestingMatrix& matrix, Eigen::Ref<VecX> along);

  std::vector<Vec3> t_;  ///< (grips) directions along the needles
  VecX force_;
  MatX own_, others_, slid_;
  std::vector<char> knows_;  ///< (grips) whether a column of slid_ is known
  VecX now_;                 ///< [N] (3 grips) work space
};

}  // namespace stylet
