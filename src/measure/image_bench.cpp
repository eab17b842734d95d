// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/measure/image_bench.hpp"

#include "stylet/imaging/tissue_role.hpp"
#include "stylet/imaging/ultrasound_scanner.hpp"
#include "stylet/measure/demo.hpp"
#include "stylet/measure/timing.hpp"
#include "stylet/probe/probe_place.hpp"

#include <algorithm>
#include <cmath>

namespace stylet::measure {

namespace {

StepTimes quantiles(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double q) {
    return values[static_cast<std::size_t>(std::lround(q * static_cast<double>(values.size() - 1)))];
  };
  return {at(0.5), at(0.99), at(0.999), values.back()};
}

/// The gland dragged by a needle 15 mm to its left, with the needle's forces and 20 seeds.
Moment assumed_moment(const TetMesh& mesh, const Vec3& gland, double drag_mm) {
  Moment moment = moment_at_rest(mesh);
  const Vec3 tip = gland + Vec3(15, 5, 10);
  for (Index node = 0; node < mesh.node_count(); ++node) {
    const Vec3 from = mesh.nodes[static_cast<std::size_t>(node)] - tip;
    moment.displacement(2, node) = static_cast<float>(drag_mm * std::exp(-from.squaredNorm() / 900.0));
  }
  moment.needles.push_back({{tip - Vec3(0, 0, 120), tip}, 1.27});
  for (int k = 0; k < 15; ++k)
    moment.forces.push_back({tip - Vec3(0, 0, 4.0 * k), {0, 0, 0.2}, Vec3::UnitZ(), 4.0, 1.05, 0.004, 0.49});
  for (int k = 0; k < 20; ++k)
    moment.seeds.push_back({gland + Vec3(8.0 * (k % 4) - 12.0, 6.0 * (k / 4 % 3) - 6.0, 5.0 * (k % 5) - 10.0)});
  return moment;
}

}  // namespace

Result<std::vector<ImageRow>> bench_image(const ImageBenchOptions& options, const Progress& progress) {
  const Result<MeshedAnatomy> anatomy = mesh_demo(options.nodes, progress);
  if (!anatomy) return anatomy.error();
  const TetMesh& mesh = anatomy->mesh;
  std::vector<TissueEcho> echoes;
  std::vector<int> glands;
  for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
    echoes.push_back(default_echo(mesh.regions[r]));
    if (is_gland(tissue_role(mesh.regions[r]))) glands.push_back(static_cast<int>(r));
  }
  const Result<ProbeSeat> seat = probe_seat(mesh, glands, "demo patient");
  if (!seat) return seat.error();
  const UltrasoundSettings settings;
  const double before = thread_cpu_s();
  Result<UltrasoundScanner> scanner = UltrasoundScanner::create(mesh, echoes, settings);
  if (!scanner) return scanner.error();
  const double set_up_s = thread_cpu_s() - before;
  Result<UltrasoundScanner> lattice = UltrasoundScanner::create(mesh, echoes, settings, {false, false});
  if (!lattice) return lattice.error();
  const Vec3 gland(0.0, 0.0, seat->gland_mm);
  std::vector<ImageRow> rows;
  for (const UltrasoundArray array : {UltrasoundArray::transverse, UltrasoundArray::sagittal}) {
    const bool sagittal = array == UltrasoundArray::sagittal;
    ProbeSettings probe{.kind = ProbeKind::biplane};
    if (sagittal) {  // the plane of the needle
      const ProbePlace rest = probe_place(probe, *seat);
      probe.roll_deg = std::atan2(15.0, rest.origin_mm.y() - 5.0) * 180.0 / 3.14159265358979;
    }
    const ProbePlace place = probe_place(probe, *seat);
    std::vector<double> whole, bare;
    for (int k = 0; k < options.frames; ++k) {
      Moment moment = assumed_moment(mesh, gland, 3.0 + 0.05 * k);
      whole.push_back(1e3 * cpu_seconds([&] { scanner->scan(moment, probe.kind, place, array); }));
      moment.needles.clear();
      moment.seeds.clear();
      moment.forces.clear();
      bare.push_back(1e3 * cpu_seconds([&] { lattice->scan(moment, probe.kind, place, array); }));
      report(progress, "making pictures", (k + 1.0) / options.frames);
    }
    rows.push_back({sagittal ? "sagittal" : "transverse", mesh.node_count(), settings.lines, settings.samples,
                    quantiles(whole), quantiles(bare), set_up_s});
  }
  return rows;
}

}  // namespace stylet::measure
