// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/coupling/contact_compliance.hpp"
#include "stylet/fem/compliance_store.hpp"

#include <memory>

namespace stylet::measure {

/// Where a needle goes, and the tissue it goes through; what it refers to must outlive it.
struct NeedleWay {
  std::shared_ptr<const ComplianceStore> store;  ///< holds the nodes around the way
  const Locator* locator = nullptr;
  std::shared_ptr<const MatX> inverse;  ///< paper::full_inverse of the tissue
  Vec3 from = Vec3::Zero();             ///< [mm] LPS, outside the tissue or on its surface
  Vec3 to = Vec3::Zero();
};

struct RemeshCostOptions {
  Placement placement = Placement::face;  ///< face: the paper's rule; interior: the default
  double spacing_mm = 2.75;               ///< between nodes inside elements, and the least between nodes on faces
  int most_nodes = 20;
  int rounds = 15;         ///< of the whole way, for ours, Woodbury and BLAS
  int bcs_rounds = 1;      ///< boundary condition switches take their time
  int inverse_rounds = 0;  ///< from scratch, after the last node
};

/// What one change of the mesh costs: a node is added, the compliance among all points held so far is right again.
/// Processor times of whole events; every event of every round counts.
struct RemeshCost {
  struct Times {
    double median_s = 0.0;
    double largest_s = 0.0;
  };
  int nodes = 0;        ///< of the mesh before
  int dofs = 0;         ///< of the stiffness before: the order of K
  int change = 0;       ///< order of ΔK, held nodes not counted; the largest of all events
  int events = 0;       ///< nodes added along the way
  Times ours;           ///< find the element, split it, new row and column of the compliance among the points held
  Times ours_cold;      ///< the same right after an update of all of K⁻¹, which leaves nothing of it in the caches
  Times woodbury;       ///< find the element, ΔK, new rows, all of K⁻¹ by the matrix inversion lemma (one triangle)
  Times woodbury_full;  ///< the lemma on the whole matrix, as the paper writes it; K⁻¹ only
  Times bcs;            ///< find the element, ΔK, all of K⁻¹ by boundary condition switches
  Times inverse;        ///< K assembled and inverted from scratch
  Times rank_update;    ///< BLAS dsyrk of the same order and rank as the lemma: the least it can cost
  Times stiffness;      ///< ΔK alone
  Times hat;            ///< the 3 × 3 stiffness of the new node's hat function alone
  double woodbury_update_s = 0.0;  ///< median of the update of K⁻¹ alone, to be compared with rank_update
  double largest_error = 0.0;      ///< of the compliance among the added nodes, method against method, relative
};

/// Adds nodes along a straight way by every method in turn and times each event.
/// Errors: failed, when no node can be added, or when the methods differ by more than 1e-8.
Result<RemeshCost> measure_remeshing(const NeedleWay& way, const RemeshCostOptions& options,
                                     const Progress& progress = {});

/// Multiplications and divisions of one update of an N × N inverse with k degrees of freedom involved, counted by
/// running the algorithms on numbers that count.
struct CountedCost {
  double switches = 0.0;
  double woodbury = 0.0;
};
/// @param added how many of the k are new: switches take them one way only
CountedCost count_operations(int N, int k, int added = 0);

}  // namespace stylet::measure
