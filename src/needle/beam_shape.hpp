// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "needle/axis_curve.hpp"
#include "needle/rotation_terms.hpp"
#include "stylet/core/types.hpp"
#include "stylet/needle/needle.hpp"

#include <array>
#include <vector>

namespace stylet::beam {

/// Number of the first of the three curvature components of an element; with element = number of elements, their total.
[[nodiscard]] constexpr Eigen::Index dof(Eigen::Index element) { return 3 * element; }

/// Position of an arc length on the chain: element, and distance from the element's start [mm]. Before the base,
/// `element` is -1 and `local` is negative.
struct Station {
  int element = -1;
  double local = 0.0;
};

/// A force that acts at one station of the chain.
struct Pull {
  Station at;
  double weight = 1.0;  ///< share of the load that acts here
  Vec3 force;           ///< [N] base axes: this share of the load
  Vec3 point;           ///< [mm] base axes, relative to the base
  Mat3 jacobian;        ///< [mm²] ∂ point/∂κ of the element that contains the station; zero before the base
};

/// The forces of one point load on the chain: one pull, or with rods one pull at each joint that determines the
/// centreline there.
struct Pulls {
  std::array<Pull, AxisCurve::kReach> pull;
  int count = 0;
};

/// A chain of elements in base axes (base at the origin, leaving along z). Each element turns the frame by a rotation
/// vector l κ. update() computes the frames and their first derivatives and has to be called when the curvature
/// changes. Rods are joined by angular springs D/l; the spring at the clamp stands for half a rod only and is 2D/l.
class BeamShape {
 public:
  BeamShape(int elements, double length, double bending_stiffness, double torsion_stiffness,
            ElementKind kind = ElementKind::arc);

  /// [1/mm] (3 elements) curvature in the body frame: x, y bending, z twist. Call update() after writing.
  VecX curvature;
  void update();
  /// Number of calls of update(); values computed for the same number are still valid.
  [[nodiscard]] unsigned revision() const { return revision_; }

  /// [1/mm] (3 elements) curvature of the unloaded shape, 0 for a straight needle.
  VecX rest;

  /// Damping stiffness / elastic stiffness, and the curvature [1/mm] from which changes are resisted.
  double damping = 0.0;
  VecX damped_from;

  [[nodiscard]] int elements() const { return elements_; }
  [[nodiscard]] double length() const { return elements_ * element_length_; }
  [[nodiscard]] double element_length() const { return element_length_; }
  [[nodiscard]] Vec3 stiffness() const { return stiffness_; }  ///< [N mm²] EI, EI, GJ
  [[nodiscard]] Vec3 kappa(int e) const { return curvature.segment<3>(dof(e)); }
  /// Curvature minus the curvature of the unloaded shape [1/mm].
  [[nodiscard]] Vec3 strain(int e) const { return kappa(e) - rest.segment<3>(dof(e)); }

  /// The moment is D times this: strain() plus the part of damping [1/mm].
  [[nodiscard]] Vec3 moment_strain(int e) const {
    return strain(e) + damping * (kappa(e) - damped_from.segment<3>(dof(e)));
  }

  /// The elastic energy of element e is ½ elastic_weight l Δκᵀ D Δκ with Δκ = strain(e). The weight is 2 for the joint
  /// of rods at the clamp, else 1.
  [[nodiscard]] double elastic_weight(int e) const { return e == 0 ? clamp_weight_ : 1.0; }
  void set_clamp_weight(double weight) {
    clamp_weight_ = weight;
    ++revision_;
  }

  /// Station of arc length s [mm]; s beyond the tip counts as the tip.
  [[nodiscard]] Station locate(double s) const;
  [[nodiscard]] Pulls pulls(double s, const Vec3& force) const;

  /// Point [mm] and unit tangent of the chain at a station (for a rod, only its end is exact). Before the base the
  /// chain continues straight backwards.
  [[nodiscard]] Vec3 point(const Station& at) const;
  [[nodiscard]] Vec3 tangent(const Station& at) const;

  /// Point [mm] and unit tangent of the centreline at s [mm]: the chain itself, or with rods a smooth curve through the
  /// joints.
  [[nodiscard]] Vec3 point(double s) const;
  [[nodiscard]] Vec3 tangent(double s) const;

  [[nodiscard]] AxisPlace place(double s) const;  ///< point(s) and tangent(s), base axes

  /// Elastic energy [N mm].
  [[nodiscard]] double energy() const;

  /// Frame and origin at the start of element e; e = elements() stands for the tip.
  [[nodiscard]] const Mat3& frame(int e) const { return frame_[e]; }
  [[nodiscard]] const Vec3& origin(int e) const { return origin_[e]; }

  /// A change δ of κ_e turns everything beyond element e by the spin Ω_e δ. A point r beyond it moves by
  ///   (D_e - [r]× Ω_e) δ.
  [[nodiscard]] const Mat3& spin(int e) const { return spin_[e]; }    ///< Ω_e [mm]
  [[nodiscard]] const Mat3& shift(int e) const { return shift_[e]; }  ///< D_e [mm²]

  /// Rotation of the part of an element up to a station in it.
  [[nodiscard]] RotationTerms terms(const Station& at) const {
    return RotationTerms(at.local * kappa(at.element), kind_);
  }

 private:
  [[nodiscard]] Pull pull(const Station& at, double weight, const Vec3& force) const;
  [[nodiscard]] Vec3 deviation(int node) const { return origin_[node] - node * element_length_ * Vec3::UnitZ(); }

  ElementKind kind_;
  unsigned revision_ = 0;
  double clamp_weight_;
  int elements_;
  double element_length_;
  Vec3 stiffness_;
  std::vector<Mat3> frame_;
  std::vector<Vec3> origin_;
  std::vector<Mat3> spin_;
  std::vector<Mat3> shift_;
  AxisCurve curve_;  ///< centreline of rods
};

}  // namespace stylet::beam
