// SPDX-License-Identifier: GPL-3.0-or-later
#include "quadratic_tetrahedra.hpp"

#include "stress.hpp"

#include <algorithm>
#include <cmath>

namespace stylet::detail {
namespace {

constexpr std::array<std::array<int, 2>, 6> kEdges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

// Four quadrature points, exact for quadratic functions such as products of two strains of a quadratic element with
// straight edges.
// @cite Stroud1971
const std::array<Vec4, 4>& quadrature_points() {
  static const std::array<Vec4, 4> points = [] {
    std::array<Vec4, 4> p;
    for (int i = 0; i < 4; ++i) {
      p[i].setConstant((5.0 - std::sqrt(5.0)) / 20.0);
      p[i][i] = (5.0 + 3.0 * std::sqrt(5.0)) / 20.0;
    }
    return p;
  }();
  return points;
}

using Gradients = Eigen::Matrix<double, 3, kMostElementNodes>;

// Gradients of the shape functions l_i (2 l_i − 1) of corners and 4 l_i l_j of edges; g are the gradients of the
// barycentric coordinates l.
Gradients gradients_at(const Eigen::Matrix<double, 3, 4>& g, const Vec4& l) {
  Gradients out;
  for (int i = 0; i < 4; ++i) out.col(i) = (4.0 * l[i] - 1.0) * g.col(i);
  for (int e = 0; e < 6; ++e) {
    const auto [i, j] = kEdges[e];
    out.col(4 + e) = 4.0 * (l[j] * g.col(i) + l[i] * g.col(j));
  }
  return out;
}

}  // namespace

QuadraticTetrahedra::QuadraticTetrahedra(const TetMesh& mesh) : mesh_(mesh), nodes_(mesh.tets.size()) {
  const auto edge_of = [&](Index tet, int e) {
    const auto [i, j] = kEdges[e];
    const Index a = mesh.tets[tet][i];
    const Index b = mesh.tets[tet][j];
    return std::array{std::min(a, b), std::max(a, b)};
  };
  edges_.reserve(6 * mesh.tets.size());
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    for (int e = 0; e < 6; ++e) edges_.push_back(edge_of(t, e));
  }
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    std::copy(mesh.tets[t].begin(), mesh.tets[t].end(), nodes_[t].begin());
    for (int e = 0; e < 6; ++e) {
      const auto edge = std::lower_bound(edges_.begin(), edges_.end(), edge_of(t, e));
      nodes_[t][4 + e] = mesh.node_count() + static_cast<Index>(edge - edges_.begin());
    }
  }
}

std::array<Index, 2> QuadraticTetrahedra::ends(Index node) const {
  if (node < mesh_.node_count()) return {node, node};
  return edges_[node - mesh_.node_count()];
}

Shape QuadraticTetrahedra::shape(Index tet, const Vec4& l) const {
  Shape shape;
  shape.count = kMostElementNodes;
  shape.node = nodes_[tet];
  for (int i = 0; i < 4; ++i) shape.weight[i] = l[i] * (2.0 * l[i] - 1.0);
  for (int e = 0; e < 6; ++e) shape.weight[4 + e] = 4.0 * l[kEdges[e][0]] * l[kEdges[e][1]];
  return shape;
}

ShapeGradients QuadraticTetrahedra::shape_gradients(Index tet, const Vec4& weights) const {
  ShapeGradients shape;
  shape.count = kMostElementNodes;
  shape.node = nodes_[tet];
  shape.gradient = gradients_at(barycentric_gradients(mesh_, tet), weights);
  return shape;
}

void QuadraticTetrahedra::parts(std::span<const Index> tets, const MaterialOf& /*material*/, const Visit& visit) const {
  for (const Index t : tets) visit(nodes_[t]);
}

void QuadraticTetrahedra::stiffness(std::span<const Index> tets, const MaterialOf& material, const Add& add) const {
  MatX K(3 * kMostElementNodes, 3 * kMostElementNodes);
  for (const Index t : tets) {
    const auto g = barycentric_gradients(mesh_, t);
    const Material of_tet = material(t);
    const double share = 0.25 * tet_volume(mesh_, t);
    const double lambda = share * of_tet.lambda();
    const double mu = share * of_tet.mu();
    K.setZero();
    for (const Vec4& point : quadrature_points()) {
      const Gradients G = gradients_at(g, point);
      for (int a = 0; a < kMostElementNodes; ++a) {
        for (int b = 0; b <= a; ++b) {
          K.block<3, 3>(3 * a, 3 * b) += stiffness_block(G.col(a), G.col(b), lambda, mu);
        }
      }
    }
    add(nodes_[t], K);
  }
}

MatX QuadraticTetrahedra::stress(const MaterialOf& material, const VecX& u) const {
  MatX stresses(6, mesh_.tet_count());
  for (Index t = 0; t < mesh_.tet_count(); ++t) {
    const Gradients G = gradients_at(barycentric_gradients(mesh_, t), Vec4::Constant(0.25));
    Mat3 gradient = Mat3::Zero();
    for (int i = 0; i < kMostElementNodes; ++i) {
      gradient += u.segment<3>(3 * Eigen::Index{nodes_[t][i]}) * G.col(i).transpose();
    }
    stresses.col(t) = six_components(cauchy_stress(material(t), gradient));
  }
  return stresses;
}

VecX QuadraticTetrahedra::forces(const MaterialOf& material, const VecX& u, const std::vector<char>& wanted) const {
  std::vector<Index> touched;
  for (Index t = 0; t < mesh_.tet_count(); ++t) {
    if (std::any_of(nodes_[t].begin(), nodes_[t].end(), [&](Index a) { return wanted[a]; })) touched.push_back(t);
  }
  VecX forces = VecX::Zero(u.size());
  VecX own(3 * kMostElementNodes);
  stiffness(touched, material, [&](std::span<const Index> element, const Eigen::Ref<const MatX>& K) {
    for (int i = 0; i < kMostElementNodes; ++i) own.segment<3>(3 * i) = u.segment<3>(3 * Eigen::Index{element[i]});
    const VecX pull = K.selfadjointView<Eigen::Lower>() * own;
    for (int i = 0; i < kMostElementNodes; ++i) {
      if (wanted[element[i]]) forces.segment<3>(3 * Eigen::Index{element[i]}) += pull.segment<3>(3 * i);
    }
  });
  return forces;
}

}  // namespace stylet::detail
