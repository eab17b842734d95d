// SPDX-License-Identifier: GPL-3.0-or-later
// A capsule behind fat, through which the needle has cut its way (docs/theory/near_field.md §4,
// docs/theory/stiffening.md §1).
#include "coupling/needle_in_block.hpp"
#include "support/sanitized.hpp"

#include <iostream>
#include <string>
#include <tuple>

namespace stylet {
namespace {

using test::BlockOptions;
using test::NeedleInBlock;

/// The flat end of a rod in its hole presses a capsule through 12 mm of fat of 2 kPa, on gland of 30 kPa: an
/// independent axisymmetric finite element model (tests/reference/capsule_behind_fat.py).
struct Dent {
  double depth_mm;
  double force_N;
};
#include "capsule_behind_fat.inc"

constexpr double kFat_mm = 12.0;
constexpr double kWide_mm = 100.0;  ///< width of the block of the finite element model
constexpr double kWithin_mm = 1.5;
constexpr double kWideWithin_mm = 1.0;    ///< in the wide block, whose coarsest elements are 33 mm wide
constexpr double kLinearWithin_mm = 0.2;  ///< steps are 0.05 mm

/// Base depth [mm] at which a capsule of a given strength [N] breaks in the finite element model of the block.
double of_elements(double strength_N) {
  Dent before{0.0, 0.0};
  for (const Dent& dent : kYeohDent) {
    if (strength_N <= dent.force_N) {
      const double share = (strength_N - before.force_N) / (dent.force_N - before.force_N);
      return kFat_mm + before.depth_mm + share * (dent.depth_mm - before.depth_mm);
    }
    before = dent;
  }
  ADD_FAILURE() << "the finite elements' curve ends before " << strength_N << " N";
  return 0.0;
}

/// A block with 12 mm of fat on gland, `wide_mm` wide and 100 mm deep including the fat, held at its sides and bottom.
/// Only the capsule resists the needle: cutting the fat takes no force and there is no friction on the shaft, so that
/// the hand feels the capsule alone and the needle stands in its hole through fat at rest.
BlockOptions fat_on_gland(int cells, double wide_mm, double capsule_N, double stiffening) {
  BlockOptions options;
  const double half = 0.5 * wide_mm;
  options.lo = {-half, -half, 0.0};
  options.hi = {half, half, kWide_mm};
  options.cells = {cells, cells, cells};
  options.jitter = 0.0;
  const double height = kWide_mm / cells;
  const double face = std::max(1.0, std::round(kFat_mm / height)) * height;  // the layer of nodes that is moved to the
                                                                             // interface with the gland
  options.regions = {"fat", "gland"};
  options.region_at = [face](const Vec3& x) { return x.z() < face ? 0 : 1; };
  options.edit = [face, height](TetMesh& mesh) {
    for (Vec3& x : mesh.nodes) {
      if (std::abs(x.z() - face) < 0.1 * height) x.z() = kFat_mm;
    }
  };
  options.materials = {{0.002, 0.45}, {0.03, 0.45}};
  options.laws = {{0.0, 0.0, {}, false, true, -1}, {0.0, capsule_N, {}, false, false, -1}};
  options.laws[0].stiffening_MPa = stiffening * options.materials[0].young_MPa;
  options.laws[1].stiffening_MPa = stiffening * options.materials[1].young_MPa;
  options.held = [half](const Vec3& x) {
    return std::max(std::abs(x.x()), std::abs(x.y())) > half - 0.1 || x.z() > kWide_mm - 0.1;
  };
  return options;
}

/// Pushes a needle straight in until the capsule breaks.
/// @param planned whether the needle's way is planned, so that its wide part is precomputed
NeedleInBlock until_it_breaks(BlockOptions options, bool planned, const Vec3& entry = {2.0, 3.0, 0.0}) {
  if (planned) options.ways = {{entry, Vec3::UnitZ(), 50.0}};
  NeedleInBlock run(options);
  run.aim(entry, Vec3::UnitZ(), 0.0);
  while (run.count(EventKind::puncture, 1) == 0 && run.depth < 50.0) run.go(run.depth + 0.05, 10.0, 5e-3);
  EXPECT_EQ(run.count(EventKind::puncture, 1), 1);
  EXPECT_EQ(run.flags, 0u);
  return run;
}

/// Base depth [mm] at which the hand first pushes with a force.
double depth_at(const NeedleInBlock& run, double force_N) {
  for (std::size_t i = 0; i < run.forces.size(); ++i) {
    if (run.forces[i] >= force_N) return run.depths[i];
  }
  return run.depth;  // the step in which the capsule broke
}

/// Cells along each side of the block, and whether the needle's way is planned.
using Mesh = std::tuple<int, bool>;
class CapsuleBehindFat : public testing::TestWithParam<Mesh> {};

std::string name(const Mesh& mesh) {
  return std::to_string(std::get<0>(mesh)) + " cells, " + (std::get<1>(mesh) ? "on its way" : "without a way");
}

TEST_P(CapsuleBehindFat, of_linear_tissue_breaks_as_deep_as_finite_elements_say) {
  const auto [cells, planned] = GetParam();
  constexpr double kCapsule_N = 0.6;  // of the preset `linear`
  const NeedleInBlock run = until_it_breaks(fat_on_gland(cells, kWide_mm, kCapsule_N, 0.0), planned);
  for (const double strength : {0.3, kCapsule_N}) {
    const double expected = kFat_mm + kLinearDent[0] * strength;
    const double ours = depth_at(run, strength);
    EXPECT_NEAR(ours, expected, kLinearWithin_mm) << strength << " N";
    std::cout << name(GetParam()) << ", linear, " << strength << " N: " << ours << " mm, finite elements " << expected
              << '\n';
  }
}

TEST_P(CapsuleBehindFat, that_stiffens_breaks_as_deep_as_finite_elements_of_a_yeoh_solid_say) {
  const auto [cells, planned] = GetParam();
  constexpr double kCapsule_N = 4.5;
  // κ of a Yeoh solid with C20 = C10 (docs/theory/stiffening.md §1).
  const NeedleInBlock run = until_it_breaks(fat_on_gland(cells, kWide_mm, kCapsule_N, 2.0), planned);
  for (const double strength : {1.0, 2.0, 3.0, 4.0, kCapsule_N}) {
    const double ours = depth_at(run, strength);
    EXPECT_NEAR(ours, of_elements(strength), kWithin_mm) << strength << " N";
    std::cout << name(GetParam()) << ", stiffening, " << strength << " N: " << ours << " mm, finite elements "
              << of_elements(strength) << '\n';
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, CapsuleBehindFat,
                         testing::Combine(testing::ValuesIn(test::meshes({6, 10, 16})), testing::Bool()));

class CapsuleBehindFatInAWideBlock : public CapsuleBehindFat {};

/// At several places of the entry within an element.
TEST_P(CapsuleBehindFatInAWideBlock, breaks_as_deep_as_finite_elements_say) {
  const auto [cells, planned] = GetParam();
  constexpr double kCapsule_N = 4.5;
  const double expected = of_elements(kCapsule_N) + (kLinearDent[1] - kLinearDent[0]) * kCapsule_N;
  const BlockOptions options = fat_on_gland(cells, 2.0 * kWide_mm, kCapsule_N, 2.0);
  for (const Vec3& entry : {Vec3(2.0, 3.0, 0.0), Vec3(-4.1, 7.7, 0.0), Vec3(0.3, -0.2, 0.0)}) {
    const NeedleInBlock run = until_it_breaks(options, planned, entry);
    EXPECT_NEAR(run.depth, expected, planned ? kWithin_mm : kWideWithin_mm) << entry.transpose();
    std::cout << name(GetParam()) << ", twice as wide, in at " << entry.x() << " and " << entry.y() << ", "
              << kCapsule_N << " N: " << run.depth << " mm, finite elements " << expected << '\n';
  }
}
INSTANTIATE_TEST_SUITE_P(Meshes, CapsuleBehindFatInAWideBlock,
                         testing::Combine(testing::ValuesIn(test::meshes({6, 10, 16})), testing::Bool()));

}  // namespace
}  // namespace stylet
