// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/compliance_store.hpp"
#include "stylet/geom/box_mesh.hpp"
#include "stylet/geom/locator.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <numeric>

namespace stylet::test {

/// A two-region block with one face held, all compliances stored.
struct Block {
  explicit Block(int cells = 4, Element element = Element::p1) {
    TetMesh mesh = box_mesh({0, 0, 0}, {40, 40, 40}, {cells, cells, cells}, 0.12);
    assign_regions(mesh, {"soft", "stiff"}, [](const Vec3& x) { return x.x() + 0.3 * x.y() < 26 ? 0 : 1; });
    for (Index node = 0; node < mesh.node_count(); ++node) {
      if (mesh.nodes[static_cast<std::size_t>(node)].z() > 39.999) fixed.push_back(node);
    }
    auto built = Tissue::build(mesh, materials, fixed, {}, element);
    EXPECT_TRUE(built.ok());
    tissue = std::make_shared<const Tissue>(std::move(*built));
    topology = std::make_unique<Topology>(tissue->mesh());
    locator = std::make_unique<Locator>(tissue->mesh(), *topology);
    auto all = std::make_shared<ComplianceStore>(tissue);
    std::vector<Index> nodes(static_cast<std::size_t>(mesh.node_count()));
    std::iota(nodes.begin(), nodes.end(), 0);
    all->add_nodes(nodes);
    store = all;
  }

  std::vector<Material> materials{{0.04, 0.45}, {0.12, 0.40}};
  std::vector<Index> fixed;
  std::shared_ptr<const Tissue> tissue;
  std::unique_ptr<Topology> topology;
  std::unique_ptr<Locator> locator;
  std::shared_ptr<const ComplianceStore> store;
};

}  // namespace stylet::test
