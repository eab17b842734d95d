// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <array>

namespace stylet {

/// A smooth centreline through nodes that are evenly spaced on the axis of the straight needle (node 0 at the clamp,
/// node n at the tip). It is the cubic whose slope at every node is the chord between its neighbours (Catmull & Rom
/// 1974), with the clamp's direction at node 0 and no curvature at node n. Point and direction are continuous along s
/// and linear in the positions of the nodes, so a load at s acts on the nodes with the same weights:
///   r(s) = s e_z + Σ_j w_j(s) d_j,   d_j = x_j − j l e_z   (base axes; d_0 = 0)
class AxisCurve {
 public:
  static constexpr int kReach = 4;  ///< number of nodes that determine the curve at one place

  /// Weights of the nodes first … first + 3; zero for numbers outside 1 … n.
  struct Weights {
    int first = 1;
    std::array<double, kReach> value{};
  };

  /// @param intervals number n of intervals between nodes, ≥ 2
  /// @param spacing distance l of neighbouring nodes [mm]
  AxisCurve(int intervals, double spacing) : intervals_(intervals), spacing_(spacing) {}

  [[nodiscard]] int intervals() const { return intervals_; }
  [[nodiscard]] double spacing() const { return spacing_; }  ///< [mm]

  /// w_j at arc length s [mm]. s beyond the tip counts as the tip; all weights are zero at and before the clamp.
  [[nodiscard]] Weights weights(double s) const;
  /// dw_j/ds [1/mm]
  [[nodiscard]] Weights slopes(double s) const;

  /// Point [mm] of the centreline in base axes. @param deviation d_j [mm] as a function of node j
  template <class Deviation>
  [[nodiscard]] Vec3 point(double s, const Deviation& deviation) const {
    const double end = intervals_ * spacing_;
    return (s < end ? s : end) * Vec3::UnitZ() + sum(weights(s), deviation);
  }
  /// Unit tangent of the centreline in base axes.
  template <class Deviation>
  [[nodiscard]] Vec3 tangent(double s, const Deviation& deviation) const {
    return (Vec3::UnitZ() + sum(slopes(s), deviation)).normalized();
  }

 private:
  /// The interval that contains s: node k at its start, and the position u in it, 0…1.
  struct Place {
    int k;
    double u;
  };
  [[nodiscard]] Place place(double s) const;
  /// Weights of the cubic for given values of the Hermite basis: values and slopes (times the spacing) at both ends.
  [[nodiscard]] Weights spread(int k, double value0, double slope0, double value1, double slope1) const;

  template <class Deviation>
  [[nodiscard]] Vec3 sum(const Weights& w, const Deviation& deviation) const {
    Vec3 total = Vec3::Zero();
    for (int i = 0; i < kReach; ++i) {
      if (w.value[i] != 0.0) total += w.value[i] * deviation(w.first + i);
    }
    return total;
  }

  int intervals_;
  double spacing_;
};

}  // namespace stylet
