// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/measure/needle_bench.hpp"

#include "stylet/measure/timing.hpp"
#include "stylet/needle/make_needle.hpp"
#include "stylet/needle/tet.hpp"
#include "stylet/needle/theory.hpp"

#include <limits>
#include <numbers>

namespace stylet::measure {

namespace {

constexpr int kLoads = 20;
constexpr int kRepeats = 101;
constexpr double kSettled_Nmm = 1e-7;

struct Counts {
  const char* model;
  std::vector<int> elements;
};

/// Measures deflections under small loads, from the compliance of the straight needle.
void measure_small(Needle& needle, const NeedleSection& section, NeedleRow& row) {
  const double L = section.length_mm;
  const std::array<PointLoad, 2> places{PointLoad{L / 3.0, Vec3::Zero()}, PointLoad{L, Vec3::Zero()}};
  MatX compliance(6, 6);
  VecX free(6);
  needle.linearise(places, compliance, free);
  const double EI = section.bending_stiffness_Nmm2;
  row.small_inner = compliance(3, 0) / cantilever_deflection(1.0, L / 3.0, L, EI) - 1.0;
  row.small_tip = compliance(3, 3) / cantilever_deflection(1.0, L, L, EI) - 1.0;
}

Result<> measure_large(Needle& needle, const NeedleSection& section, NeedleRow& row) {
  needle.straighten();
  for (std::size_t i = 0; i < row.kTipSlopes_deg.size(); ++i) {
    const Elastica exact(row.kTipSlopes_deg[i] * std::numbers::pi / 180.0, section.length_mm,
                         section.bending_stiffness_Nmm2);
    const std::array<PointLoad, 1> tip{PointLoad{section.length_mm, Vec3(exact.force, 0, 0)}};
    if (const auto settled = find_equilibrium(needle, tip, kSettled_Nmm); !settled) return settled.error();
    const Vec3 at = needle.point(section.length_mm);
    row.elastica[i] = at.x() / exact.deflection - 1.0;
    row.shortening[i] = (section.length_mm - at.z()) / (section.length_mm - exact.reach) - 1.0;
  }
  return Ok{};
}

/// Times solves as in the coupling: the loads act on the outer half of the needle and change a little every time.
void measure_time(Needle& needle, const NeedleSection& section, NeedleRow& row) {
  needle.straighten();
  std::vector<PointLoad> loads;
  for (int c = 1; c <= kLoads; ++c)
    loads.push_back({section.length_mm * (0.5 + 0.5 * c / kLoads), Vec3(5e-4, 1e-3, -5e-4)});
  MatX compliance(3 * kLoads, 3 * kLoads);
  VecX free(3 * kLoads);
  std::vector<double> times;
  for (int k = 0; k < kRepeats; ++k) {
    for (PointLoad& load : loads) load.force.x() += 1e-5;
    times.push_back(1e6 * cpu_seconds([&] {
                      needle.linearise(loads, compliance, free);
                      needle.advance(loads);
                    }));
  }
  row.solve_us = median(times);
}

}  // namespace

Result<std::vector<NeedleRow>> bench_needles() {
  const NeedleSection section;
  std::vector<NeedleRow> rows;
  for (const auto& [model, counts] : {Counts{"beam", {6, 12, 24, 48, 96}}, Counts{"springs", {6, 12, 24, 48, 96}},
                                      Counts{"tet", {24, 40, 60, 80, 120}}}) {
    const auto standard = default_needle_elements(model);
    if (!standard) return standard.error();
    for (const int elements : counts) {
      auto built = make_needle(model, section, elements, kLoads);
      if (!built) return built.error();
      Needle& needle = **built;
      NeedleRow row;
      row.model = model;
      row.elements = elements;
      row.is_default = elements == *standard;
      const auto* tet = dynamic_cast<const TetNeedle*>(&needle);
      row.axial_N_per_mm = tet != nullptr ? tet->axial_stiffness() : std::numeric_limits<double>::infinity();
      measure_small(needle, section, row);
      if (const auto done = measure_large(needle, section, row); !done) return done.error();
      measure_time(needle, section, row);
      rows.push_back(row);
    }
  }
  return rows;
}

}  // namespace stylet::measure
