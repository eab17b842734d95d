// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/probe/wall_compliance.hpp"

#include "stylet/fem/quadratic_part.hpp"

#include <Eigen/SparseCore>

#include <algorithm>
#include <chrono>
#include <optional>

namespace stylet {

namespace {

constexpr int kPointsAtOnce = 32;  // points for which one batch solves
/// [mm] Elements with a node closer to a point than this are made quadratic: the wall, and the fat between it and the
/// gland, which are one or two elements thick. With twice as much the force is 2 % smaller and preparing takes twice as
/// long.
constexpr double kQuadratic_mm = 10.0;
/// Largest number of mesh nodes with which elements are made quadratic; the quadratic part of finer meshes takes
/// minutes and gigabytes.
constexpr Index kMostQuadratic = 60000;

/// How much the nodes' motions count beside the areas' differences when the nodes are fitted to the areas.
constexpr double kLeft = 0.001;

using Weights = std::vector<std::pair<Index, double>>;

double wall_clock_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Puts forces of 1 N in each direction, spread by weights, into three columns.
void spread(const Weights& weights, Eigen::Ref<MatX> loads) {
  for (const auto& [node, weight] : weights)
    loads.block<3, 3>(3 * Eigen::Index{node}, 0).diagonal().setConstant(weight);
}

/// Adds the mean by weights of the displacements in all columns.
void add_mean(const Weights& weights, const MatX& u, Eigen::Ref<MatX> rows) {
  for (const auto& [node, weight] : weights) rows += weight * u.middleRows<3>(3 * Eigen::Index{node});
}

Result<std::optional<QuadraticPart>> part_near(const std::vector<WallPoint>& points, const Tissue& tissue) {
  if (tissue.element() == Element::p2 || tissue.mesh().node_count() > kMostQuadratic)
    return std::optional<QuadraticPart>();
  auto part = QuadraticPart::build(tissue, [&](const Vec3& x) {
    return std::any_of(points.begin(), points.end(), [&](const WallPoint& point) {
      return (point.position_mm - x).squaredNorm() < kQuadratic_mm * kQuadratic_mm;
    });
  });
  if (!part) return part.error();
  return std::optional<QuadraticPart>(*std::move(part));
}

/// Solves batch by batch: in the quadratic part with its rim held, which leaves forces on the whole tissue at the rim,
/// then in the whole tissue under these forces. Without a quadratic part the forces are those on the points.
class WallSolver {
 public:
  WallSolver(const Tissue& tissue, const QuadraticPart* part, WallCompliance& wall)
      : tissue_(tissue),
        part_(part),
        wall_(wall),
        forces_(3 * Eigen::Index{tissue.displacement_nodes()}, 3 * Eigen::Index{wall.count()}) {
    wall.among.setZero(3 * wall.count(), 3 * wall.count());
    wall.nodes.setZero(3 * Eigen::Index{tissue.mesh().node_count()}, 3 * wall.count());
    for (const WallPoint& point : wall.points) {
      weights_.push_back(part ? area_weights(point, part->tissue(), [&](Index tet) { return part->number(tet); })
                              : point.weights);
    }
  }

  void solve_part(int first, int count) {
    MatX on_whole = MatX::Zero(forces_.rows(), 3 * count);
    if (part_) {
      const MatX loads = loads_on(part_->tissue(), first, count);
      const MatX u = part_->tissue().solve(loads);
      part_->add_rim_forces(loads, u, on_whole);
      for (int j = 0; j < wall_.count(); ++j)
        add_mean(weights_[static_cast<std::size_t>(j)], u, wall_.among.block(3 * j, 3 * first, 3, 3 * count));
      add_to_nodes(u, first, count);
    } else {
      on_whole = loads_on(tissue_, first, count);
    }
    forces_.middleCols(3 * first, 3 * count) = on_whole.sparseView();
  }

  void solve_whole(int first, int count) {
    const MatX u = tissue_.solve(MatX(forces_.middleCols(3 * first, 3 * count)));
    wall_.among.middleCols(3 * first, 3 * count) += forces_.transpose() * u;
    auto nodes = wall_.nodes.middleCols(3 * first, 3 * count);
    if (!part_) {
      nodes = u.topRows(wall_.nodes.rows()).cast<float>();
      return;
    }
    for (Index k = 0; k < tissue_.mesh().node_count(); ++k) {
      if (!part_->has_node(k))
        nodes.middleRows<3>(3 * Eigen::Index{k}) = u.middleRows<3>(3 * Eigen::Index{k}).cast<float>();
    }
    add_to_nodes(part_->with_rim_moved(u), first, count);
  }

  /// Moves the nodes of the wall so that the mesh, which is linear between its nodes, takes the areas to where the
  /// quadratic part does: by the smallest motions that leave little of the difference. Some of it is left where areas
  /// are finer than the elements, whose faces stay flat.
  void fit_nodes_to_areas() {
    if (!part_) return;
    const Eigen::Index count = wall_.count();
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t k = 0; k < wall_.points.size(); ++k) {
      for (const auto& [node, weight] : wall_.points[k].weights)
        entries.emplace_back(static_cast<int>(k), node, weight);
    }
    Eigen::SparseMatrix<double> means(count, tissue_.mesh().node_count());
    means.setFromTriplets(entries.begin(), entries.end());
    MatX normal = MatX(means * means.transpose());
    normal.diagonal().array() += kLeft * normal.trace() / static_cast<double>(count);
    const Eigen::LDLT<MatX> factor(normal);
    for (int axis = 0; axis < 3; ++axis) {
      const auto rows = [&](Eigen::Index of) { return Eigen::seqN(axis, of, 3); };
      const MatX is = wall_.nodes(rows(means.cols()), Eigen::all).cast<double>();
      const MatX missing = wall_.among(rows(count), Eigen::all) - means * is;
      wall_.nodes(rows(means.cols()), Eigen::all) += (means.transpose() * factor.solve(missing)).cast<float>();
    }
  }

 private:
  /// @param u [mm] displacement of the part
  void add_to_nodes(const MatX& u, int first, int count) {
    for (Index k = 0; k < part_->tissue().mesh().node_count(); ++k) {
      wall_.nodes.block(3 * Eigen::Index{part_->node_of_whole(k)}, 3 * first, 3, 3 * count) +=
          u.middleRows<3>(3 * Eigen::Index{k}).cast<float>();
    }
  }

  [[nodiscard]] MatX loads_on(const Tissue& tissue, int first, int count) const {
    MatX loads = MatX::Zero(3 * Eigen::Index{tissue.displacement_nodes()}, 3 * count);
    for (int i = 0; i < count; ++i) spread(weights_[static_cast<std::size_t>(first + i)], loads.middleCols<3>(3 * i));
    return loads;
  }

  const Tissue& tissue_;
  const QuadraticPart* part_;
  WallCompliance& wall_;
  std::vector<Weights> weights_;        ///< (points) of the part, or without it of the whole tissue
  Eigen::SparseMatrix<double> forces_;  ///< [N] (3 × displacement nodes, 3 × points) on the whole tissue
};

}  // namespace

Result<WallCompliance> WallCompliance::solve(const Tissue& tissue, std::vector<WallPoint> points,
                                             const Progress& progress) {
  const double start = wall_clock_s();
  WallCompliance wall;
  wall.points = std::move(points);
  report(progress, "tissue near the rectal wall", 0.0);
  const Result<std::optional<QuadraticPart>> part = part_near(wall.points, tissue);
  if (!part) return part.error();
  WallSolver solver(tissue, *part ? &**part : nullptr, wall);
  const auto in_batches = [&](const char* what, void (WallSolver::*solve)(int first, int count)) {
    for (int first = 0; first < wall.count(); first += kPointsAtOnce) {
      report(progress, what, static_cast<double>(first) / wall.count());
      (solver.*solve)(first, std::min(kPointsAtOnce, wall.count() - first));
    }
  };
  in_batches("tissue near the rectal wall", &WallSolver::solve_part);
  in_batches("compliance of the rectal wall", &WallSolver::solve_whole);
  solver.fit_nodes_to_areas();
  wall.among = (0.5 * (wall.among + wall.among.transpose())).eval();  // the solution is symmetric only up to rounding
  report(progress, "compliance of the rectal wall", 1.0);
  wall.seconds = wall_clock_s() - start;
  return wall;
}

double WallCompliance::megabytes() const {
  return 1e-6 *
         (static_cast<double>(among.size()) * sizeof(double) + static_cast<double>(nodes.size()) * sizeof(float));
}

}  // namespace stylet
