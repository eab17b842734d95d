// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/contacts/shaft_contact.hpp"

#include <span>
#include <utility>
#include <vector>

namespace stylet {

/// The points of the compliance that have a contact at rest, and the others. Nothing allocates after construction.
class RestingPoints {
 public:
  /// @param points largest number of points of the compliance
  RestingPoints(std::span<const ShaftContact> resting, int points) : rests_(static_cast<std::size_t>(points), 0) {
    all_.reserve(resting.size());
    free_.reserve(rests_.size());
    for (const ShaftContact& contact : resting) {
      all_.push_back(contact.point);
      rests_[static_cast<std::size_t>(contact.point)] = 1;
    }
  }

  /// The points of contacts at rest. @param first, end numbers of contacts, from 0 on
  [[nodiscard]] std::span<const int> of(int first, int end) const {
    return std::span(all_).subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(end - first));
  }
  /// Points without a contact at rest, but for the tip.
  [[nodiscard]] std::span<const int> free() const { return free_; }
  /// Takes over points that were added. @param points number of all points
  void take(int points) {
    if (std::exchange(known_, points) == points) return;
    free_.clear();
    for (int point = 1; point < points; ++point) {
      if (rests_[static_cast<std::size_t>(point)] == 0) free_.push_back(point);
    }
  }

 private:
  std::vector<int> all_;
  std::vector<char> rests_;  ///< (points)
  std::vector<int> free_;
  int known_ = 1;  ///< number of points that were taken over
};

}  // namespace stylet
