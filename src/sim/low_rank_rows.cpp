// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/low_rank_rows.hpp"

#include "stylet/core/parallel.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>

#include <algorithm>
#include <functional>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <utility>

namespace stylet {

namespace {

/// Largest number of nodes in a cluster. Smaller clusters have smaller bases, but a picture needs more of them.
constexpr std::ptrdiff_t kClusterNodes = 512;
constexpr Eigen::Index kFirstGuess = 128;  ///< number of random samples for the first attempt at a basis
constexpr double kWorthIt = 0.75;          ///< a cluster is compressed only to at most this fraction of the size of A_c
constexpr unsigned kSampleSeed = 20050102;

void halve(std::span<const Vec3> points, std::span<Index> nodes, const std::function<void(std::span<Index>)>& found) {
  const auto count = static_cast<std::ptrdiff_t>(nodes.size());
  if (count <= kClusterNodes) {
    if (count > 0) found(nodes);
    return;
  }
  Eigen::AlignedBox3d box;
  for (const Index node : nodes) box.extend(points[static_cast<std::size_t>(node)]);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const auto along = [&](Index node) { return std::pair(points[static_cast<std::size_t>(node)][axis], node); };
  std::nth_element(nodes.begin(), nodes.begin() + count / 2, nodes.end(),
                   [&](Index a, Index b) { return along(a) < along(b); });
  halve(points, nodes.first(static_cast<std::size_t>(count / 2)), found);
  halve(points, nodes.subspan(static_cast<std::size_t>(count / 2)), found);
}

struct Factors {
  Eigen::MatrixXf basis;
  Eigen::MatrixXf coordinates;
};

/// Factorises M ≈ Q B with ‖M − Q B‖₂ ≤ tolerance: an orthonormal basis of random combinations of the columns, enlarged
/// until it suffices (Halko, Martinsson & Tropp 2011), then reduced by the directions in which M is small. Empty if Q
/// and B would need nearly as much memory as M.
std::optional<Factors> factorise(const Eigen::MatrixXf& M, double tolerance) {
  // The errors of the two reductions are orthogonal, so their squares add up to tolerance².
  const double part = tolerance / std::numbers::sqrt2;
  const auto most =
      static_cast<Eigen::Index>(kWorthIt * static_cast<double>(M.size()) / static_cast<double>(M.rows() + M.cols()));
  if (most == 0) return std::nullopt;
  std::mt19937 random(kSampleSeed);
  std::normal_distribution<float> normal;
  for (Eigen::Index rank = std::min(kFirstGuess, most);; rank = std::min(2 * rank, most)) {
    Eigen::MatrixXf samples(M.cols(), rank);
    for (float& value : samples.reshaped()) value = normal(random);
    const Eigen::HouseholderQR<Eigen::MatrixXf> qr(M * samples);
    const Eigen::MatrixXf basis = qr.householderQ() * Eigen::MatrixXf::Identity(M.rows(), rank);
    const Eigen::MatrixXf coordinates = basis.transpose() * M;
    if (static_cast<double>((M - basis * coordinates).norm()) <= part) {
      const MatX B = coordinates.cast<double>();
      const Eigen::SelfAdjointEigenSolver<MatX> eigen(B * B.transpose());
      const Eigen::Index kept = (eigen.eigenvalues().array() > part * part).count();
      const Eigen::MatrixXf main = eigen.eigenvectors().rightCols(kept).cast<float>();
      return Factors{basis * main, main.transpose() * coordinates};
    }
    if (rank == most) return std::nullopt;
  }
}

}  // namespace

LowRankRows::LowRankRows(std::span<const Vec3> points, const Eigen::Ref<const Eigen::MatrixXf>& rows, double tolerance,
                         std::span<const Index> together, const Progress& progress)
    : columns_(rows.cols()), place_(points.size()) {
  std::vector<Index> nodes(points.size());
  std::iota(nodes.begin(), nodes.end(), 0);
  std::vector<std::span<const Index>> members;
  std::vector<char> is_together(points.size(), 0);
  for (const Index node : together) is_together[static_cast<std::size_t>(node)] = 1;
  const auto others = std::stable_partition(
      nodes.begin(), nodes.end(), [&](Index node) { return is_together[static_cast<std::size_t>(node)] != 0; });
  const auto add_cluster = [&](std::span<Index> of_one) {
    std::sort(of_one.begin(), of_one.end());
    for (std::size_t i = 0; i < of_one.size(); ++i)
      place_[static_cast<std::size_t>(of_one[i])] = {static_cast<Index>(members.size()), static_cast<Index>(i)};
    members.emplace_back(of_one);
  };
  halve(points, {nodes.begin(), others}, add_cluster);
  halve(points, {others, nodes.end()}, add_cluster);
  clusters_.resize(members.size());
  const auto compress = [&](std::size_t c) {
    Cluster& cluster = clusters_[c];
    Eigen::MatrixXf M(columns_, 3 * static_cast<Eigen::Index>(members[c].size()));
    for (std::size_t i = 0; i < members[c].size(); ++i)
      M.middleCols<3>(3 * static_cast<Eigen::Index>(i)) =
          rows.middleRows<3>(3 * Eigen::Index{members[c][i]}).transpose();
    if (auto factors = tolerance > 0.0 ? factorise(M, tolerance) : std::nullopt) {
      cluster.is_compressed = true;
      cluster.basis = std::move(factors->basis);
      cluster.coordinates = std::move(factors->coordinates);
    } else {
      cluster.coordinates = std::move(M);
    }
  };
  for_each_in_parallel(clusters_.size(), compress, progress, "display: compressing");
  Eigen::Index first = 0;
  for (Cluster& cluster : clusters_) {
    cluster.first = first;
    first += cluster.basis.cols();
  }
}

void LowRankRows::Product::forget() { std::fill(is_there_.begin(), is_there_.end(), char{0}); }

LowRankRows::Product LowRankRows::make_product() const {
  Product product;
  product.vector_ = Eigen::VectorXf::Zero(columns_);
  product.is_there_.assign(clusters_.size(), 0);
  product.in_basis_ =
      Eigen::VectorXf::Zero(clusters_.empty() ? 0 : clusters_.back().first + clusters_.back().basis.cols());
  return product;
}

Eigen::Vector3f LowRankRows::times(Index node, Product& product) const {
  const Place at = place_[static_cast<std::size_t>(node)];
  const Cluster& cluster = clusters_[static_cast<std::size_t>(at.cluster)];
  const auto rows = cluster.coordinates.middleCols<3>(3 * Eigen::Index{at.within});
  const auto times_vector = [](const auto& columns, const auto& vector, auto&& out) {
    for (Eigen::Index j = 0; j < columns.cols(); ++j) out[j] = columns.col(j).dot(vector);
  };
  Eigen::Vector3f result;
  if (!cluster.is_compressed) {
    times_vector(rows, product.vector_, result);
    return result;
  }
  auto in_basis = product.in_basis_.segment(cluster.first, cluster.basis.cols());
  char& is_there = product.is_there_[static_cast<std::size_t>(at.cluster)];
  if (is_there == 0) {
    times_vector(cluster.basis, product.vector_, in_basis);
    is_there = 1;
  }
  times_vector(rows, in_basis, result);
  return result;
}

Eigen::Matrix<float, Eigen::Dynamic, 3> LowRankRows::transposed(Index node) const {
  const Place at = place_[static_cast<std::size_t>(node)];
  const Cluster& cluster = clusters_[static_cast<std::size_t>(at.cluster)];
  const auto rows = cluster.coordinates.middleCols<3>(3 * Eigen::Index{at.within});
  if (!cluster.is_compressed) return rows;
  return cluster.basis * rows;
}

std::size_t LowRankRows::bytes() const {
  Eigen::Index numbers = 0;
  for (const Cluster& cluster : clusters_) numbers += cluster.basis.size() + cluster.coordinates.size();
  return static_cast<std::size_t>(numbers) * sizeof(float);
}

}  // namespace stylet
