// SPDX-License-Identifier: GPL-3.0-or-later
// One insertion into the demo patient on a coarse and a medium mesh.
#include "stylet/measure/coupling_bench.hpp"

#include <gtest/gtest.h>

using namespace stylet;
using namespace stylet::measure;

namespace {

/// The rows of a method, with the finest mesh first.
std::vector<CouplingRow> of(const std::vector<CouplingRow>& rows, const std::string& method) {
  std::vector<CouplingRow> found;
  for (const CouplingRow& row : rows) {
    if (row.method == method) found.push_back(row);
  }
  return found;
}

}  // namespace

TEST(InsertionOverMeshes, comes_near_the_same_force_with_the_near_field_on_500_nodes) {
  const auto rows = bench_coupling({.largest = 2000, .mesh_only = true});
  ASSERT_TRUE(rows) << rows.error().message();
  const auto near_field = of(*rows, "near-field");
  ASSERT_EQ(near_field.size(), 2u);
  const CouplingRow& fine = near_field[0];
  const CouplingRow& coarse = near_field[1];
  EXPECT_NEAR(fine.nodes, 2000, 60);
  EXPECT_NEAR(coarse.nodes, 500, 15);
  // The soft layers are thinner than the elements of the coarse mesh, so its capsule breaks some millimetres earlier.
  EXPECT_LT(coarse.rms_vs_finest_percent, 10.0);
  EXPECT_NEAR(coarse.peak_N, fine.peak_N, 0.03 * fine.peak_N);
  EXPECT_NEAR(coarse.skin_mm, fine.skin_mm, 1.5);
  // The method of 2005 is compared: its skin dents less, by an amount that depends on the mesh.
  for (const CouplingRow& row : of(*rows, "node-addition")) EXPECT_LT(row.skin_mm, 0.7 * fine.skin_mm);
}
