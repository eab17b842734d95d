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
  OwnPoints(int most, int points) : number_(static_cast<std::size_t>(points), 0) {
    points_.reserve(static_cast<std::size_t>(most));
  }

  [[nodiscard]] std::span<const int> all() const { return points_; }
  /// How many of the first contacts are the same, and in their order.
  [[nodiscard]] std::size_t same(std::span<const ShaftContact> own) const {
    std::size_t same = 0;
    while (same < std::min(own.size(), points_.size()) && own[same].point == points_[same]) ++same;
    return same;
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
};

}  // namespace stylet
