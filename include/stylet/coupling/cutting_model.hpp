// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <string>

namespace stylet {

/// A law of cutting that a program brings in place of the built-in one. A tip that cuts with the speed v [mm/s] is
/// resisted by the axial force F = C + η v. The built-in law takes C from the region and η from the scenario; a derived
/// class may let both depend on the place of the tip and on how fast it has cut. Model::with() puts it into a model;
/// examples/own_cutting_law.cpp is a complete program.
class CuttingModel {
 public:
  /// The tip at the start of a sub-step, and the numbers of the built-in law there.
  struct Tip {
    int region = -1;                   ///< number of the region that is cut (TetMesh::regions)
    Vec3 at_mm = Vec3::Zero();         ///< [mm] LPS, in the undeformed patient
    double cut_mm_per_s = 0.0;         ///< [mm/s] speed of cutting in the last sub-step; 0 where the tip did not cut
    double cutting_N = 0.0;            ///< [N] C of the region, tissue.REGION.cutting_N
    double viscosity_Ns_per_mm = 0.0;  ///< [N s/mm] η, coupling.tip_viscosity_Ns_per_m
  };
  /// The law of one sub-step: both numbers finite and not negative.
  struct Law {
    double cutting_N = 0.0;            ///< [N] C, the axial force at which the tip begins to cut
    double viscosity_Ns_per_mm = 0.0;  ///< [N s/mm] η
  };

  virtual ~CuttingModel() = default;
  /// Name of the law for report and warnings.
  [[nodiscard]] virtual std::string name() const = 0;
  /// The law of the coming sub-step. It is called from within a step, in the thread that steps: it must not allocate,
  /// lock or throw, and the same arguments must give the same result. A law that is not finite, or negative, is not
  /// used: the built-in one stands in for it, and the step is flagged Step::unusable_law.
  [[nodiscard]] virtual Law law(const Tip& tip) const = 0;
};

}  // namespace stylet
