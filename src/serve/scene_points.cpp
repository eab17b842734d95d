// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_points.hpp"

namespace stylet::serve {

std::vector<SurfacePoint> nodes_as_points(const TetMesh& mesh) {
  std::vector<SurfacePoint> points;
  points.reserve(static_cast<std::size_t>(mesh.node_count()));
  for (Index node = 0; node < mesh.node_count(); ++node) points.push_back({{node, -1, -1}, {1.0, 0.0, 0.0}});
  return points;
}

std::vector<SurfacePoint> ScenePoints::on_mesh() const {
  std::vector<SurfacePoint> points;
  points.reserve(nodes.size() + fines.size());
  for (const Index node : nodes) points.push_back({{node, -1, -1}, {1.0, 0.0, 0.0}});
  for (SurfacePoint point : fines) {
    for (Index& node : point.node) {
      if (node >= 0) node = nodes[static_cast<std::size_t>(node)];
    }
    points.push_back(point);
  }
  return points;
}

void ScenePoints::carry_along(Eigen::Ref<Eigen::Matrix3Xf> u) const {
  auto column = static_cast<Eigen::Index>(nodes.size());
  for (const SurfacePoint& point : fines) {
    auto there = u.col(column++);
    there.setZero();
    for (std::size_t k = 0; k < 3 && point.node[k] >= 0; ++k)
      there += static_cast<float>(point.weight[k]) * u.col(point.node[k]);
  }
}

}  // namespace stylet::serve
