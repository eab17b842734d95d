// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet {

/// The axial force F of a tip that cuts, in a sub-step: F = C + way / slip. C is the tissue's cutting force. With
/// viscosity η and a sub-step of h seconds slip = h/η, so that F grows by η times the speed. Another law of cutting is
/// another C or slip, which may depend on the tissue ahead and on earlier sub-steps, but not on F: the equations have
/// it as a line.
struct CuttingLaw {
  double start_N = 0.0;        ///< C, axial force at which the tip begins to cut
  double slip_mm_per_N = 0.0;  ///< further way for each newton more, > 0: a force that is all the same has a large one

  /// [mm] How far the tip cuts under an axial force [N]; negative below C.
  [[nodiscard]] double way(double force) const { return slip_mm_per_N * (force - start_N); }
  /// [N] The axial force under which it cuts so far [mm].
  [[nodiscard]] double force(double way) const { return start_N + way / slip_mm_per_N; }
};

}  // namespace stylet
