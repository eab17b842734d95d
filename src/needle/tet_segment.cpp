// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle/tet_segment.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <utility>

namespace stylet::tet {

namespace {

/// Edges from the first node to the others, as columns.
Mat3 edges(const std::vector<Vec3>& nodes, const std::array<int, 4>& node) {
  Mat3 m;
  for (int i = 0; i < 3; ++i) m.col(i) = nodes[node[i + 1]] - nodes[node[0]];
  return m;
}

/// Adds a tetrahedron with its nodes ordered so that the volume is positive.
void add_element(SegmentMesh& mesh, std::array<int, 4> node) {
  if (edges(mesh.nodes, node).determinant() < 0.0) std::swap(node[2], node[3]);
  mesh.elements.push_back(make_element(mesh.nodes, node));
}

/// Joins the four triangles around the centre of every face to the centre of the body.
void fill_symmetric(SegmentMesh& mesh) {
  constexpr int body = kFirstMiddle + 4;
  const auto side_face = [](int i) {
    const int next = (i + 1) % 4;
    return std::array<int, 4>{i, next, kLayerNodes + next, kLayerNodes + i};
  };
  for (int i = 0; i < 4; ++i) {
    Vec3 centre = Vec3::Zero();
    for (const int node : side_face(i)) centre += 0.25 * mesh.nodes[node];
    mesh.nodes.push_back(centre);
  }
  mesh.nodes.emplace_back(0.5 * (mesh.nodes[kAxisNode] + mesh.nodes[kLayerNodes + kAxisNode]));
  for (int i = 0; i < 4; ++i) {
    const auto face = side_face(i);
    for (int k = 0; k < 4; ++k) add_element(mesh, {body, kFirstMiddle + i, face[k], face[(k + 1) % 4]});
    add_element(mesh, {body, kAxisNode, face[0], face[1]});
    add_element(mesh, {body, kLayerNodes + kAxisNode, face[3], face[2]});
  }
}

/// Four prisms around the axis, each cut into three tetrahedra along diagonals that rise from the lower node number.
void fill_asymmetric(SegmentMesh& mesh) {
  for (int i = 0; i < 4; ++i) {
    const int a = std::min(i, (i + 1) % 4);
    const int b = std::max(i, (i + 1) % 4);
    const int c = kAxisNode;
    add_element(mesh, {a, b, c, kLayerNodes + c});
    add_element(mesh, {a, b, kLayerNodes + b, kLayerNodes + c});
    add_element(mesh, {a, kLayerNodes + a, kLayerNodes + b, kLayerNodes + c});
  }
}

}  // namespace

Element make_element(const std::vector<Vec3>& nodes, const std::array<int, 4>& node) {
  const Mat3 X = edges(nodes, node);
  const Mat3 inverse = X.inverse();
  Element element{node, {}, X.determinant() / 6.0};
  element.gradient[0].setZero();
  for (int i = 0; i < 3; ++i) {
    element.gradient[i + 1] = inverse.row(i);
    element.gradient[0] -= inverse.row(i);
  }
  return element;
}

std::vector<int> SegmentMesh::neighbours_after(int middle) const {
  std::vector<int> found;
  for (const Element& element : elements) {
    if (std::find(element.node.begin(), element.node.end(), middle) == element.node.end()) continue;
    for (const int node : element.node) {
      if (node < kFirstMiddle || node > middle) found.push_back(node);
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

SegmentMesh make_segment(TetNeedle::Segment kind, double width, double length) {
  SegmentMesh mesh;
  const double half = 0.5 * width;
  for (const double z : {0.0, length}) {
    mesh.nodes.insert(mesh.nodes.end(), {Vec3(-half, -half, z), Vec3(half, -half, z), Vec3(half, half, z),
                                         Vec3(-half, half, z), Vec3(0.0, 0.0, z)});
  }
  if (kind == TetNeedle::Segment::symmetric) {
    fill_symmetric(mesh);
  } else {
    fill_asymmetric(mesh);
  }
  return mesh;
}

}  // namespace stylet::tet
