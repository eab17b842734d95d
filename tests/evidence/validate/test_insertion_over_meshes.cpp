// SPDX-License-Identifier: GPL-3.0-or-later
// One insertion into the demo patient on a coarse and a medium mesh.
#include "stylet/evidence/validate/demo_on_meshes.hpp"

#include <gtest/gtest.h>

using namespace stylet;
using namespace stylet::validate;

namespace {

/// The rows of a method, with the finest mesh first.
std::vector<DemoOnMesh> of(const std::vector<DemoOnMesh>& rows, const std::string& method) {
  std::vector<DemoOnMesh> found;
  for (const DemoOnMesh& row : rows) {
    if (row.method == method) found.push_back(row);
  }
  return found;
}

}  // namespace

TEST(InsertionOverMeshes, comes_near_the_same_force_with_the_near_field_on_500_nodes) {
  const auto rows = demo_on_meshes(2000);
  ASSERT_TRUE(rows) << rows.error().message();
  const auto near_field = of(*rows, "near-field");
  ASSERT_EQ(near_field.size(), 2u);
  const DemoOnMesh& fine = near_field[0];
  const DemoOnMesh& coarse = near_field[1];
  EXPECT_NEAR(fine.nodes, 2000, 60);
  EXPECT_NEAR(coarse.nodes, 500, 15);
  // The soft layers are thinner than the elements of the coarse mesh, so its capsule breaks some millimetres earlier.
  EXPECT_LT(coarse.rms_vs_finest_percent, 10.0);
  EXPECT_NEAR(coarse.peak_N, fine.peak_N, 0.03 * fine.peak_N);
  EXPECT_NEAR(coarse.skin_mm, fine.skin_mm, 1.5);
  // The method of 2005 is compared: its skin dents less, by an amount that depends on the mesh.
  for (const DemoOnMesh& row : of(*rows, "node-addition")) EXPECT_LT(row.skin_mm, 0.7 * fine.skin_mm);
}
