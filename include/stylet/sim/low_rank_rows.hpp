// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/types.hpp"

#include <span>
#include <vector>

namespace stylet {

/// A tall matrix A with three rows for each of many nodes, compressed for fast products of some of its rows with a
/// vector.
///
/// The rows of neighbouring nodes are similar. Therefore the nodes are divided into clusters by halving along the
/// longest side, and the rows of a cluster c are stored in block low-rank form, A_c ≈ B_c Q_cᵀ, with an orthonormal
/// basis Q_c (columns × r_c) and coordinates B_c. For a vector w, Q_cᵀ w is computed once for each cluster that is
/// read, then multiplied by rows of B_c. The error of each cluster is ‖A_c − B_c Q_cᵀ‖₂ ≤ tolerance; a cluster for
/// which the compressed form would save nothing is stored as it is.
///
/// Immutable: any number of threads may read, each with its own Product. Reading does not allocate.
class LowRankRows {
 public:
  LowRankRows() = default;
  /// @param points positions of the nodes, any unit
  /// @param rows A (3 nodes × columns)
  /// @param tolerance in the unit of A; 0: A is stored as it is
  /// @param together nodes that are usually read together: they get clusters of their own, so that fewer clusters are
  ///   needed to read them
  LowRankRows(std::span<const Vec3> points, const Eigen::Ref<const Eigen::MatrixXf>& rows, double tolerance,
              std::span<const Index> together = {}, const Progress& progress = {});

  /// A vector w to multiply by, and a cache of the products Q_cᵀ w of the clusters that have been read.
  class Product {
   public:
    /// The vector w (columns). Call forget() after writing to it.
    Eigen::VectorXf& vector() { return vector_; }
    void forget();  ///< clears the cache

   private:
    friend class LowRankRows;
    Eigen::VectorXf vector_;      ///< (columns)
    Eigen::VectorXf in_basis_;    ///< Q_cᵀ w of all clusters, one after the other
    std::vector<char> is_there_;  ///< (clusters) whether the cluster's part of in_basis_ is valid
  };
  [[nodiscard]] Product make_product() const;

  /// The rows of a node times the vector.
  [[nodiscard]] Eigen::Vector3f times(Index node, Product& product) const;
  /// The rows of a node as stored, transposed (columns × 3). Allocates.
  [[nodiscard]] Eigen::Matrix<float, Eigen::Dynamic, 3> transposed(Index node) const;

  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Cluster {
    bool is_compressed = false;   ///< false: the basis is the identity and is not stored
    Eigen::MatrixXf basis;        ///< Q_c (columns × r)
    Eigen::MatrixXf coordinates;  ///< B_cᵀ (r × 3 nodes of the cluster)
    Eigen::Index first = 0;       ///< start of the cluster's part of Product::in_basis_
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
