// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/measure/remesh_bench.hpp"

#include "stylet/coupling/paper/dense_inverse.hpp"
#include "stylet/geom/box_mesh.hpp"

#include <algorithm>

namespace stylet::measure {

namespace {

constexpr double kSide_mm = 100.0;
constexpr double kJitter = 0.12;  // random shift of nodes, relative to the grid, so that the way meets no edge or node
constexpr double kAround_mm = 0.35 * kSide_mm;

/// Nodes within a distance of the way.
std::vector<Index> nodes_around(const TetMesh& mesh, const Vec3& from, const Vec3& to) {
  const Vec3 direction = (to - from).normalized();
  std::vector<Index> nodes;
  for (Index node = 0; node < mesh.node_count(); ++node) {
    const Vec3 x = mesh.nodes[static_cast<std::size_t>(node)] - from;
    if ((x - direction * direction.dot(x)).norm() < kAround_mm) nodes.push_back(node);
  }
  return nodes;
}

}  // namespace

Block::Block(std::shared_ptr<const Tissue> tissue) : topology_(tissue->mesh()), locator_(tissue->mesh(), topology_) {
  way_.locator = &locator_;
  way_.from = {46.3, 47.1, 0.0};
  way_.to = {54.9, 51.8, 0.8 * kSide_mm};
  auto store = std::make_shared<ComplianceStore>(tissue);
  store->add_nodes(nodes_around(tissue->mesh(), way_.from, way_.to));
  way_.store = std::move(store);
}

Result<std::unique_ptr<Block>> Block::build(int cells, const Progress& progress) {
  cells = std::clamp(cells, 3, 20);
  TetMesh mesh = box_mesh(Vec3::Zero(), Vec3::Constant(kSide_mm), {cells, cells, cells}, kJitter);
  std::vector<Index> fixed;
  for (Index node = 0; node < mesh.node_count(); ++node) {
    if (mesh.nodes[static_cast<std::size_t>(node)].z() > kSide_mm - 1e-6) fixed.push_back(node);
  }
  auto tissue = Tissue::build(std::move(mesh), {Material{0.02, 0.45}}, fixed, progress);
  if (!tissue) return tissue.error();
  const auto shared = std::make_shared<const Tissue>(std::move(*tissue));
  std::unique_ptr<Block> block(new Block(shared));
  block->way_.inverse = std::make_shared<const MatX>(paper::full_inverse(*shared, progress));
  return block;
}

Result<std::vector<RemeshRow>> bench_remeshing(const std::vector<int>& cells, const Progress& progress) {
  std::vector<RemeshRow> rows;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    report(progress, "changes of the mesh", static_cast<double>(i) / static_cast<double>(cells.size()));
    const auto block = Block::build(cells[i]);
    if (!block) return block.error();
    RemeshCostOptions options{.spacing_mm = 2.75, .most_nodes = 8, .rounds = 10};
    options.placement = Placement::interior;
    options.bcs_rounds = 0;
    const auto inside = measure_remeshing((*block)->way(), options);
    if (!inside) return inside.error();
    options.placement = Placement::face;
    options.bcs_rounds = options.inverse_rounds = 1;
    const auto on_faces = measure_remeshing((*block)->way(), options);
    if (!on_faces) return on_faces.error();
    const auto row = [&](const char* method, const RemeshCost::Times& times) {
      rows.push_back({on_faces->nodes, method, 1e6 * times.median_s});
    };
    row("shortcut", inside->ours);
    row("bordered", on_faces->ours);
    row("woodbury", on_faces->woodbury);
    row("bcs", on_faces->bcs);
    row("inverse", on_faces->inverse);
  }
  report(progress, "changes of the mesh", 1.0);
  return rows;
}

}  // namespace stylet::measure
