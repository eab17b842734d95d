// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "needle/rotation_terms.hpp"
#include "stylet/core/types.hpp"

#include <vector>

namespace stylet::beam {

/// First of the three curvature components of an element; elements · 3 in all.
[[nodiscard]] constexpr Eigen::Index dof(Eigen::Index element) { return 3 * element; }

/// Where an arc length lies: element and distance from the element's start [mm]. Before the base, element is -1 and
/// local is negative.
struct Station {
  int element = -1;
  double local = 0.0;
};

/// A point load in base axes, located.
struct LocatedLoad {
  Station at;
  Vec3 force = Vec3::Zero();  ///< [N] base axes
  Vec3 point = Vec3::Zero();  ///< [mm] base axes, from the base
};

/// The chain of constant-curvature elements in base axes (base at the origin, leaving along z): frames and their first
/// derivatives, refreshed by update() whenever the curvature changes.
class BeamShape {
 public:
  BeamShape(int elements, double length, double bending_stiffness, double torsion_stiffness);

  /// [1/mm] (3 elements) body-frame curvature: x, y bending, z twist. Call update() after writing.
  VecX curvature;
  void update();

  [[nodiscard]] int elements() const { return elements_; }
  [[nodiscard]] double length() const { return elements_ * element_length_; }
  [[nodiscard]] double element_length() const { return element_length_; }
  [[nodiscard]] Vec3 stiffness() const { return stiffness_; }  ///< [N mm²] EI, EI, GJ
  [[nodiscard]] Vec3 kappa(int e) const { return curvature.segment<3>(dof(e)); }

  /// Arc lengths past the tip count as the tip.
  [[nodiscard]] Station locate(double s) const;
  [[nodiscard]] LocatedLoad locate_load(double s, const Vec3& force) const;

  /// Centreline point [mm] and unit tangent; the part before the base goes straight on backwards.
  [[nodiscard]] Vec3 point(const Station& at) const;
  [[nodiscard]] Vec3 tangent(const Station& at) const;

  /// Elastic energy [N mm].
  [[nodiscard]] double energy() const;

  /// Frames at the start of element e (e = elements is the tip).
  [[nodiscard]] const Mat3& frame(int e) const { return frame_[e]; }
  [[nodiscard]] const Vec3& origin(int e) const { return origin_[e]; }

  /// Turning κ_e by δ turns all beyond element e by the spin Ω_e δ; a point r beyond moves by (D_e - [r]× Ω_e) δ.
  [[nodiscard]] const Mat3& spin(int e) const { return spin_[e]; }    ///< Ω_e [mm]
  [[nodiscard]] const Mat3& shift(int e) const { return shift_[e]; }  ///< D_e [mm²]

  /// ∂r/∂κ_e [mm²] of a point inside element e.
  [[nodiscard]] Mat3 inner_jacobian(const Station& at) const;

 private:
  int elements_;
  double element_length_;
  Vec3 stiffness_;
  std::vector<Mat3> frame_;
  std::vector<Vec3> origin_;
  std::vector<Mat3> spin_;
  std::vector<Mat3> shift_;
};

}  // namespace stylet::beam
