// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/probe/wall_points.hpp"

namespace stylet {

/// How the points of a wall, and all nodes of the mesh, move under forces on these points: w points, n nodes.
struct WallCompliance {
  /// Solves with the tissue's factor, three right-hand sides for each point. Takes seconds.
  /// Errors: those of QuadraticPart::build().
  static Result<WallCompliance> solve(const Tissue& tissue, std::vector<WallPoint> points,
                                      const Progress& progress = {});

  std::vector<WallPoint> points;
  MatX among;             ///< [mm/N] (3w × 3w) displacement of points per force on points, symmetric
  Eigen::MatrixXf nodes;  ///< [mm/N] (3n × 3w) displacement of the nodes of the mesh per force on points
  double seconds = 0.0;   ///< wall-clock time of solve()

  [[nodiscard]] int count() const { return static_cast<int>(points.size()); }
  [[nodiscard]] double megabytes() const;
};

}  // namespace stylet
