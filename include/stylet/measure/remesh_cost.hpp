// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/coupling/contact_compliance.hpp"
#include "stylet/fem/compliance_store.hpp"

#include <memory>

namespace stylet::measure {

/// A straight way of a needle and the tissue around it. The object that `locator` points to must outlive it.
struct NeedleWay {
  std::shared_ptr<const ComplianceStore> store;  ///< has the compliance of the nodes around the way
  const Locator* locator = nullptr;
  std::shared_ptr<const MatX> inverse;  ///< paper::full_inverse of the tissue
  Vec3 from = Vec3::Zero();             ///< [mm] LPS, start, outside the tissue or on its surface
  Vec3 to = Vec3::Zero();               ///< [mm] LPS, end
};

struct RemeshCostOptions {
  Placement placement = Placement::face;  ///< face: the paper's rule; interior: the default
  double spacing_mm = 2.75;  ///< distance between nodes inside elements; least distance between nodes on faces
  int most_nodes = 20;
  int rounds = 15;         ///< repeats of the whole way for the default's method, Woodbury and BLAS
  int bcs_rounds = 1;      ///< repeats of the whole way for boundary condition switches, which are slow
  int inverse_rounds = 0;  ///< repeats of the inversion from scratch, after the last node
};

/// Processor times of one change of the mesh, in which a node is added and the compliance among all held points is
/// updated. Median and maximum are over all events of all rounds.
struct RemeshCost {
  struct Times {
    double median_s = 0.0;
    double largest_s = 0.0;
  };
  int nodes = 0;        ///< nodes of the mesh before the changes
  int dofs = 0;         ///< order of K before the changes
  int change = 0;       ///< largest order of ΔK of all events, without held nodes
  int events = 0;       ///< number of nodes added along the way
  Times ours;           ///< the default: find the element, split it, new row and column of the held points' compliance
  Times ours_cold;      ///< the same directly after an update of all of K⁻¹, which empties the caches
  Times woodbury;       ///< find the element, ΔK, new rows, all of K⁻¹ by the matrix inversion lemma (one triangle)
  Times woodbury_full;  ///< the lemma on the whole matrix, as the paper writes it; update of K⁻¹ only
  Times bcs;            ///< find the element, ΔK, all of K⁻¹ by boundary condition switches
  Times inverse;        ///< K assembled and inverted from scratch
  Times rank_update;    ///< BLAS dsyrk of the same order and rank as the lemma, a lower bound of its time
  Times stiffness;      ///< ΔK alone
  Times hat;            ///< the 3 × 3 stiffness of the new node's hat function alone
  double woodbury_update_s = 0.0;  ///< median of the update of K⁻¹ alone, to be compared with rank_update
  double largest_error = 0.0;      ///< largest relative difference between the methods' compliances of added nodes
};

/// Adds nodes along the way with every method in turn and times each event.
/// Errors: failed, when no node can be added, or when the methods differ by more than 1e-8.
Result<RemeshCost> measure_remeshing(const NeedleWay& way, const RemeshCostOptions& options,
                                     const Progress& progress = {});

/// Multiplications and divisions of one update of an N × N inverse with a k × k change, counted by running the
/// algorithms with a number type that counts its operations.
struct CountedCost {
  double switches = 0.0;
  double woodbury = 0.0;
};
/// @param added how many of the k degrees of freedom are new; each of these needs one switch instead of two
CountedCost count_operations(int N, int k, int added = 0);

}  // namespace stylet::measure
