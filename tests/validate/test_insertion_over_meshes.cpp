// SPDX-License-Identifier: GPL-3.0-or-later
// One insertion into the demo patient on a coarse and a medium mesh.
#include "stylet/validate/coupling_bench.hpp"

#include <gtest/gtest.h>

using namespace stylet;
using namespace stylet::validate;

namespace {

/// Rows of a method, the finest mesh first.
std::vector<CouplingRow> of(const std::vector<CouplingRow>& rows, const std::string& method) {
  std::vector<CouplingRow> found;
  for (const CouplingRow& row : rows) {
    if (row.method == method) found.push_back(row);
  }
  return found;
}

}  // namespace

TEST(InsertionOverMeshes, GivesTheSameForceWithTheNearFieldFrom500NodesOn) {
  const auto rows = bench_coupling({.largest = 2000, .mesh_only = true});
  ASSERT_TRUE(rows) << rows.error().message();
  const auto near_field = of(*rows, "near-field");
  ASSERT_EQ(near_field.size(), 2u);
  const CouplingRow& fine = near_field[0];
  const CouplingRow& coarse = near_field[1];
  EXPECT_NEAR(fine.nodes, 2000, 60);
  EXPECT_NEAR(coarse.nodes, 500, 15);
  EXPECT_LT(coarse.rms_vs_finest_percent, 4.0);
  // The peak is at the capsule, which the coarse mesh has deeper: there is as much more friction, (11 + 250 · 0.02)
  // N/m.
  constexpr double friction_N_per_mm = 16e-3;
  EXPECT_NEAR(coarse.peak_N - friction_N_per_mm * (coarse.capsule_mm - fine.capsule_mm), fine.peak_N,
              0.01 * fine.peak_N);
  EXPECT_NEAR(coarse.skin_mm, fine.skin_mm, 0.1);
  // The capsule breaks where the mesh has it.
  EXPECT_NEAR(coarse.capsule_mm - coarse.gland_from_mm, fine.capsule_mm - fine.gland_from_mm, 0.3);
  // The method of 2005 is there to be compared: its skin hardly dents, and the less the coarser the mesh.
  for (const CouplingRow& row : of(*rows, "node-addition")) EXPECT_LT(row.skin_mm, 0.2 * fine.skin_mm);
}
