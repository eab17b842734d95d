// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/tissue.hpp"
#include "stylet/geom/subdivision.hpp"

#include <array>
#include <memory>
#include <span>

namespace stylet {

namespace detail {
class Discretisation;
}

/// Motion of a volume of tissue as a whole. All its values are linear in the displacement u.
struct VolumeMotion {
  /// Thirds of the volume's extent along z, the patient's axis: of equal height, not of equal volume.
  enum Third { superior = 0, middle = 1, inferior = 2 };

  Vec3 shift_mm = Vec3::Zero();  ///< [mm] LPS, mean displacement (1/V) ∫ u dV
  /// [rad] LPS rotation vector, right-handed: rotation of the rigid motion that fits u best, which minimises
  ///   ∫ |u − a − ω × (X − X̄)|² dV.
  /// Its length is the sine of the angle while it is linear in u, and the angle after VolumeResponse::finite().
  Vec3 rotation_rad = Vec3::Zero();
  /// [mm] LPS, mean displacement of each Third.
  std::array<Vec3, 3> third_mm{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  double dilation = 0.0;  ///< mean relative change of volume (1/V) ∫ div u dV
};

/// The displacement that a rotation by a finite angle has in addition to the linear displacement ω × r, which stretches
/// the body:
///   (R − I) r − ω × r = ω × (ω × r) / (1 + cos θ),  |ω| = sin θ,
/// where R is the rotation about ω by θ (Rodrigues).
/// @param omega sin θ times the unit vector of the axis; its length is at most 1
/// @param r [mm] position relative to the centre of rotation
/// @return [mm]
Vec3 beyond_linear_turn(const Vec3& omega, const Vec3& r);

/// Motion of a volume of tissue per force on single material points. By Betti's reciprocity, a linear functional of the
/// displacement u, which is the work of a load L on u, is
///   ∫ L · u dV = Σ_c w(X_c) · f_c,
/// where w is the displacement that L causes at the places of the forces. For the mean displacement, L is a uniform
/// body force 1/V on the volume along one axis. u is singular at the forces but w is smooth, so a mesh that cannot
/// represent the field of a needle still gives its mean accurately.
class VolumeResponse {
 public:
  /// Elements and mesh on which w is computed.
  enum class Accuracy {
    of_the_tissue,     ///< mesh, elements and factor of the tissue
    quadratic,         ///< quadratic elements on the tissue's mesh
    quadratic_halved,  ///< quadratic elements on the tissue's mesh with every edge halved
  };

  /// Solves for w. Takes seconds, except with Accuracy::of_the_tissue, which uses the existing factor.
  /// @param tissue the response refers to its mesh, which must outlive it
  /// @param regions regions whose elements form the volume; if they have no elements, all motion is zero
  static Result<VolumeResponse> solve(const Tissue& tissue, std::span<const int> regions, Accuracy accuracy,
                                      const Progress& progress = {});

  VolumeResponse(VolumeResponse&&) noexcept;
  VolumeResponse& operator=(VolumeResponse&&) noexcept;
  ~VolumeResponse();

  /// Adds the effect of one force to `motion`. Does not allocate.
  /// @param at material point in the tissue's mesh
  /// @param force [N] LPS
  void add(const MaterialPoint& at, const Vec3& force, VolumeMotion& motion) const;

  /// Makes the rigid part of a summed motion exact: the volume rotates about its centroid by the full rotation instead
  /// of by ω ×. The remaining part, its change of shape, stays the same, and so do shift and dilation.
  /// docs/theory/near_field.md §5 compares the result with a nonlinear model.
  /// @param linear a motion summed by add()
  [[nodiscard]] VolumeMotion finite(const VolumeMotion& linear) const;

  /// Whether the volume has material in a third. One third may be empty where the volume consists of several pieces;
  /// its motion is then zero.
  [[nodiscard]] bool has(VolumeMotion::Third third) const { return share_[third] > 0.0; }

 private:
  /// Functionals: x y z of the mean of each third, x y z of the rotation, dilation. The overall mean follows from the
  /// thirds.
  static constexpr int kFunctionals = 13;
  /// [mm/N], [rad/N], [1/N] (3 × displacement nodes): w, one column per functional.
  using Fields = Eigen::Matrix<double, Eigen::Dynamic, kFunctionals, Eigen::RowMajor>;

  VolumeResponse(const TetMesh& mesh, Element element, std::unique_ptr<Subdivision> halved);
  [[nodiscard]] Fields loads(const TetMesh& mesh, std::span<const int> regions);

  std::unique_ptr<Subdivision> halved_;  ///< the mesh on which w is computed, for Accuracy::quadratic_halved
  std::unique_ptr<detail::Discretisation> discretisation_;
  std::array<double, 3> share_{};  ///< volume of each third / whole volume
  std::array<Vec3, 3> arm_{};      ///< [mm] from the centroid of the volume to the centroid of each third
  Fields w_;
};

}  // namespace stylet
