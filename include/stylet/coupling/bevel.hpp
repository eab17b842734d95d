// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <cmath>

namespace stylet {

/// A tip ground to a single bevel. At roll 0 the sharp side, where the point is, lies towards the base's local x and
/// the bevel's face looks away from it; the shaft is drawn to its sharp side. Rolling the base turns the bevel.
struct Bevel {
  enum class Law {
    offset,  ///< the cut runs beside the axis on the sharp side; the shaft is drawn into it @cite Chentanez2009
    force    ///< the tissue pushes the tip sideways by a share of the tip's axial force @cite Misra2010
  };
  double angle_rad = 0.0;  ///< between the bevel's face and the axis, 0 … π/3; 0 = a symmetric tip
  Law law = Law::offset;
  double force_ratio = 0.06;  ///< of `force`: lateral over axial force of the tip

  [[nodiscard]] bool offsets() const { return angle_rad != 0.0 && law == Law::offset; }
  [[nodiscard]] bool pushes() const { return angle_rad != 0.0 && law == Law::force; }

  /// tan ψ, ψ between cut and axis. The tip is a wedge with one face along the shaft and the other turned from it by
  /// the bevel's angle; a wedge cuts along its bisector, ψ = half the angle.
  [[nodiscard]] double slope() const { return offsets() ? std::tan(0.5 * angle_rad) : 0.0; }

  /// Direction of the sharp side at the tip, unit, square to the tangent: the base's x carried along the shaft without
  /// twisting it.
  /// @param tangent of the tip, unit, LPS
  [[nodiscard]] static Vec3 sharp_side(const Pose& base, const Vec3& tangent);
};

}  // namespace stylet
