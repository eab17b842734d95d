// SPDX-License-Identifier: GPL-3.0-or-later
// Times the compliance between the nodes of a needle's corridor in a block of 100 mm, by two methods: the corridor is
// eliminated last and one dense matrix is inverted, or the factor has METIS' own order and each column is a solve.
// Counters: nodes, nodes of the corridor, memory of the factor. Run it by hand on an otherwise idle machine:
//   build/bin/bench_corridor --benchmark_filter='cells:14/'
#include "stylet/fem/compliance_store.hpp"
#include "stylet/geom/box_mesh.hpp"

#include <benchmark/benchmark.h>

#include <memory>
#include <stdexcept>

namespace stylet {
namespace {

constexpr double kSide_mm = 100.0;
constexpr double kRadius_mm = 10.0;

enum Way { last, solves };

void corridor(benchmark::State& state) {
  const auto cells = static_cast<int>(state.range(0));
  const auto element = static_cast<Element>(state.range(1));
  const bool is_last = state.range(2) == last;
  const TetMesh mesh = box_mesh(Vec3::Zero(), Vec3::Constant(kSide_mm), {cells, cells, cells}, 0.1);
  std::vector<Index> fixed;
  std::vector<Index> near;
  for (Index node = 0; node < mesh.node_count(); ++node) {
    const Vec3& x = mesh.nodes[static_cast<std::size_t>(node)];
    if (x.z() == 0.0) fixed.push_back(node);
    if ((x - 0.5 * kSide_mm * Vec3::Ones()).head<2>().norm() < kRadius_mm) near.push_back(node);
  }
  for (auto _ : state) {
    auto built = Tissue::build(mesh, {Material{0.04, 0.45}}, fixed, {}, element, is_last ? near : std::vector<Index>{});
    if (!built) throw std::runtime_error(built.error().message());
    const auto tissue = std::make_shared<const Tissue>(std::move(*built));
    state.counters["factor_s"] = tissue->statistics().factor_seconds;
    state.counters["factor_MB"] = tissue->statistics().factor_mb;
    if (is_last) {
      const ComplianceStore store(tissue, tissue->compliance_of_corridor());
      state.counters["corridor"] = store.stored_nodes();
    } else {
      ComplianceStore store(tissue);
      store.add_nodes(near);
      state.counters["corridor"] = store.stored_nodes();
    }
  }
  state.counters["nodes"] = mesh.node_count();
  state.SetLabel(std::string(to_string(element)) + (is_last ? ", corridor last" : ", solves"));
}

BENCHMARK(corridor)
    ->ArgNames({"cells", "element", "way"})
    ->ArgsProduct({{14, 26},
                   {static_cast<int>(Element::p1), static_cast<int>(Element::nodal_pressure)},
                   {last, solves}})
    ->Args({46, static_cast<int>(Element::p1), last})
    ->Iterations(1)
    ->Unit(benchmark::kSecond)
    ->UseRealTime();

}  // namespace
}  // namespace stylet

BENCHMARK_MAIN();
