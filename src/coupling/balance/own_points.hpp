// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/contacts/shaft_contact.hpp"
#include "stylet/coupling/contact_compliance.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace stylet {

/// The points of the shaft contacts of the needle that the hand moves, and the number of each among its contacts.
/// Nothing allocates after construction.
class OwnPoints {
 public:
  /// @param most largest number of its contacts @param points largest number of points of the compliance
  OwnPoints(int most, int points)
      : number_(static_cast<std::size_t>(points), 0), forces_(VecX::Zero(3 * static_cast<Eigen::Index>(most) + 3)) {
    points_.reserve(static_cast<std::size_t>(most));
  }

  [[nodiscard]] std::span<const int> all() const { return points_; }
  /// How many of the first contacts are the same, and in their order.
  [[nodiscard]] std::size_t same(std::span<const ShaftContact> own) const {
    std::size_t same = 0;
    while (same < std::min(own.size(), points_.size()) && own[same].point == points_[same]) ++same;
    return same;
  }
  /// [N] (3 known) The forces on the tip and on the contacts that are still there; zero for those that have gone. A
  /// view of work space. @param known number of contacts, the tip included
  [[nodiscard]] Eigen::Ref<const VecX> forces(const Vec3& tip, std::span<const ShaftContact> own, int known) const {
    auto forces = forces_.head(3 * static_cast<Eigen::Index>(known));
    forces.setZero();
    forces.head<3>() = tip;
    const std::size_t there = std::min(same(own), static_cast<std::size_t>(known) - 1);
    for (std::size_t i = 0; i < there; ++i) forces.segment<3>(3 * static_cast<Eigen::Index>(i) + 3) = own[i].force;
    return forces;
  }
  /// Changes to these contacts.
  void take(std::span<const ShaftContact> own) {
    points_.clear();
    number_[ContactCompliance::kTip] = 0;
    for (const ShaftContact& contact : own) {
      points_.push_back(contact.point);
      number_[static_cast<std::size_t>(contact.point)] = static_cast<Eigen::Index>(points_.size());
    }
  }
  /// First row of a point's contact; the tip comes first.
  [[nodiscard]] Eigen::Index row(int point) const { return 3 * number_[static_cast<std::size_t>(point)]; }

 private:
  std::vector<int> points_;
  std::vector<Eigen::Index> number_;  ///< (points)
  mutable VecX forces_;               ///< work space
};

}  // namespace stylet
