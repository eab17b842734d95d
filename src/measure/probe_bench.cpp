// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/measure/probe_bench.hpp"

#include "stylet/measure/demo.hpp"
#include "stylet/sim/supports.hpp"

#include <algorithm>
#include <cmath>

namespace stylet::measure {

namespace {

constexpr double kPoseStep_mm = 0.25;
constexpr double kBase_mm = 20.0;  // of the demo's gland above its middle

double at_share(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto at = static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

/// The poses of the benchmark.
std::vector<ProbeSettings> probe_way(const ProbeSeat& seat) {
  std::vector<ProbeSettings> way;
  ProbeSettings at;
  at.kind = ProbeKind::biplane;
  const auto go = [&](double depth_mm, double lift_mm) {
    const double from_depth = at.depth_mm.value_or(seat.gland_mm);
    const double from_lift = at.lift_mm;
    const double distance = std::max(std::abs(depth_mm - from_depth), std::abs(lift_mm - from_lift));
    const int steps = std::max(1, static_cast<int>(std::ceil(distance / kPoseStep_mm)));
    for (int k = 1; k <= steps; ++k) {
      const double share = static_cast<double>(k) / steps;
      at.depth_mm = from_depth + share * (depth_mm - from_depth);
      at.lift_mm = from_lift + share * (lift_mm - from_lift);
      way.push_back(at);
    }
  };
  go(seat.gland_mm - kBase_mm, 0.0);
  go(seat.gland_mm + kBase_mm, 0.0);
  go(seat.gland_mm + kBase_mm, 10.0);
  go(seat.gland_mm - kBase_mm, 10.0);
  go(seat.gland_mm - kBase_mm, 0.0);
  return way;
}

ProbeRow measure_probe(PatientProbe& probe, Index nodes) {
  ProbeRow row;
  row.nodes = nodes;
  row.points = probe.wall().count();
  row.prepare_s = probe.wall().seconds;
  row.megabytes = probe.wall().megabytes();
  Eigen::Matrix3Xf u(3, nodes);
  std::vector<double> pose_ms;
  std::vector<double> field_ms;
  for (const ProbeSettings& settings : probe_way(probe.seat())) {
    const double start = thread_cpu_s();
    const ProbePress press = probe.press(settings);
    const double pressed = thread_cpu_s();
    probe.contact().displacement(u);
    field_ms.push_back(1e3 * (thread_cpu_s() - pressed));
    pose_ms.push_back(1e3 * (pressed - start));
    row.penetration_mm = std::max(row.penetration_mm, press.penetration_mm);
  }
  row.poses = static_cast<long>(pose_ms.size());
  row.pose_p50_ms = at_share(pose_ms, 0.5);
  row.pose_p99_ms = at_share(pose_ms, 0.99);
  row.pose_max_ms = at_share(pose_ms, 1.0);
  row.field_p50_ms = at_share(field_ms, 0.5);
  ProbeSettings lifted;
  lifted.kind = ProbeKind::biplane;
  lifted.depth_mm = probe.seat().gland_mm + kBase_mm;
  lifted.lift_mm = 8.0;
  row.force_N = probe.press(lifted).force_N.y();
  return row;
}

}  // namespace

Result<ProbedDemo> probed_demo(Index nodes, const Progress& progress) {
  Scenario scenario = demo_scenario();
  scenario.probe.kind = ProbeKind::biplane;
  auto meshed = mesh_demo(nodes, progress);
  if (!meshed) return meshed.error();
  TetMesh mesh = std::move(meshed->mesh);
  ProbedDemo demo;
  demo.topology = std::make_unique<const Topology>(mesh);
  std::vector<Material> materials;
  for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
    const TissueParameters tissue = tissue_of(scenario, mesh.regions[r]);
    materials.push_back({tissue.young_kPa * 1e-3, tissue.poisson});
    if (is_target_region(mesh.regions[r])) demo.gland.push_back(static_cast<int>(r));
  }
  const Vec3 entry(15.0, 3.0, -52.0);  // of the demo's needle, around which the skin is free
  const auto supports = find_supports(mesh, *demo.topology, scenario.fixed, demo.gland, {entry}, {Vec3(Vec3::UnitZ())});
  if (!supports) return supports.error();
  auto tissue =
      Tissue::build(std::move(mesh), std::move(materials), supports->nodes, progress, Element::nodal_pressure);
  if (!tissue) return tissue.error();
  demo.tissue = std::make_unique<const Tissue>(std::move(*tissue));
  return demo;
}

Result<std::vector<ProbeRow>> bench_probe(const ProbeBenchOptions& options, const Progress& progress) {
  std::vector<ProbeRow> rows;
  for (const Index nodes : {3000, 5000, 10000, 20000, 40000}) {
    if (nodes > options.largest) continue;
    const auto demo = probed_demo(nodes, progress);
    if (!demo) return demo.error();
    ProbeSettings settings;
    settings.kind = ProbeKind::biplane;
    auto probe = PatientProbe::prepare(demo->patient(), settings, "demo", progress);
    if (!probe) return probe.error();
    rows.push_back(measure_probe(*probe, demo->tissue->mesh().node_count()));
  }
  return rows;
}

}  // namespace stylet::measure
