// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <complex>
#include <cstdint>
#include <vector>

namespace stylet {

/// Complex Gaussian noise that is fixed in the material: random numbers on a cubic lattice, linear in between, scaled
/// so that the mean power of the result is 1 at every point. The lattice repeats after kPoints points; its axes are
/// turned against LPS, so that no picture lies along them.
class SpeckleLattice {
 public:
  static constexpr int kPoints = 64;          ///< along an axis
  static constexpr double kSpacing_mm = 0.2;  ///< of points; smaller than what the beam resolves

  explicit SpeckleLattice(std::uint32_t seed);

  /// Transform of material points [mm] LPS to positions on the lattice. All are positive within 1.8 m of the origin.
  [[nodiscard]] Eigen::Vector3f position(const Vec3& x) const {
    return (axes_ * x / kSpacing_mm + Vec3::Constant(kPoints * 256.0)).cast<float>();
  }
  /// A difference of material points as a difference of positions.
  [[nodiscard]] Eigen::Vector3f difference(const Vec3& dx) const { return (axes_ * dx / kSpacing_mm).cast<float>(); }

  /// Noise at a position on the lattice (real part, imaginary part).
  [[nodiscard]] std::complex<float> at(const Eigen::Vector3f& position) const;

  /// Correlation of the noise at two points at a distance [mm], averaged over positions and directions.
  [[nodiscard]] static double correlation(double distance_mm);

 private:
  static constexpr int kRow = 2 * (kPoints + 1);  // numbers of a row; its first point is repeated at its end
  Mat3 axes_;
  std::vector<float> table_;  ///< (points² × kRow) real and imaginary parts
};

}  // namespace stylet
