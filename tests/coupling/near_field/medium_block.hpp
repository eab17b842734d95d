// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/near_field/half_space.hpp"
#include "stylet/coupling/near_field/near_field_compliance.hpp"
#include "stylet/coupling/track_compliance.hpp"
#include "stylet/geom/box_mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

namespace stylet::test {

/// A cube of 100 mm, E = 10 kPa, and what near-field tests ask of it.
struct MediumBlock {
  struct Options {
    int cells = 10;
    double poisson = 0.45;
    double jitter = 0.15;
    bool skin = false;  ///< the face z = −50 mm is free; else all faces are held
    std::vector<std::string> regions{"body"};
    std::function<int(const Vec3&)> region_at = [](const Vec3&) { return 0; };
    std::vector<Material> materials{};  ///< empty: one of 10 kPa
    std::function<bool(const Vec3&)> also_held = [](const Vec3&) { return false; };
  };

  explicit MediumBlock(const Options& options) {
    TetMesh mesh = box_mesh(Vec3::Constant(-50), Vec3::Constant(50), {options.cells, options.cells, options.cells},
                            options.jitter);
    assign_regions(mesh, options.regions, options.region_at);
    for (Index node = 0; node < mesh.node_count(); ++node) {
      const Vec3& x = mesh.nodes[static_cast<std::size_t>(node)];
      const bool side = std::max(std::abs(x.x()), std::abs(x.y())) > 49.99 || x.z() > 49.99;
      if (side || (!options.skin && x.z() < -49.99) || options.also_held(x)) fixed.push_back(node);
    }
    auto materials = options.materials;
    if (materials.empty()) materials = {{0.01, options.poisson}};
    auto built = Tissue::build(std::move(mesh), materials, fixed);
    EXPECT_TRUE(built.ok());
    tissue = std::make_shared<const Tissue>(std::move(*built));
    topology = std::make_unique<Topology>(tissue->mesh());
    locator = std::make_unique<Locator>(tissue->mesh(), *topology);
    store = std::make_shared<ComplianceStore>(tissue);
    kernel = std::make_shared<MeshKernel>(tissue, *topology);
    medium = {tissue->material(0).mu(), tissue->material(0).poisson};
  }

  [[nodiscard]] MaterialPoint at(const Vec3& x) const {
    const auto found = locator->find(x, -1, Vec3::UnitZ());
    EXPECT_TRUE(found.has_value());
    return found.value_or(MaterialPoint{0, Vec4::Constant(0.25)});
  }

  /// Makes everything around these points available.
  void prepare(const std::vector<Vec3>& points) {
    std::vector<Index> nodes;
    for (const Vec3& x : points) {
      const auto corners = tissue->nodes_of(at(x).tet);
      nodes.insert(nodes.end(), corners.begin(), corners.end());
    }
    store->add_nodes(nodes);
    kernel->add_nodes(nodes);
  }

  [[nodiscard]] NearFieldCompliance compliance(const NeedleKernel& needle, int capacity) const {
    return {std::make_unique<TrackCompliance>(store, *locator, capacity), tissue, kernel, needle, capacity};
  }

  /// What moving the held nodes by `field` moves the material point x by: Λ u for unit loads, by reciprocity
  /// −(reactions to a force at x)ᵀ field.
  /// @param field (3 × 3k) displacement of the k held nodes per unit of three loads, node by node
  [[nodiscard]] Mat3 lift(const Vec3& x, const std::vector<Mat3>& field) const {
    const MaterialPoint point = at(x);
    const Shape shape = tissue->shape(point.tet, point.weights);
    MatX f = MatX::Zero(3 * Eigen::Index{tissue->displacement_nodes()}, 3);
    for (int k = 0; k < shape.count; ++k) {
      f.middleRows<3>(3 * Eigen::Index{shape.node[static_cast<std::size_t>(k)]}) +=
          shape.weight[static_cast<std::size_t>(k)] * Mat3::Identity();
    }
    const MatX u = tissue->solve(f);
    Mat3 lifted = Mat3::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      const VecX reaction = tissue->support_forces(u.col(axis));
      for (std::size_t b = 0; b < fixed.size(); ++b)
        lifted.row(axis) -= reaction.segment<3>(3 * Eigen::Index{fixed[b]}).transpose() * field[b];
    }
    return lifted;
  }

  std::vector<Index> fixed;
  std::shared_ptr<const Tissue> tissue;
  std::unique_ptr<Topology> topology;
  std::unique_ptr<Locator> locator;
  std::shared_ptr<ComplianceStore> store;
  std::shared_ptr<MeshKernel> kernel;
  Medium medium;
};

/// A straight needle of 64 mm around the cube's middle, held along its length and displaced as a whole.
struct NeedleLine {
  static constexpr double kLength_mm = 64.0;
  static constexpr double kWay_mm = 5.0;

  /// @param unbounded the held faces move as they would in an unbounded medium
  NeedleLine(MediumBlock& block, double spacing_mm, const Vec3& direction_, bool unbounded)
      : direction(direction_.normalized()) {
    const int count = static_cast<int>(kLength_mm / spacing_mm);
    const NeedleKernel needle{.segment_mm = spacing_mm};
    std::vector<Vec3> points;
    for (int k = 0; k < count; ++k)
      points.push_back(Vec3(1.3, 0.7, 0.0) + (spacing_mm * (k + 0.5) - 0.5 * kLength_mm) * direction);
    block.prepare(points);
    NearFieldCompliance compliance = block.compliance(needle, count);
    for (const Vec3& x : points) EXPECT_GT(compliance.add(block.at(x), x, Placement::embedded, direction).point, 0);
    A = compliance.matrix().block(3, 3, 3 * count, 3 * count);
    if (!unbounded) return;
    MatX lifted = MatX::Zero(A.rows(), A.cols());
    std::vector<Mat3> field(block.fixed.size());
    for (int d = 0; d < count; ++d) {
      const Segment piece{points[static_cast<std::size_t>(d)], direction, spacing_mm};
      for (std::size_t b = 0; b < field.size(); ++b) {
        const Segment node{block.tissue->mesh().nodes[static_cast<std::size_t>(block.fixed[b])], direction, 0.0};
        field[b] = kelvinlet(node, piece, direction, needle.shaft_epsilon(), block.medium);
      }
      for (int c = 0; c < count; ++c)
        lifted.block<3, 3>(3 * c, 3 * d) = block.lift(points[static_cast<std::size_t>(c)], field);
    }
    A += 0.5 * (lifted + lifted.transpose());
  }

  /// Force [N] that moves the line by kWay_mm along a unit vector.
  [[nodiscard]] double force(const Vec3& along) const {
    const Eigen::Index count = A.rows() / 3;
    const VecX u = (kWay_mm * along).replicate(count, 1);
    const VecX f = A.ldlt().solve(u);
    return u.dot(f) / kWay_mm;
  }
  [[nodiscard]] double lateral() const { return force(direction.unitOrthogonal()); }
  [[nodiscard]] double axial() const { return force(direction); }

  Vec3 direction;
  MatX A;
};

}  // namespace stylet::test
