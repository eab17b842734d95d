// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stylet {

/// The law of cutting in a sub-step: axial force F = C + way / slip, where C is the tissue's cutting force. With the
/// viscosity η and a sub-step of h seconds, slip = h/η, so F grows by η times the speed. Another law of cutting is
/// another C or slip. These may depend on the tissue ahead and on earlier sub-steps, but not on F, because the
/// equations need a linear law.
struct CuttingLaw {
  double start_N = 0.0;        ///< C, axial force at which the tip begins to cut
  double slip_mm_per_N = 0.0;  ///< additional length of cut per additional force, > 0; large where the force hardly
                               ///< depends on the speed

  /// [mm] Length of cut under an axial force [N]; negative below C.
  [[nodiscard]] double way(double force) const { return slip_mm_per_N * (force - start_N); }
  /// [N] Axial force at a length of cut [mm].
  [[nodiscard]] double force(double way) const { return start_N + way / slip_mm_per_N; }
};

}  // namespace stylet
