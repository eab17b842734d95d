// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/probe/wall_compliance.hpp"

#include <algorithm>
#include <chrono>

namespace stylet {

namespace {

constexpr int kPointsAtOnce = 32;  // points for which one batch solves

double wall_clock_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

WallCompliance WallCompliance::solve(const Tissue& tissue, std::vector<WallPoint> points, const Progress& progress) {
  const double start = wall_clock_s();
  WallCompliance wall;
  wall.points = std::move(points);
  const int count = wall.count();
  const Eigen::Index dofs = 3 * Eigen::Index{tissue.displacement_nodes()};
  const Eigen::Index of_mesh = 3 * Eigen::Index{tissue.mesh().node_count()};
  wall.among.resize(3 * count, 3 * count);
  wall.nodes.resize(of_mesh, 3 * count);
  for (int first = 0; first < count; first += kPointsAtOnce) {
    report(progress, "compliance of the rectal wall", static_cast<double>(first) / count);
    const int batch = std::min(kPointsAtOnce, count - first);
    MatX f = MatX::Zero(dofs, 3 * batch);
    for (int i = 0; i < batch; ++i) {
      for (const auto& [node, weight] : wall.points[static_cast<std::size_t>(first + i)].weights)
        f.block<3, 3>(3 * Eigen::Index{node}, 3 * i).diagonal().setConstant(weight);
    }
    const MatX u = tissue.solve(f);
    wall.nodes.middleCols(3 * first, 3 * batch) = u.topRows(of_mesh).cast<float>();
    for (int j = 0; j < count; ++j) {
      auto rows = wall.among.block(3 * j, 3 * first, 3, 3 * batch);
      rows.setZero();
      for (const auto& [node, weight] : wall.points[static_cast<std::size_t>(j)].weights)
        rows += weight * u.middleRows(3 * Eigen::Index{node}, 3);
    }
  }
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
