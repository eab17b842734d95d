// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/types.hpp"

#include <span>
#include <vector>

namespace stylet {

/// A tall matrix A with three rows for each of many nodes, for products of a few rows with a vector, again and again.
///
/// Rows of nodes next to each other resemble each other. So nodes are put into clusters, halved along their longest
/// side, and a cluster's rows A_c ≈ B_c Q_cᵀ are kept as a basis Q_c (columns × r_c), orthonormal, and coordinates B_c
/// in it: block low-rank. A product is Q_cᵀ w once for each cluster that is asked for, then B_c times that. No cluster
/// is off by more than ‖A_c − B_c Q_cᵀ‖₂ ≤ tolerance; where that would save nothing A_c stays as it is.
///
/// Immutable: any number of threads may read, each with a Product of its own. Reading does not allocate.
class LowRankRows {
 public:
  LowRankRows() = default;
  /// @param points of the nodes, any unit
  /// @param rows A (3 nodes × columns)
  /// @param tolerance in the units of A; 0: A as it is
  /// @param together nodes that are read together: they have clusters of their own, so that few are asked then
  LowRankRows(std::span<const Vec3> points, const Eigen::Ref<const Eigen::MatrixXf>& rows, double tolerance,
              std::span<const Index> together = {}, const Progress& progress = {});

  /// A vector to multiply with, and what the clusters' bases made of it as far as they were asked.
  class Product {
   public:
    /// Another vector is set by writing here, and forget().
    Eigen::VectorXf& vector() { return vector_; }
    void forget();

   private:
    friend class LowRankRows;
    Eigen::VectorXf vector_;      ///< (columns)
    Eigen::VectorXf in_basis_;    ///< Q_cᵀ w of all clusters
    std::vector<char> is_there_;  ///< (clusters) in in_basis_
  };
  [[nodiscard]] Product make_product() const;

  /// The rows of a node times the vector.
  [[nodiscard]] Eigen::Vector3f times(Index node, Product& product) const;
  /// Aᵀ of a node as it is kept (columns × 3). Allocates.
  [[nodiscard]] Eigen::Matrix<float, Eigen::Dynamic, 3> transposed(Index node) const;

  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Cluster {
    bool is_compressed = false;   ///< or else the basis is the identity
    Eigen::MatrixXf basis;        ///< Q_c (columns × r)
    Eigen::MatrixXf coordinates;  ///< B_cᵀ (r × 3 of its nodes)
    Eigen::Index first = 0;       ///< of its part of Product::in_basis_
  };
  struct Place {
    Index cluster = -1;
    Index within = -1;
  };
  Eigen::Index columns_ = 0;
  std::vector<Cluster> clusters_;
  std::vector<Place> place_;  ///< (nodes)
};

}  // namespace stylet
