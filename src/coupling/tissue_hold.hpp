// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <cstdint>

namespace stylet {

/// The effect of needles at rest on the tissue, as the needle that the hand moves feels it while it is balanced alone:
/// they hold the tissue, so that it yields less at the moved needle's points, and they displace it.
class TissueHold {
 public:
  virtual ~TissueHold() = default;

  /// [mm/N] What they take off the compliance between two points of the moved needle.
  [[nodiscard]] virtual Mat3 reduction(int point, int other) const = 0;
  /// [mm] LPS, displacement of a point of the moved needle by the needles at rest, with no force on the moved needle.
  [[nodiscard]] virtual Vec3 displacement(int point) const = 0;
  /// [mm] Σ_c C_cᵀ g_c over their contacts (TipRelief).
  [[nodiscard]] virtual Vec3 of_others() const = 0;
  /// Writes their forces [N]. @param forces (3 × points)
  virtual void write_forces(Eigen::Ref<MatX> forces) const = 0;
  /// Changes whenever a reduction has changed.
  [[nodiscard]] virtual std::uint64_t version() const = 0;
};

}  // namespace stylet
