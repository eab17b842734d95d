// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

namespace stylet {

/// Isotropic linear elastic material.
struct Material {
  double young_MPa = 0.0;  ///< Young's modulus [MPa], > 0
  double poisson = 0.0;    ///< Poisson's ratio, in (-1, 0.5)

  /// Lamé's first constant [MPa].
  [[nodiscard]] double lambda() const { return young_MPa * poisson / ((1 + poisson) * (1 - 2 * poisson)); }
  [[nodiscard]] double mu() const { return young_MPa / (2 * (1 + poisson)); }  ///< shear modulus [MPa]

  bool operator==(const Material&) const = default;
};

}  // namespace stylet
