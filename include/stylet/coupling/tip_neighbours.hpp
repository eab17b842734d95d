// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <span>
#include <vector>

namespace stylet {

/// The points whose compliance with the tip is updated when the tip moves (ContactCompliance::restrict_tip()): all, or
/// some. Nothing allocates after reserve().
class TipNeighbours {
 public:
  /// @param points largest number of points
  void reserve(int points) { some_.reserve(static_cast<std::size_t>(points)); }
  /// Calls a function for each of them. @param points number of all points, the tip included
  template <class Function>
  void for_each(int points, const Function& function) const {
    if (!restricted_) {
      for (int point = 1; point < points; ++point) function(point);
    } else {
      for (const int point : some_) function(point);
    }
  }
  /// Changes to all points, of which there are none.
  void reset() { restricted_ = false; }
  [[nodiscard]] bool are_all() const { return !restricted_; }
  [[nodiscard]] bool have(int point) const {
    return !restricted_ || std::find(some_.begin(), some_.end(), point) != some_.end();
  }
  /// Changes to these points. @param renew function that is called for each of them that was not among them before
  template <class Function>
  void restrict(std::span<const int> points, const Function& renew) {
    for (const int point : points) {
      if (!have(point)) renew(point);
    }
    some_.assign(points.begin(), points.end());
    restricted_ = true;
  }
  /// Changes to all points. @param renew the same
  template <class Function>
  void release(int points, const Function& renew) {
    for (int point = 1; point < points; ++point) {
      if (!have(point)) renew(point);
    }
    restricted_ = false;
  }

 private:
  bool restricted_ = false;
  std::vector<int> some_;
};

}  // namespace stylet
