// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/near_field/near_place.hpp"
#include "stylet/geom/fine_surface.hpp"
#include "stylet/sim/model.hpp"

#include <memory>
#include <span>
#include <vector>

namespace stylet {

/// Adds the near field of the needle to pictures: the displacement right beside the needle that a mesh cannot represent
/// and that a DisplayField therefore lacks, A − Λ K⁻¹ Λᵀ of NearFieldCompliance, at points of surfaces. With it the
/// skin is drawn where the tip that presses on it is (docs/theory/display.md).
///
/// The effect of a force whose place stays the same is cached; for a force that moves, such as the tip's, it is
/// computed for each picture. For one thread at a time. No system of equations is solved.
class DisplayNearField {
 public:
  /// @param points between nodes of the mesh (SurfacePoint::node); points away from the planned paths, where the model
  ///   has no kernel, are not moved
  DisplayNearField(std::shared_ptr<const Model> model, std::span<const SurfacePoint> points);

  /// Replaces the forces. Allocates when there are more of them than in any earlier call.
  void set(std::span<const TissueForce> forces);

  /// Adds the near field to the displacement of the points. @param u (3 × points) [mm] LPS
  void add(Eigen::Ref<Eigen::Matrix3Xf> u) const;

  /// Number of points near a planned path, which are the points that the near field may move.
  [[nodiscard]] std::size_t points() const { return numbers_.size(); }
  /// Sum of the magnitudes [N] of the forces at places where the model has no kernel; their near field is not shown.
  [[nodiscard]] double left_out_N() const { return left_out_N_; }

 private:
  /// A place whose blocks are cached, and whether one of the present forces acts there.
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
  std::vector<Eigen::Index> numbers_;                   ///< indices of the points that may be moved
  std::vector<NearPlace> places_;                       ///< (numbers) their places
  std::vector<Index> nodes_;                            ///< nodes of the mesh between which these points lie
  std::vector<std::array<std::size_t, 3>> node_slots_;  ///< (places) positions in nodes_ of the place's nodes
  std::vector<Mat3> of_node_;                           ///< (nodes) mesh kernel g of one force; scratch
  std::vector<Source> sources_;
  Eigen::MatrixXf blocks_;  ///< (3 places × 3 sources) [mm/N]
  /// The part of blocks_ that only forces on the needle's scale have, not lasting forces, which are spread widely;
  /// empty if no tissue creeps or stiffens.
  Eigen::MatrixXf narrow_;
  Eigen::VectorXf moved_;  ///< (3 places) [mm]
  double left_out_N_ = 0.0;
};

}  // namespace stylet
