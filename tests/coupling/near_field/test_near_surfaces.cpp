// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/near_field/medium_block.hpp"

#include <Eigen/Eigenvalues>

#include <iostream>
#include <random>
#include <string>
#include <tuple>

namespace stylet {
namespace {

using test::MediumBlock;
using test::ThinLayer;

/// On the skin, and from there through all blocks.
const NeedleWay kFromTheSkin{{1.3, 0.7, -50.0}, Vec3::UnitZ(), 98.0};

/// Motion of x under a force at `source` in a half space without sides, of which the block's own part is `ours`: the
/// block's held nodes move with the half space's field.
Mat3 in_half_space(const Mat3& ours, const MediumBlock& block, const Vec3& source, const Vec3& x) {
  std::vector<Mat3> field;
  for (const Index node : block.fixed) {
    const Vec3& y = block.tissue->mesh().nodes[static_cast<std::size_t>(node)];
    const SurfacePair surface{Vec3::UnitZ(), y.z() + 50.0, source.z() + 50.0};
    field.emplace_back(kelvinlet(y - source, 1e-6, block.medium) +
                       free_surface_image(y - source, surface, 1e-6, block.medium));
  }
  return ours + block.lift(x, field);
}

/// Tests on meshes of some numbers of cells, along a planned path and without one.
class WithAndWithoutPath : public testing::TestWithParam<std::tuple<int, bool>> {
 protected:
  static int cells() { return std::get<0>(GetParam()); }
  static std::vector<NeedleWay> ways() {
    return std::get<1>(GetParam()) ? std::vector{kFromTheSkin} : std::vector<NeedleWay>();
  }
};

std::string mesh_and_path(const testing::TestParamInfo<std::tuple<int, bool>>& info) {
  const auto [cells, planned] = info.param;
  return std::to_string(cells) + "_cells" + (planned ? "_on_a_path" : "");
}

class TipNearTheSkin : public WithAndWithoutPath {};

TEST_P(TipNearTheSkin, gives_way_like_a_flat_punch_on_it) {
  MediumBlock block({.cells = cells(), .skin = true, .ways = ways()});
  const NeedleKernel needle;
  const double punch = (1.0 - 0.45 * 0.45) / (2.0 * needle.radius_mm * 0.01);
  for (const Vec3& x : {Vec3(1.3, 0.7, -50), Vec3(4.1, -3.3, -50), Vec3(0.2, 8.9, -50)})
    EXPECT_NEAR(in_half_space(block.tip(needle, x), block, x, x)(2, 2) / punch, 1.0, 0.03) << x.transpose();
}

TEST_P(TipNearTheSkin, gives_way_as_mindlin_says_below_it) {
  MediumBlock block({.cells = cells(), .skin = true, .ways = ways()});
  const NeedleKernel needle;
  for (const double depth : {1.0, 2.0, 4.0, 7.0, 10.0, 20.0}) {
    const Vec3 x(2.3, -1.7, depth - 50.0);
    const double epsilon = needle.own_tip_epsilon({depth, Vec3::UnitZ(), 1.0}, {}, block.medium.poisson);
    const Mat3 mindlin = kelvinlet(Vec3::Zero(), epsilon, block.medium) +
                         free_surface_image(Vec3::Zero(), {Vec3::UnitZ(), depth, depth}, epsilon, block.medium);
    const Mat3 ours = in_half_space(block.tip(needle, x), block, x, x);
    EXPECT_LT((ours - mindlin).norm(), 0.03 * mindlin.norm()) << depth;
  }
}
INSTANTIATE_TEST_SUITE_P(Meshes, TipNearTheSkin, testing::Combine(testing::Values(7, 12), testing::Bool()),
                         mesh_and_path);

TEST(PointForceNearTheSkin, moves_other_points_as_mindlin_says) {
  MediumBlock block({.cells = 14, .skin = true});
  for (const double depth : {1.0, 3.0, 6.0, 10.0}) {
    const Vec3 source(2.3, -1.7, depth - 50.0);
    for (const Vec3& way : {Vec3(3, 0, 0), Vec3(-2, 2, 3), Vec3(0, 0, 5), Vec3(6, -4, 2)}) {
      const Vec3 seen = source + way;
      const NeedleKernel point{.radius_mm = 0.05};  // a point, as Mindlin's force is
      const Mat3 mindlin = kelvinlet(way, 1e-6, block.medium) +
                           free_surface_image(way, {Vec3::UnitZ(), depth + way.z(), depth}, 1e-6, block.medium);
      const Mat3 ours = in_half_space(block.tip_moves(point, source, seen), block, source, seen);
      EXPECT_LT((ours - mindlin).norm(), 0.1 * mindlin.norm()) << depth << ": " << way.transpose();
    }
  }
}

TEST(TipNearBone, gives_way_less_the_nearer_it_is_and_not_at_all_on_it) {
  MediumBlock block({.cells = 10, .also_held = [](const Vec3& x) { return x.z() > 9.0; }});
  const NeedleKernel needle;
  double before = 1e9;
  double surface = 1e9;
  for (Index node = 0; node < block.tissue->mesh().node_count(); ++node) {
    const Vec3& x = block.tissue->mesh().nodes[static_cast<std::size_t>(node)];
    if (x.z() > 9.0 && std::max(std::abs(x.x()), std::abs(x.y())) < 9) surface = std::min(surface, x.z());
  }
  for (const double away : {20.0, 10.0, 5.0, 2.0, 1.0}) {
    const Vec3 x(0.4, 0.3, surface - away);
    const double own = block.tip(needle, x).trace();
    EXPECT_GT(own, 0.0) << away;
    EXPECT_LT(own, before) << away;
    before = own;
  }
  for (Index node = 0; node < block.tissue->mesh().node_count(); ++node) {
    const Vec3& x = block.tissue->mesh().nodes[static_cast<std::size_t>(node)];
    if (x.z() > 15.0 || x.z() < 9.0 || std::max(std::abs(x.x()), std::abs(x.y())) > 25) continue;
    EXPECT_LT(block.tip(needle, x).norm(), 1e-9) << x.transpose();
  }
}

/// Stiffness [N/mm] of the flat end of a rod of radius 0.635 mm in its hole, by an axisymmetric finite element model
/// (tests/reference/rod_end.py): fat of 2 kPa above gland of 30 kPa, ν = 0.45. The end is `above` [mm] above the
/// interface; negative values are below it.
struct RodEnd {
  double above;
  double stiffness;
};
constexpr RodEnd kBetweenFatAndGland[] = {
#include "rod_end.inc"
};

class TipBetweenTwoTissues : public WithAndWithoutPath {
 protected:
  MediumBlock block{{.cells = cells(),
                     .jitter = 0.0,
                     .regions = {"fat", "gland"},
                     .region_at = [](const Vec3& x) { return x.z() < 0.0 ? 0 : 1; },
                     .materials = {{0.002, 0.45}, {0.03, 0.45}},
                     .ways = ways()}};
};

TEST_P(TipBetweenTwoTissues, gives_way_as_finite_elements_around_a_rod_say_on_any_mesh) {
  for (const RodEnd& end : kBetweenFatAndGland) {
    for (const double side : {-1e-6, 1e-6}) {
      const double product = block.tip({}, {1.3, 0.7, side - end.above})(2, 2) * end.stiffness;
      EXPECT_NEAR(product, 1.0, 0.15) << end.above << " mm above";
      if (side < 0.0) continue;
      std::cout << cells() << " cells" << (ways().empty() ? ", " : " on a path, ") << end.above
                << " mm above: " << product << '\n';
    }
  }
}

TEST_P(TipBetweenTwoTissues, is_never_held_by_less_on_its_way_into_the_harder_one) {
  double before = 1e9;
  for (double z = -8.0; z <= 8.0; z += 0.1) {
    const double compliance = block.tip({}, {1.3, 0.7, z + 1e-6})(2, 2);
    EXPECT_LT(compliance, 1.01 * before) << z;
    before = compliance;
  }
}
// With these numbers of cells, an interface at z = 0 lies on element faces.
INSTANTIATE_TEST_SUITE_P(Meshes, TipBetweenTwoTissues, testing::Combine(testing::Values(6, 8, 14), testing::Bool()),
                         mesh_and_path);

double compliance(ThinLayer& layer, double z) { return layer.tip({}, {1.3, 0.7, z})(2, 2); }

TEST(TipInAThinLayer, gives_way_alike_on_any_mesh) {
  ThinLayer coarse(8), fine(18);
  for (double z = -8.0; z <= 14.0; z += 0.5) {
    const double of_fine = compliance(fine, z + 1e-6);
    EXPECT_NEAR(compliance(coarse, z + 1e-6) / of_fine, 1.0, 0.06) << z;
  }
}

/// In steps much shorter than the distance over which the tip's own field decays.
TEST(TipInAThinLayer, feels_both_faces_and_nothing_jumps) {
  ThinLayer layer(10);
  const double in_the_middle = compliance(layer, 0.5 * ThinLayer::kThickness);
  EXPECT_GT(in_the_middle, 3.0 * compliance(layer, -4.0));
  MediumBlock all_fat({.cells = 10, .jitter = 0.0, .materials = {{0.002, 0.45}}});
  EXPECT_LT(in_the_middle, all_fat.tip({}, {1.3, 0.7, 3.0})(2, 2));
  double before = compliance(layer, -8.0);
  for (double z = -8.0; z <= 14.0; z += 0.02) {
    const double here = compliance(layer, z + 1e-7);
    EXPECT_NEAR(here / before, 1.0, 0.08) << z;
    before = here;
  }
}

/// Needle and tissue have a unique balance only if all forces of tip and shaft do positive work on the tissue. With
/// creep, so that a planned path's wide part is computed as well.
TEST(TipInAThinLayer, forces_of_tip_and_shaft_through_it_do_work_on_any_mesh) {
  for (const auto& [cells, planned] :
       {std::pair(8, false), std::pair(12, false), std::pair(18, false), std::pair(8, true), std::pair(12, true)}) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> aside(-3.0, 3.0);
    ThinLayer block(cells, planned ? std::vector{kFromTheSkin} : std::vector<NeedleWay>());
    for (const double spacing : {1.6, 2.5, 4.0}) {
      SCOPED_TRACE(testing::Message() << cells << " cells, " << spacing << " mm apart, planned: " << planned);
      // The needle enters from the muscle's side or from the gland's.
      const bool upwards = spacing == 2.5;
      const Vec3 axis = Vec3(0.1 * aside(random), 0.1 * aside(random), upwards ? 1.0 : -1.0).normalized();
      const Vec3 start(aside(random), aside(random), upwards ? -12.0 : 18.0);
      std::vector<Vec3> line;
      for (double way = 0.0; way < 30.0; way += 0.25 * spacing) line.emplace_back(start + way * axis);
      block.prepare(line);
      NearFieldCompliance A(std::make_unique<TrackCompliance>(block.store, *block.locator, 40), block.tissue,
                            block.kernel, {.segment_mm = spacing}, 40, {}, planned, block.spread);
      for (std::size_t k = 0; k < line.size(); ++k) {
        const MaterialPoint at = block.at(line[k]);
        ASSERT_TRUE(A.move_tip(at, line[k]));
        A.begin_sub_step();
        ASSERT_TRUE(A.move_tip(at, line[k]));
        if (k % 4 == 0) {
          ASSERT_GT(A.add(at, line[k], Placement::embedded, axis).point, 0);
        }
        const Eigen::Index size = 3 * Eigen::Index{A.points()};
        const MatX whole = A.matrix().topLeftCorner(size, size);
        EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatX>(whole).eigenvalues()[0], 0.0) << line[k].z();
        if (!planned) continue;
        const MatX narrow = whole - A.wide().topLeftCorner(size, size);
        EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatX>(narrow).eigenvalues()[0], 0.0) << line[k].z();
      }
    }
  }
}

}  // namespace
}  // namespace stylet
