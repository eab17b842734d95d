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

/// How a volume of tissue has moved as a whole. Of a displacement u all of it is linear in u.
struct VolumeMotion {
  /// Thirds of the volume's extent along z, which is the patient's axis: equal heights, not equal volumes.
  enum Third { superior = 0, middle = 1, inferior = 2 };

  Vec3 shift_mm = Vec3::Zero();  ///< LPS, (1/V) ∫ u dV
  /// LPS rotation vector, right-handed: of the rigid motion next to u, which makes ∫ |u − a − ω × (X − X̄)|² dV least.
  /// While linear in u its length is the sine of the angle; after VolumeResponse::finite() the angle.
  Vec3 rotation_rad = Vec3::Zero();
  std::array<Vec3, 3> third_mm{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  ///< LPS, mean over each Third
  double dilation = 0.0;                                                   ///< (1/V) ∫ div u dV
};

/// The displacement that a turn by a finite angle adds to the linear displacement ω × r, which stretches what it turns:
///   (R − I) r − ω × r = ω × (ω × r) / (1 + cos θ),  |ω| = sin θ,
/// R being the rotation about ω by θ (Rodrigues). @param omega sine of the angle along the axis, at most 1 long
/// @param r [mm] from the centre of the turn @return [mm]
Vec3 beyond_linear_turn(const Vec3& omega, const Vec3& r);

/// How forces on single material points move a volume of tissue. By Betti's reciprocity a linear functional of their
/// displacement u, which is the work that a load L does on it, is
///   ∫ L · u dV = Σ_c w(X_c) · f_c,
/// w being what L does where the forces act: for the mean displacement, L is a uniform body force on the volume, 1/V in
/// each direction. Unlike u, which is singular at the forces, w is smooth: a mesh that cannot represent the field of a
/// needle gives its mean well.
class VolumeResponse {
 public:
  /// The elements and the mesh with which w is solved for.
  enum class Accuracy {
    of_the_tissue,     ///< the tissue's own mesh, elements and factor
    quadratic,         ///< quadratic elements on its mesh
    quadratic_halved,  ///< quadratic elements on its mesh with every edge halved
  };

  /// Takes seconds but for Accuracy::of_the_tissue, which has its factor already.
  /// @param tissue its mesh outlives this
  /// @param regions whose elements make the volume; nothing moves where there are none
  static Result<VolumeResponse> solve(const Tissue& tissue, std::span<const int> regions, Accuracy accuracy,
                                      const Progress& progress = {});

  VolumeResponse(VolumeResponse&&) noexcept;
  VolumeResponse& operator=(VolumeResponse&&) noexcept;
  ~VolumeResponse();

  /// Adds to `motion` what a force does. Does not allocate.
  /// @param at in the tissue's mesh @param force [N] LPS
  void add(const MaterialPoint& at, const Vec3& force, VolumeMotion& motion) const;

  /// The motion with its rigid part exact, of one that add() has summed up: the volume turns about its centroid by the
  /// whole rotation instead of by ω ×, and what is left, its change of shape, stays as it is. Shift and dilation are
  /// the same; docs/theory/near_field.md §5 says how near that comes to a nonlinear model.
  [[nodiscard]] VolumeMotion finite(const VolumeMotion& linear) const;

  /// Which thirds the volume has; one may be missing where it is in several pieces, and then never moves.
  [[nodiscard]] bool has(VolumeMotion::Third third) const { return share_[third] > 0.0; }

 private:
  /// Functionals: x y z of each third's mean, x y z of the rotation, dilation. The mean of all follows from the thirds.
  static constexpr int kFunctionals = 13;
  /// [mm/N], [rad/N], [1/N] (3 × displacement nodes), a column for each functional.
  using Fields = Eigen::Matrix<double, Eigen::Dynamic, kFunctionals, Eigen::RowMajor>;

  VolumeResponse(const TetMesh& mesh, Element element, std::unique_ptr<Subdivision> halved);
  [[nodiscard]] Fields loads(const TetMesh& mesh, std::span<const int> regions);

  std::unique_ptr<Subdivision> halved_;  ///< where w lives on that
  std::unique_ptr<detail::Discretisation> discretisation_;
  std::array<double, 3> share_{};  ///< of the volume, of each third
  std::array<Vec3, 3> arm_{};      ///< [mm] from the volume's centroid to each third's
  Fields w_;
};

}  // namespace stylet
