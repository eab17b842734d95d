// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "needle/axis_curve.hpp"
#include "needle/rotation_terms.hpp"
#include "stylet/core/types.hpp"
#include "stylet/needle/needle.hpp"

#include <array>
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

/// A pull on one station of the chain, in base axes.
struct Pull {
  Station at;
  double weight = 1.0;  ///< share of the load that acts here
  Vec3 force;           ///< [N] base axes, the share
  Vec3 point;           ///< [mm] base axes, from the base
  Mat3 jacobian;        ///< [mm²] ∂ point/∂κ of the element it is in; of none before the base
};

/// A point load as the chain feels it: one pull, or for rods one at each joint that shapes the centreline there.
struct Pulls {
  std::array<Pull, AxisCurve::kReach> pull;
  int count = 0;
};

/// A chain of elements in base axes (base at the origin, leaving along z), each with a rotation vector l κ that turns
/// the frame: frames and their first derivatives, refreshed by update() whenever the curvature changes. Rods are joined
/// by angular springs D/l; the one at the clamp stands for half a rod only and is 2D/l.
class BeamShape {
 public:
  BeamShape(int elements, double length, double bending_stiffness, double torsion_stiffness,
            ElementKind kind = ElementKind::arc);

  /// [1/mm] (3 elements) body-frame curvature: x, y bending, z twist. Call update() after writing.
  VecX curvature;
  void update();
  /// How often it was updated.
  [[nodiscard]] unsigned revision() const { return revision_; }

  /// [1/mm] (3 elements) curvature of the unloaded shape, 0 for a straight needle.
  VecX rest;

  /// Damping, over the elastic stiffness, and the curvature [1/mm] it resists a change from.
  double damping = 0.0;
  VecX damped_from;

  [[nodiscard]] int elements() const { return elements_; }
  [[nodiscard]] double length() const { return elements_ * element_length_; }
  [[nodiscard]] double element_length() const { return element_length_; }
  [[nodiscard]] Vec3 stiffness() const { return stiffness_; }  ///< [N mm²] EI, EI, GJ
  [[nodiscard]] Vec3 kappa(int e) const { return curvature.segment<3>(dof(e)); }
  /// Curvature beyond that of the unloaded shape [1/mm].
  [[nodiscard]] Vec3 strain(int e) const { return kappa(e) - rest.segment<3>(dof(e)); }

  /// D times this is the moment: strain, and what damping adds to it [1/mm].
  [[nodiscard]] Vec3 moment_strain(int e) const {
    return strain(e) + damping * (kappa(e) - damped_from.segment<3>(dof(e)));
  }

  /// Elastic energy of element e is ½ elastic_weight l Δκᵀ D Δκ, Δκ its strain: 2 for the joint of rods at the clamp,
  /// else 1.
  [[nodiscard]] double elastic_weight(int e) const { return e == 0 ? clamp_weight_ : 1.0; }
  void set_clamp_weight(double weight) {
    clamp_weight_ = weight;
    ++revision_;
  }

  /// Arc lengths past the tip count as the tip.
  [[nodiscard]] Station locate(double s) const;
  [[nodiscard]] Pulls pulls(double s, const Vec3& force) const;

  /// Point [mm] and unit tangent of the chain at a station (of a rod: its end); the part before the base goes straight
  /// on backwards.
  [[nodiscard]] Vec3 point(const Station& at) const;
  [[nodiscard]] Vec3 tangent(const Station& at) const;

  /// Centreline point [mm] and unit tangent at s [mm]: the chain itself, or for rods a smooth curve through the joints.
  [[nodiscard]] Vec3 point(double s) const;
  [[nodiscard]] Vec3 tangent(double s) const;

  [[nodiscard]] AxisPlace place(double s) const;  ///< both, base axes

  /// Elastic energy [N mm].
  [[nodiscard]] double energy() const;

  /// Frames at the start of element e (e = elements is the tip).
  [[nodiscard]] const Mat3& frame(int e) const { return frame_[e]; }
  [[nodiscard]] const Vec3& origin(int e) const { return origin_[e]; }

  /// Turning κ_e by δ turns all beyond element e by the spin Ω_e δ; a point r beyond moves by (D_e - [r]× Ω_e) δ.
  [[nodiscard]] const Mat3& spin(int e) const { return spin_[e]; }    ///< Ω_e [mm]
  [[nodiscard]] const Mat3& shift(int e) const { return shift_[e]; }  ///< D_e [mm²]

  /// Of the part of an element up to a station in it (of a rod: its end).
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
  AxisCurve curve_;  ///< of rods
};

}  // namespace stylet::beam
