// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "needle/beam_shape.hpp"
#include "stylet/needle/needle.hpp"

#include <algorithm>
#include <cassert>
#include <span>
#include <vector>

namespace stylet::beam {

/// The pulls of point loads on the chain, load by load, each for the shape at which the load was added. Nothing
/// allocates after reserve().
class LoadPulls {
 public:
  /// Allocates memory for this number of loads.
  void reserve(Eigen::Index loads) {
    pulls_.reserve(static_cast<std::size_t>(AxisCurve::kReach * loads));
    ends_.reserve(static_cast<std::size_t>(loads));
    last_moved_.reserve(static_cast<std::size_t>(loads));
  }

  /// Adds a load at the end. @param base_rotation base axes to LPS
  void add(const BeamShape& shape, const Mat3& base_rotation, const PointLoad& load) {
    const Pulls pulls = shape.pulls(load.s, base_rotation.transpose() * load.force);
    int last = -1;
    for (int i = 0; i < pulls.count; ++i) {
      pulls_.push_back(pulls.pull[static_cast<std::size_t>(i)]);
      last = std::max(last, pulls_.back().at.element);
    }
    ends_.push_back(static_cast<int>(pulls_.size()));
    last_moved_.push_back(last);
  }
  /// Removes all loads after the first `loads` ones.
  void keep_first(Eigen::Index loads) {
    assert(loads <= count());
    last_moved_.resize(static_cast<std::size_t>(loads));
    ends_.resize(static_cast<std::size_t>(loads));
    pulls_.resize(loads == 0 ? 0 : static_cast<std::size_t>(ends_.back()));
  }

  /// Number of loads.
  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(ends_.size()); }
  /// The pulls of all loads, in base axes.
  [[nodiscard]] std::span<const Pull> all() const { return pulls_; }
  /// The pulls of one load, in base axes.
  [[nodiscard]] std::span<const Pull> of(Eigen::Index load) const {
    const auto c = static_cast<std::size_t>(load);
    const int begin = load == 0 ? 0 : ends_[c - 1];
    return all().subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(ends_[c] - begin));
  }

  /// The element nearest to the tip whose curvature moves the point of a load; -1 if there is none.
  [[nodiscard]] int last_moved(Eigen::Index load) const { return last_moved_[static_cast<std::size_t>(load)]; }
  /// The same for the loads first … last − 1 together.
  [[nodiscard]] int last_moved(Eigen::Index first, Eigen::Index last) const {
    int element = -1;
    for (Eigen::Index load = first; load < last; ++load) element = std::max(element, last_moved(load));
    return element;
  }

 private:
  std::vector<Pull> pulls_;
  std::vector<int> ends_;        ///< (loads) number of pulls up to and including those of the load
  std::vector<int> last_moved_;  ///< (loads)
};

}  // namespace stylet::beam
