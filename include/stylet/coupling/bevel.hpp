// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <cmath>

namespace stylet {

/// A tip ground to a single bevel. At roll 0 its sharp side, which has the point, lies towards the base's local x axis,
/// and the bevel's face looks away from it. The shaft is drawn towards the sharp side. Rolling the base turns the
/// bevel.
struct Bevel {
  enum class Law {
    offset,  ///< the cut runs beside the axis on the sharp side; the shaft is drawn into it @cite Chentanez2009
    force    ///< the tissue pushes the tip sideways, in proportion to the tip's axial force @cite Misra2010
  };
  double angle_rad = 0.0;  ///< angle between the bevel's face and the axis, 0 … π/3; 0: a symmetric tip
  Law law = Law::offset;
  double force_ratio = 0.06;  ///< for Law::force: lateral over axial force of the tip

  [[nodiscard]] bool offsets() const { return angle_rad != 0.0 && law == Law::offset; }
  [[nodiscard]] bool pushes() const { return angle_rad != 0.0 && law == Law::force; }

  /// tan ψ, where ψ is the angle between the cut and the axis. The tip is a wedge with one face along the shaft and the
  /// other turned from it by the bevel's angle; a wedge cuts along its bisector, so ψ is half that angle.
  [[nodiscard]] double slope() const { return offsets() ? std::tan(0.5 * angle_rad) : 0.0; }

  /// Unit vector towards the sharp side at the tip, perpendicular to the tangent: the base's x axis, transported along
  /// the shaft without twist.
  /// @param tangent unit vector at the tip, LPS
  [[nodiscard]] static Vec3 sharp_side(const Pose& base, const Vec3& tangent);
};

}  // namespace stylet
