// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the compliance after node additions with the compliance of the same mesh factorised from scratch.
#include "../rows.hpp"
#include "stylet/coupling/paper/inverse_compliance.hpp"
#include "stylet/coupling/track_compliance.hpp"
#include "stylet/geom/box_mesh.hpp"

#include <fmt/format.h>

#include <array>
#include <numeric>
#include <random>

namespace stylet::validate {

namespace {

constexpr int kAddedNodes = 100;
constexpr int kEvery = 20;  ///< additions between two checks
const std::vector<Material> kMaterials{{0.04, 0.45}, {0.12, 0.40}};

/// A cube of two tissues with one face held and its whole compliance.
struct Cube {
  std::vector<Index> fixed;
  std::shared_ptr<const Tissue> tissue;
  std::unique_ptr<Topology> topology;
  std::unique_ptr<Locator> locator;
  std::shared_ptr<const ComplianceStore> store;
  std::shared_ptr<const MatX> inverse;
};

Cube make_cube() {
  Cube cube;
  TetMesh mesh = box_mesh({0, 0, 0}, {40, 40, 40}, {4, 4, 4}, 0.12);
  assign_regions(mesh, {"soft", "stiff"}, [](const Vec3& x) { return x.x() + 0.3 * x.y() < 26 ? 0 : 1; });
  std::vector<Index> all(mesh.nodes.size());
  std::iota(all.begin(), all.end(), 0);
  for (const Index node : all)
    if (mesh.nodes[static_cast<std::size_t>(node)].z() > 39.999) cube.fixed.push_back(node);
  auto built = need(Tissue::build(std::move(mesh), kMaterials, cube.fixed));
  cube.tissue = std::make_shared<const Tissue>(std::move(built));
  cube.topology = std::make_unique<Topology>(cube.tissue->mesh());
  cube.locator = std::make_unique<Locator>(cube.tissue->mesh(), *cube.topology);
  auto store = std::make_shared<ComplianceStore>(cube.tissue);
  store->add_nodes(all);
  cube.store = store;
  cube.inverse = std::make_shared<const MatX>(paper::full_inverse(*cube.tissue));
  return cube;
}

/// Largest difference between the compliance among the added nodes and the compliance of a new factorisation, relative
/// to the largest entry of the latter.
double difference(const Cube& cube, const ContactCompliance& compliance, const TetMesh& split) {
  const auto fresh = need(Tissue::build(split, kMaterials, cube.fixed));
  const Index base = cube.tissue->mesh().node_count();
  const Index added = split.node_count() - base;
  MatX load = MatX::Zero(3 * split.node_count(), 3 * added);
  for (Index k = 0; k < added; ++k) load.block<3, 3>(3 * (base + k), 3 * k) = Mat3::Identity();
  const MatX reference = fresh.solve(load).bottomRows(3 * added);
  const MatX ours = compliance.matrix().block(3, 3, 3 * added, 3 * added);
  return (ours - reference).cwiseAbs().maxCoeff() / reference.cwiseAbs().maxCoeff();
}

/// Adds nodes at random places, inside elements or on their faces, and checks the compliance after every kEvery nodes.
/// @param mesh_of returns the mesh with the nodes added so far
Curve add_nodes(const Cube& cube, ContactCompliance& compliance, const std::function<TetMesh()>& mesh_of,
                Placement placement, const std::string& label) {
  Curve curve{.label = label};
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> share(0.05, 1.0);
  std::uniform_int_distribution<Index> pick(0, cube.tissue->mesh().tet_count() - 1);
  for (int added = 0; added < kAddedNodes;) {
    MaterialPoint at{pick(random), Vec4(share(random), share(random), share(random), share(random))};
    const int local = static_cast<int>(random() % 4);
    if (placement == Placement::face) at.weights[local] = 0.0;
    at.weights /= at.weights.sum();
    Vec3 x = Vec3::Zero();
    for (int i = 0; i < 4; ++i) {
      const Index node = cube.tissue->mesh().tets[static_cast<std::size_t>(at.tet)][static_cast<std::size_t>(i)];
      x += at.weights[i] * cube.tissue->mesh().nodes[static_cast<std::size_t>(node)];
    }
    if (compliance.add(at, x, placement, cube.locator->face_normal(at.tet, local)).point < 0) continue;
    if (++added % kEvery != 0) continue;
    const auto error = difference(cube, compliance, mesh_of());
    curve.add(added, error);
  }
  return curve;
}

Finding node_additions(Context&) {
  const auto cube = make_cube();
  Finding finding{.value = 0.0};
  finding.plot = {.x_label = "nodes added", .y_label = "relative error", .log_y = true};
  using Engine = paper::DenseInverse::Engine;
  for (const Placement placement : {Placement::interior, Placement::face}) {
    const std::string rule = placement == Placement::interior ? "interior" : "paper";
    TrackCompliance condensed(cube.store, *cube.locator, kAddedNodes);
    paper::InverseCompliance woodbury(cube.tissue, *cube.locator, cube.inverse, Engine::woodbury, false, kAddedNodes);
    paper::InverseCompliance switches(cube.tissue, *cube.locator, cube.inverse, Engine::bcs, false, kAddedNodes);
    struct Engines {
      const char* name;
      ContactCompliance& compliance;
      std::function<TetMesh()> mesh;
    };
    for (const Engines& engine : {Engines{"condensed", condensed, [&] { return condensed.mesh().materialise(); }},
                                  Engines{"woodbury", woodbury, [&] { return woodbury.mesh().materialise(); }},
                                  Engines{"bcs", switches, [&] { return switches.mesh().materialise(); }}}) {
      auto curve = add_nodes(cube, engine.compliance, engine.mesh, placement, fmt::format("{}, {}", engine.name, rule));
      for (const double error : curve.y) finding.value = worse(finding.value, error);
      finding.plot.curves.push_back(std::move(curve));
    }
  }
  finding.note = fmt::format(
      "{} nodes are added at random places to a mesh of {} nodes, with both rules and three engines: shortcut and "
      "bordered update (condensed), Woodbury’s formula, and boundary condition switches. The value is the largest "
      "error.",
      kAddedNodes, cube.tissue->mesh().node_count());
  return finding;
}

}  // namespace

std::vector<RowSpec> node_addition_rows() {
  return {{"node_additions", Group::analysis, "After 100 node additions the compliance equals that of the new mesh",
           "the new mesh, factorised from scratch", "", Accepted::at_most(1e-8), true, node_additions}};
}

}  // namespace stylet::validate
