// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/contacts.hpp"

namespace stylet {

/// v = (λ, −ρ) of TipReach, the force on the tip and the part of it that stiffening spares the tissue, as a linear
/// function of the force near the present one.
struct TipLaw {
  using Vec6 = Eigen::Matrix<double, 6, 1>;

  Vec3 force = Vec3::Zero();  ///< λ [N] that it was made for
  Vec6 v = Vec6::Zero();      ///< [N] under this force
  Eigen::Matrix<double, 6, 3> slope = Eigen::Matrix<double, 6, 3>::Zero();

  /// The law at the present force.
  [[nodiscard]] static TipLaw of(const Contacts& all) {
    TipLaw law;
    law.force = law.v.head<3>() = all.tip.force;
    law.slope.topRows<3>().setIdentity();
    const ContactCompliance& tissue = all.tissue.compliance();
    if (!tissue.stiffens()) return law;
    const TipRelief relief(tissue, all.tip.force, Vec3::Zero());  // ρ does not depend on the others
    law.v.tail<3>() = -relief.spared();
    law.slope.bottomRows<3>() = -relief.kept();
    return law;
  }

  [[nodiscard]] Vec6 at(const Vec3& now) const { return v + slope * (now - force); }
};

}  // namespace stylet
