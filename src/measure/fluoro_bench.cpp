// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/measure/fluoro_bench.hpp"

#include "driven_needle.hpp"
#include "stylet/imaging/fluoroscope.hpp"
#include "stylet/measure/demo.hpp"
#include "stylet/measure/timing.hpp"

#include <cmath>

namespace stylet::measure {

namespace {

/// A bent needle of 150 mm and seeds in a lattice about the gland's centre, which is near the origin.
void put_metal(Moment& moment) {
  constexpr int kPoints = 41;
  ShownNeedle needle;
  for (int k = 0; k < kPoints; ++k) {
    const double share = static_cast<double>(k) / (kPoints - 1);
    needle.centreline_mm.emplace_back(15.0 + 4.0 * share * share, 5.0, -130.0 + 150.0 * share);
  }
  moment.needles.push_back(std::move(needle));
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 4; ++j) {
      for (int k = 0; k < 5; ++k)
        moment.seeds.push_back({.centre_mm = {10.0 * i - 20.0, 8.0 * j - 12.0, 9.0 * k - 18.0},
                                .axis = Vec3(0.1 * i - 0.2, 0.1, 1.0).normalized()});
    }
  }
}

/// Moves all tissue by some millimetres, differently from place to place and from picture to picture.
void deform(const TetMesh& mesh, double time_s, Moment& moment) {
  constexpr double kLargest_mm = 3.0;
  constexpr double kPerMm = 0.05;
  moment.time_s = time_s;
  for (Index node = 0; node < mesh.node_count(); ++node) {
    const Vec3& x = mesh.nodes[static_cast<std::size_t>(node)];
    const double wave = kLargest_mm * std::sin(kPerMm * (x.x() + x.y() + x.z()) + 5.0 * time_s);
    moment.displacement.col(node) = (wave * Vec3(0.2, 0.3, 1.0)).cast<float>();
  }
}

}  // namespace

Result<std::vector<FluoroRow>> bench_fluoro(const FluoroBenchOptions& options, const Progress& progress) {
  std::vector<FluoroRow> rows;
  for (const Index nodes : {3000, 20000}) {
    if (nodes > options.largest) continue;
    const auto anatomy = mesh_demo(nodes, progress);
    if (!anatomy) return anatomy.error();
    FluoroscopySettings settings;
    settings.angle_deg = 35.0;
    const auto unit = Fluoroscope::create(anatomy->mesh, settings);
    if (!unit) return unit.error();
    Moment moment = moment_at_rest(anatomy->mesh);
    put_metal(moment);
    std::vector<double> us;
    for (int k = 0; k < options.exposures; ++k) {
      deform(anatomy->mesh, 0.04 * k, moment);
      us.push_back(1e6 * cpu_seconds([&] { (*unit)->expose(moment); }));
      report(progress, "exposing", static_cast<double>(k) / options.exposures);
    }
    rows.push_back({.nodes = anatomy->mesh.node_count(),
                    .pixels = settings.pixels,
                    .seeds = static_cast<int>(moment.seeds.size()),
                    .exposures = options.exposures,
                    .cpu_us = quantiles(std::move(us))});
  }
  return rows;
}

}  // namespace stylet::measure
