// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "needle/block_band.hpp"
#include "needle/tet_shape.hpp"
#include "stylet/needle/needle.hpp"

#include <span>
#include <vector>

namespace stylet::tet {

/// Stiffness of a bar of tetrahedra at its present shape, factorised: the middle nodes of every segment are eliminated
/// first (no load acts on them), which leaves 15 unknowns a layer and neighbours only.
class TetTangent {
 public:
  TetTangent(const TetShape& shape, int load_capacity);

  /// Gradient, stiffness, factor and L⁻¹Jᵀ for these loads. @param base_rotation base axes to LPS
  /// @param springs [N/mm] LPS, one per load or none: added to the stiffness as Jᵀ G J
  /// @return false where it was given up: there is no factor then
  bool assemble(const TetShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
                std::span<const Mat3> springs = {}, Indefinite otherwise = Indefinite::shift);

  /// J K⁻¹ Jᵀ [mm/N] (3w × 3w) LPS and -J K⁻¹ g [mm] (3w) LPS.
  void condense(Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free) const;

  /// Gradient for this shape and these loads; stiffness, J and springs as assemble() left them.
  /// @param free -J K⁻¹ g [mm] (3w) LPS, written
  /// @return false, and nothing done, when there were fewer loads, or there is no factor
  bool relax(const TetShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads, Eigen::Ref<VecX> free);

  /// Adds the Newton step for these loads to the displacement.
  void step(std::span<const PointLoad> loads, TetShape& shape);

  /// Multiple of the material part that was added to make the stiffness positive definite, 0 below the buckling load.
  [[nodiscard]] double material_shift() const { return material_shift_; }

  /// Gradient [N] and stiffness [N/mm] in the order of TetShape::displacement, without springs and shift; for checks,
  /// allocates.
  [[nodiscard]] VecX gradient() const { return gradient_; }
  [[nodiscard]] MatX stiffness(const TetShape& shape) const;

 private:
  /// Stiffness of one segment: blocks (i, j), i ≥ j, of `material` plus `geometric`(i, j) times the unit matrix.
  struct SegmentStiffness {
    Eigen::Matrix<double, 3 * kMostNodes, 3 * kMostNodes> material;
    Eigen::Matrix<double, kMostNodes, kMostNodes> geometric;
  };
  /// A middle node taken out: pivot L Lᵀ, and for every neighbour its coupling times L⁻ᵀ.
  struct Eliminated {
    Mat3 L;
    std::array<Mat3, kFirstMiddle> coupling;
  };

  void reserve(Eigen::Index loads);
  void assemble_segment(const TetShape& shape, int segment);
  void assemble_loads(const TetShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads);
  void assemble_gradient(const TetShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads);
  [[nodiscard]] bool factorise(double shift);
  [[nodiscard]] bool eliminate_middle(int segment);
  void add_segment(int segment);
  void add_springs(const Mat3& base_rotation, std::span<const Mat3> springs);
  void move_loads(Eigen::Ref<VecX>& free) const;
  [[nodiscard]] bool factorise_shifted(const Mat3& base_rotation, std::span<const Mat3> springs, Indefinite otherwise);
  void reduce_gradient();
  [[nodiscard]] Eigen::Index start(Eigen::Index first_load, Eigen::Index last_load) const;

  int segments_;
  SegmentMesh mesh_;
  std::vector<std::vector<int>> neighbours_;  ///< of each middle node, those not eliminated before it
  std::vector<SegmentStiffness> stiffness_;
  Eigen::Matrix<double, 3 * kMostNodes, 3 * kMostNodes> work_;
  std::vector<Eliminated> eliminated_;  ///< segment by segment
  BlockBand band_;
  VecX gradient_;                          ///< in the order of TetShape::displacement
  VecX middle_;                            ///< (3 middle nodes · segments) L⁻¹ of the gradient there
  VecX z_, step_;                          ///< (15 segments) L⁻¹ of the reduced gradient, work
  std::vector<AxisCurve::Weights> loads_;  ///< where each load acts
  VecX force_;                             ///< [N] (3w) LPS
  MatX Y_;                                 ///< (15 segments × 3 capacity) L⁻¹ Jᵀ
  long assembled_ = -1;                    ///< revision of the shape that stiffness_ is of
  double material_shift_ = 0.0;
  bool factorised_ = false;  ///< not where it was given up
};

}  // namespace stylet::tet
