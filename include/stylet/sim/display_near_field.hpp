// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/near_field/near_place.hpp"
#include "stylet/geom/fine_surface.hpp"
#include "stylet/sim/model.hpp"

#include <memory>
#include <span>
#include <vector>

namespace stylet {

/// What the needle does to the tissue right beside it, for pictures: the near field that a mesh cannot represent and a
/// DisplayField therefore lacks, A − Λ K⁻¹ Λᵀ of NearFieldCompliance, at points of surfaces. With it the skin lies
/// where the tip that presses on it is (docs/theory/display.md).
///
/// What a force that stays where it is does to a point is kept; of those that move, as the tip's does, it is computed
/// for each picture. For one thread at a time; nothing is solved.
class DisplayNearField {
 public:
  /// @param points between nodes of the mesh (SurfacePoint::node); those away from the planned ways, where the model
  ///   has no kernel, are not moved
  DisplayNearField(std::shared_ptr<const Model> model, std::span<const SurfacePoint> points);

  /// Takes new forces in the place of those before. Allocates while there are more of them than ever before.
  void set(std::span<const TissueForce> forces);

  /// Adds the near field [mm] LPS. @param u (3 × points)
  void add(Eigen::Ref<Eigen::Matrix3Xf> u) const;

  /// Points that may be moved.
  [[nodiscard]] std::size_t points() const { return numbers_.size(); }
  /// Sum of the magnitudes [N] of forces where the model has no kernel: their near field is not shown.
  [[nodiscard]] double left_out_N() const { return left_out_N_; }

 private:
  /// A force's place, and whether it is one of now.
  struct Source {
    TissueForce force;
    bool used = false;
  };
  [[nodiscard]] std::size_t slot_for(const TissueForce& force);
  void compute(std::size_t slot);
  [[nodiscard]] NearPlace place_of(const TissueForce& force) const;
  void stiffen(const TissueForce& tip, std::size_t slot);
  [[nodiscard]] bool knows_wide() const;

  std::shared_ptr<const Model> model_;
  NeedleKernel needle_;
  std::vector<Eigen::Index> numbers_;                   ///< of the points that may be moved
  std::vector<NearPlace> places_;                       ///< of these
  std::vector<Index> nodes_;                            ///< of the mesh, that any of them hangs on
  std::vector<std::array<std::size_t, 3>> node_slots_;  ///< (places) in nodes_, of the shape's nodes
  std::vector<Mat3> of_node_;                           ///< (nodes) room for g of one force
  std::vector<Source> sources_;
  Eigen::MatrixXf blocks_;  ///< (3 places × 3 sources) [mm/N]
  Eigen::MatrixXf narrow_;  ///< what of blocks_ lasting forces lack, being wide; empty: no tissue creeps or stiffens
  Eigen::VectorXf moved_;   ///< (3 places) [mm]
  double left_out_N_ = 0.0;
};

}  // namespace stylet
