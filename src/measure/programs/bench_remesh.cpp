// SPDX-License-Identifier: GPL-3.0-or-later
// Times a change of the mesh by several methods against the size of the mesh: the full inverse from scratch, by
// boundary condition switches, by Woodbury on the whole matrix and on one triangle; and the compliance among the held
// points (the default) with nodes inside elements and on faces. BLAS uses one thread.
#include "fem/blas_threads.hpp"
#include "measure/needle_way.hpp"
#include "stylet/coupling/paper/inverse_updates.hpp"
#include "stylet/coupling/track_compliance.hpp"
#include "stylet/measure/remesh_bench.hpp"

#include <benchmark/benchmark.h>

#include <map>
#include <span>

namespace {

using namespace stylet;
using namespace stylet::measure;

/// Returns a block. Each is built once, because that takes a second or more.
const Block* block_of(std::int64_t cells) {
  static std::map<std::int64_t, std::unique_ptr<Block>> blocks;
  auto& block = blocks[cells];
  if (!block) {
    auto built = Block::build(static_cast<int>(cells));
    if (built) block = std::move(*built);
  }
  return block.get();
}

/// The first node of the way on a face: K⁻¹ with the node on springs, and the changes that add the node to the mesh and
/// remove it. Both changes take the same time, so they can alternate without restoring K⁻¹.
struct FaceNode {
  explicit FaceNode(const NeedleWay& way) {
    const AddedNode node = nodes_along(way, {.placement = Placement::face, .most_nodes = 1}).front();
    const Eigen::Index old = way.inverse->rows();
    const double delta = way.inverse->diagonal().mean();
    dofs = node.dofs;
    in = stiffness_change(way.store->tissue(), node);
    in.diagonal().tail<3>().array() -= 1.0 / delta;
    out = -in;
    inverse = MatX::Zero(old + 3, old + 3);
    inverse.topLeftCorner(old, old) = *way.inverse;
    inverse.diagonal().tail<3>().setConstant(delta);
  }
  std::vector<Index> dofs;
  MatX in, out, inverse;
};

template <class Update>
void change_inverse(benchmark::State& state, Update update) {
  const Block* block = block_of(state.range(0));
  if (block == nullptr) return state.SkipWithError("the block cannot be built");
  const detail::OneBlasThread one_thread;
  FaceNode node(block->way());
  bool in = true;
  for (auto _ : state) {
    update(node.inverse, std::span<const Index>(node.dofs), in ? node.in : node.out);
    in = !in;
  }
  state.counters["nodes"] = block->way().store->tissue().mesh().node_count();
}

void switches(benchmark::State& state) {
  change_inverse(state, [](MatX& M, std::span<const Index> dofs, const MatX& change) {
    paper::update_by_switches<double>(M, dofs, change, M.rows());
  });
}

void woodbury(benchmark::State& state) {
  change_inverse(state, [](MatX& M, std::span<const Index> dofs, const MatX& change) {
    benchmark::DoNotOptimize(paper::update_by_woodbury<double>(M, dofs, change));
  });
}

void woodbury_one_triangle(benchmark::State& state) {
  change_inverse(state, [](MatX& M, std::span<const Index> dofs, const MatX& change) {
    benchmark::DoNotOptimize(paper::update_by_woodbury_symmetric(M, dofs, change));
  });
}

void inverse_from_scratch(benchmark::State& state) {
  const Block* block = block_of(state.range(0));
  if (block == nullptr) return state.SkipWithError("the block cannot be built");
  const detail::OneBlasThread one_thread;
  for (auto _ : state) {
    MatX K(block->way().store->tissue().stiffness());
    benchmark::DoNotOptimize(paper::invert(K));
  }
  state.counters["nodes"] = block->way().store->tissue().mesh().node_count();
}

/// Adds all nodes of the way in each iteration; the time for one node is the inverse of items_per_second.
void held_points(benchmark::State& state, Placement placement) {
  const Block* block = block_of(state.range(0));
  if (block == nullptr) return state.SkipWithError("the block cannot be built");
  const NeedleWay& way = block->way();
  const auto nodes = nodes_along(way, {.placement = placement});
  TrackCompliance compliance(way.store, *way.locator, static_cast<int>(nodes.size()));
  for (auto _ : state) {
    compliance.reset();
    Index hint = nodes.front().at.tet;
    for (const AddedNode& node : nodes) {
      const auto at = way.locator->find(node.x, hint, node.travel);
      benchmark::DoNotOptimize(compliance.add(*at, node.x, placement, node.travel));
      hint = at->tet;
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(nodes.size()));
  state.counters["nodes"] = way.store->tissue().mesh().node_count();
}

void shortcut(benchmark::State& state) { held_points(state, Placement::interior); }
void bordered(benchmark::State& state) { held_points(state, Placement::face); }

BENCHMARK(shortcut)->DenseRange(5, 9, 2)->ArgName("cells")->Unit(benchmark::kMicrosecond);
BENCHMARK(bordered)->DenseRange(5, 9, 2)->ArgName("cells")->Unit(benchmark::kMicrosecond);
BENCHMARK(woodbury_one_triangle)->DenseRange(5, 9, 2)->ArgName("cells")->Unit(benchmark::kMicrosecond);
BENCHMARK(woodbury)->DenseRange(5, 9, 2)->ArgName("cells")->Unit(benchmark::kMicrosecond);
BENCHMARK(switches)->DenseRange(5, 9, 2)->ArgName("cells")->Unit(benchmark::kMicrosecond);
BENCHMARK(inverse_from_scratch)->DenseRange(5, 9, 2)->ArgName("cells")->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
