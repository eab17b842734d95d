// SPDX-License-Identifier: GPL-3.0-or-later
// Computing time, memory and accuracy of the kinds of elements in a block of 100 mm. Counters: nodes of the mesh,
// displacement nodes, entries of K and of its factor, memory. The accuracy is the error, in percent, of the dent under
// a smooth pressure. Run it by hand on an otherwise idle machine:
//   build/bin/bench_element --benchmark_filter='cells:14/'
#include "stylet/fem/compliance_store.hpp"
#include "stylet/geom/box_mesh.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <stdexcept>

namespace stylet {
namespace {

constexpr double kSide_mm = 100.0;
constexpr double kJitter = 0.1;
constexpr double kCorridor_mm = 10.0;
constexpr int kFineCells = 14;  // mesh of the reference with quadratic elements

Tissue block(Element element, int cells, double poisson) {
  TetMesh mesh = box_mesh(Vec3::Zero(), Vec3::Constant(kSide_mm), {cells, cells, cells}, kJitter);
  std::vector<Index> fixed;
  for (Index node = 0; node < mesh.node_count(); ++node) {
    if (mesh.nodes[static_cast<std::size_t>(node)].z() == 0.0) fixed.push_back(node);
  }
  auto tissue = Tissue::build(std::move(mesh), {Material{0.04, poisson}}, fixed, {}, element);
  if (!tissue) throw std::runtime_error(tissue.error().message());
  return std::move(*tissue);
}

/// Nodes in the corridor of a needle that goes along the block's axis to 80 mm depth.
std::vector<Index> corridor(const TetMesh& mesh) {
  std::vector<Index> nodes;
  const double cell = kSide_mm / std::cbrt(static_cast<double>(mesh.tet_count()) / 6.0);
  for (Index node = 0; node < mesh.node_count(); ++node) {
    const Vec3& x = mesh.nodes[static_cast<std::size_t>(node)];
    const double off = (x - 0.5 * kSide_mm * Vec3::Ones()).head<2>().norm();
    if (off < kCorridor_mm + cell && x.z() > 0.2 * kSide_mm) nodes.push_back(node);
  }
  return nodes;
}

/// Depth of the dent under a smooth pressure on top, averaged with the pressure as weight [mm].
double dent(Element element, int cells, double poisson) {
  const Tissue tissue = block(element, cells, poisson);
  const double cell = kSide_mm / cells;
  VecX f = VecX::Zero(3 * Eigen::Index{tissue.displacement_nodes()});
  // The force on a node is the pressure at the node times its share of the area of the top.
  double total = 0.0;
  const double spacing = element == Element::p2 ? 0.5 * cell : cell;
  for (Index node = 0; node < tissue.displacement_nodes(); ++node) {
    const Vec3 x = tissue.node_position(node);
    if (x.z() != kSide_mm) continue;
    const double hill = std::sin(std::numbers::pi * x.x() / kSide_mm) * std::sin(std::numbers::pi * x.y() / kSide_mm);
    // A constant pressure on a quadratic face acts on the middles of its edges only, each with a third of the face's
    // area.
    const bool corner = tissue.ends_of(node)[0] == tissue.ends_of(node)[1];
    const double area = element == Element::p2 ? (corner ? 0.0 : 4.0 / 3.0 * spacing * spacing) : spacing * spacing;
    f[3 * node + 2] = -area * 1e-3 * hill * hill;
    total += f[3 * node + 2];
  }
  return f.dot(VecX(tissue.solve(f))) / std::abs(total);
}

/// The dent with quadratic elements on a fine mesh; computed once for each Poisson ratio.
double reference(double poisson) {
  static std::map<double, double> known;
  if (const auto found = known.find(poisson); found != known.end()) return found->second;
  return known[poisson] = dent(Element::p2, kFineCells, poisson);
}

Element element_of(const benchmark::State& state) { return static_cast<Element>(state.range(0)); }

void describe(benchmark::State& state, const Tissue& tissue) {
  state.SetLabel(to_string(tissue.element()));
  state.counters["nodes"] = tissue.mesh().node_count();
  state.counters["displacement_nodes"] = tissue.displacement_nodes();
  state.counters["K_entries"] = static_cast<double>(tissue.stiffness().nonZeros());
  state.counters["factor_entries"] = tissue.statistics().factor_entries;
  state.counters["factor_MB"] = tissue.statistics().factor_mb;
}

void build(benchmark::State& state) {
  for (auto _ : state) {
    const Tissue tissue = block(element_of(state), static_cast<int>(state.range(1)), 0.45);
    benchmark::DoNotOptimize(tissue.free_dofs());
    state.PauseTiming();
    describe(state, tissue);
    state.ResumeTiming();
  }
}

void store(benchmark::State& state) {
  const auto tissue = std::make_shared<const Tissue>(block(element_of(state), static_cast<int>(state.range(1)), 0.45));
  const auto nodes = corridor(tissue->mesh());
  for (auto _ : state) {
    ComplianceStore compliance(tissue);
    compliance.add_nodes(nodes);
    state.counters["store_MB"] = compliance.megabytes();
    state.counters["stored_nodes"] = compliance.stored_nodes();
  }
  state.SetLabel(to_string(tissue->element()));
}

void accuracy(benchmark::State& state) {
  const Element element = element_of(state);
  const auto cells = static_cast<int>(state.range(1));
  for (auto _ : state) {
    for (const auto& [name, poisson] :
         std::map<std::string, double>{{"error_at_0.45", 0.45}, {"error_at_0.49", 0.49}, {"error_at_0.499", 0.499}}) {
      state.counters[name] = 100.0 * (dent(element, cells, poisson) / reference(poisson) - 1.0);
    }
  }
  state.SetLabel(to_string(element));
}

constexpr int kP1 = static_cast<int>(Element::p1);
constexpr int kAveraged = static_cast<int>(Element::nodal_pressure);
constexpr int kP2 = static_cast<int>(Element::p2);

// 14 cells have 3,375 nodes and 26 cells 19,683 nodes. Quadratic elements on 7 and 13 cells have the same numbers of
// displacement nodes.
void sizes(benchmark::internal::Benchmark* run) {
  run->ArgNames({"element", "cells"})->Unit(benchmark::kSecond)->Iterations(1);
  for (const int cells : {14, 26}) {
    run->Args({kP1, cells})->Args({kAveraged, cells})->Args({kP2, cells / 2});
  }
  run->Args({kP2, 14});
}
BENCHMARK(build)->Apply(sizes);
BENCHMARK(store)->Apply(sizes);
BENCHMARK(accuracy)
    ->ArgNames({"element", "cells"})
    ->Unit(benchmark::kSecond)
    ->Iterations(1)
    ->ArgsProduct({{kP1, kAveraged}, {7, 14, 26}})
    ->ArgsProduct({{kP2}, {4, 7}});

}  // namespace
}  // namespace stylet

BENCHMARK_MAIN();
