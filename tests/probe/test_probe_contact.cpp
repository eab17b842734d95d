// SPDX-License-Identifier: GPL-3.0-or-later
#include "pressed_block.hpp"
#include "stylet/probe/probe_contact.hpp"
#include "support/count_allocations.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

namespace stylet {
namespace {

using testing::Block;
using testing::lying_on;
using testing::pressing_down;
using testing::reach_of;
using testing::soft_block;

class PressedBlock : public ::testing::Test {
 protected:
  static std::shared_ptr<const WallCompliance> wall() {
    static const auto made = soft_block().wall(reach_of(lying_on(0.0), 2.5));
    return made;
  }
  ProbeContact contact_{wall()};
};

TEST_F(PressedBlock, no_point_is_deeper_in_the_probe_than_a_twentieth_of_a_millimetre) {
  for (const double depth : {1.0, 2.0, 4.0, 6.0}) {
    const ProbePress press = contact_.press(lying_on(depth));
    ASSERT_GT(press.touching, 5);
    EXPECT_LE(press.penetration_mm, 0.05);
    for (int i = 0; i < wall()->count(); ++i) {
      const Vec3 place = wall()->points[static_cast<std::size_t>(i)].position_mm + contact_.displacement_of_point(i);
      EXPECT_GE(lying_on(depth).nearest(place).mm, -0.05) << "point " << i;
    }
  }
}

TEST_F(PressedBlock, every_point_presses_or_has_a_gap_but_never_both_and_nothing_pulls) {
  contact_.press(lying_on(4.0));
  for (int i = 0; i < wall()->count(); ++i) {
    const double force = contact_.forces()[static_cast<std::size_t>(i)];
    EXPECT_GE(force, 0.0);
    EXPECT_NEAR(force * std::max(0.0, contact_.gaps()[static_cast<std::size_t>(i)]), 0.0, 1e-3 * force + 1e-12)
        << "N mm, a pressing point is at most 0.001 mm off the probe … point " << i;
  }
}

TEST_F(PressedBlock, force_on_the_probe_is_the_sum_of_the_forces_on_the_wall_and_along_the_press) {
  const ProbePress press = contact_.press(lying_on(4.0));
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < wall()->count(); ++i) sum += contact_.forces()[static_cast<std::size_t>(i)] * contact_.normal(i);
  EXPECT_LT((sum + press.force_N).norm(), 1e-12);
  EXPECT_GT(press.force_N.z(), 0.0) << "the block pushes the probe up";
}

TEST_F(PressedBlock, force_grows_with_depth) {
  double last = 0.0;
  for (double depth = 0.5; depth <= 8.0; depth += 0.5) {
    const double force = contact_.press(lying_on(depth)).force_N.z();
    EXPECT_GT(force, last) << depth << " mm";
    last = force;
  }
}

TEST_F(PressedBlock, result_does_not_depend_on_the_way_to_the_pose) {
  ProbeContact direct(wall());
  const Vec3 at_once = direct.press(lying_on(4.0)).force_N;
  for (const double depth : {1.0, 6.0, 0.0, 7.0}) contact_.press(lying_on(depth));
  EXPECT_LT((contact_.press(lying_on(4.0)).force_N - at_once).norm(), 0.005 * at_once.norm());
}

TEST_F(PressedBlock, nothing_moves_when_the_probe_is_away) {
  contact_.press(lying_on(4.0));
  const ProbePress press = contact_.press(lying_on(-5.0));
  EXPECT_EQ(press.touching, 0);
  EXPECT_EQ(press.force_N.norm(), 0.0);
  Eigen::Matrix3Xf u(3, wall()->nodes.rows() / 3);
  contact_.displacement(u);
  EXPECT_EQ(u.cwiseAbs().maxCoeff(), 0.0F);
}

TEST_F(PressedBlock, displacement_of_asked_nodes_is_that_of_all_nodes) {
  contact_.press(lying_on(4.0));
  Eigen::Matrix3Xf all(3, wall()->nodes.rows() / 3);
  contact_.displacement(all);
  const std::vector<Index> nodes{700, 3, 512};
  Eigen::Matrix3Xf some(3, 3);
  contact_.displacement(nodes, some);
  for (int k = 0; k < 3; ++k) EXPECT_LT((some.col(k) - all.col(nodes[static_cast<std::size_t>(k)])).norm(), 1e-6F);
  EXPECT_GT(all.cwiseAbs().maxCoeff(), 1.0F);
}

TEST_F(PressedBlock, a_pose_does_not_allocate) {
  if (!test::AllocationCount::available()) GTEST_SKIP() << "allocations cannot be counted here";
  Eigen::Matrix3Xf u(3, wall()->nodes.rows() / 3);
  const test::AllocationCount allocations;
  for (const double depth : {2.0, 3.0, 6.0, 1.0, -2.0, 4.0}) {
    contact_.press(lying_on(depth));
    contact_.displacement(u);
  }
  contact_.release();
  EXPECT_EQ(allocations.count(), 0);
}

TEST_F(PressedBlock, the_pose_in_which_the_patient_was_drawn_moves_nothing_and_both_ways_from_it_move_the_tissue) {
  contact_.set_reference(lying_on(4.0));
  Eigen::Matrix3Xf u(3, wall()->nodes.rows() / 3);
  const ProbePress here = contact_.press(lying_on(4.0));
  contact_.displacement(u);
  EXPECT_LT(u.cwiseAbs().maxCoeff(), 0.01F);
  EXPECT_GT(here.force_N.z(), 0.1) << "the wall presses there";
  const auto middle_moves = [&](double depth) {
    contact_.press(lying_on(depth));
    contact_.displacement(u);
    return static_cast<double>(u.row(2).minCoeff() + u.row(2).maxCoeff());
  };
  EXPECT_LT(middle_moves(5.0), -0.5) << "deeper presses the tissue down";
  EXPECT_GT(middle_moves(3.0), 0.5) << "shallower lets it come up";
  EXPECT_GT(middle_moves(-20.0), 2.0) << "without a probe it comes back all the way";
  EXPECT_EQ(contact_.press(lying_on(-20.0)).touching, 0);
}

TEST(ProbeContact, a_turned_or_mirrored_block_gives_the_turned_or_mirrored_force) {
  const auto force_of = [](const Mat3& frame) {
    TetMesh mesh = box_mesh({-20, -20, -20}, {20, 20, 0}, {8, 8, 4}, 0.15);
    // Uneven, so that no two distances on the wall are equal.
    for (Vec3& x : mesh.nodes) x += 0.3 * Vec3(std::sin(7.0 * x.x() + 3.0 * x.y()), std::cos(5.0 * x.y() - x.x()), 0.0);
    for (Vec3& x : mesh.nodes) x = frame * x;
    if (frame.determinant() < 0.0)
      for (auto& tet : mesh.tets) std::swap(tet[0], tet[1]);
    const auto back = [frame](const Vec3& x) { return Vec3(frame.transpose() * x); };
    const Block block(
        std::move(mesh), {0.01, 0.3}, [&](const Vec3& x) { return testing::is_top(back(x)); },
        [&](const Vec3& x) { return back(x).z() < -19.999; });
    Capsule probe = lying_on(0.0);
    probe.centre_mm += Vec3(0.37, 0.61, 0.0);  // beside the mesh's symmetries
    WallReach reach = reach_of(probe, 2.5);
    reach.rest = {frame * probe.centre_mm, frame * probe.axis, probe.radius_mm};
    reach.finest = frame * reach.finest;
    ProbeContact contact(block.wall(reach));
    probe = lying_on(4.0);
    const ProbePress press = contact.press({frame * probe.centre_mm, frame * probe.axis, probe.radius_mm});
    return Vec3(frame.transpose() * press.force_N);
  };
  const Vec3 force = force_of(Mat3::Identity());
  const Mat3 turned = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  EXPECT_LT((force_of(turned) - force).norm(), 1e-3 * force.norm());
  Mat3 mirrored = Mat3::Identity();
  mirrored(0, 0) = -1.0;
  EXPECT_LT((force_of(mirrored) - force).norm(), 1e-3 * force.norm());
}

TEST(ProbeContact, field_is_that_of_tissue_whose_touching_nodes_are_moved_as_the_probe_moves_them) {
  const Block block = soft_block(8, 0.1, Element::p2);
  const Tissue& tissue = *block.tissue;
  const auto wall = block.wall(reach_of(lying_on(0.0), 2.5));
  ProbeContact contact(wall);
  const ProbePress press = contact.press(lying_on(5.0));
  MatX load = MatX::Zero(3 * Eigen::Index{tissue.displacement_nodes()}, 1);
  std::vector<char> touches(tissue.mesh().nodes.size(), 0);
  for (int i = 0; i < wall->count(); ++i) {
    const double force = contact.forces()[static_cast<std::size_t>(i)];
    if (force <= 0.0) continue;
    for (const auto& [node, weight] : wall->points[static_cast<std::size_t>(i)].weights) {
      load.block<3, 1>(3 * Eigen::Index{node}, 0) += weight * force * contact.normal(i);
      for (const Index end : tissue.ends_of(node)) touches[static_cast<std::size_t>(end)] = 1;
    }
  }
  const MatX u = tissue.solve(load);
  Eigen::Matrix3Xf field(3, tissue.mesh().node_count());
  contact.displacement(field);
  const double largest = static_cast<double>(field.colwise().norm().maxCoeff());
  for (Index n = 0; n < tissue.mesh().node_count(); ++n)
    EXPECT_LT((u.block<3, 1>(3 * Eigen::Index{n}, 0) - field.col(n).cast<double>()).norm(), 1e-4 * largest);

  // The same nodes held in tissue that is factorised anew: K_ff u_f = −K_fc u_c.
  std::vector<Index> held = tissue.fixed_nodes();
  std::erase_if(held, [&](Index n) { return n >= tissue.mesh().node_count(); });
  for (Index n = 0; n < tissue.mesh().node_count(); ++n) {
    if (touches[static_cast<std::size_t>(n)] != 0) held.push_back(n);
  }
  const Tissue again = Tissue::build(tissue.mesh(), tissue.materials(), held, {}, Element::p2).value();
  VecX prescribed = VecX::Zero(tissue.free_dofs());
  for (Index n = 0; n < tissue.displacement_nodes(); ++n) {
    if (again.first_dof(n) < 0 && tissue.first_dof(n) >= 0)
      prescribed.segment<3>(tissue.first_dof(n)) = u.block<3, 1>(3 * Eigen::Index{n}, 0);
  }
  const VecX residual = tissue.stiffness() * prescribed;
  MatX f = MatX::Zero(3 * Eigen::Index{tissue.displacement_nodes()}, 1);
  for (Index n = 0; n < tissue.displacement_nodes(); ++n) {
    if (again.first_dof(n) >= 0) f.block<3, 1>(3 * Eigen::Index{n}, 0) = -residual.segment<3>(tissue.first_dof(n));
  }
  const MatX rest = again.solve(f);
  VecX all = prescribed;
  double off = 0.0;
  for (Index n = 0; n < tissue.displacement_nodes(); ++n) {
    if (again.first_dof(n) < 0) continue;
    all.segment<3>(tissue.first_dof(n)) = rest.block<3, 1>(3 * Eigen::Index{n}, 0);
    off = std::max(off, (rest.block<3, 1>(3 * Eigen::Index{n}, 0) - u.block<3, 1>(3 * Eigen::Index{n}, 0)).norm());
  }
  EXPECT_LT(off, 0.02 * largest);
  const VecX forces = tissue.stiffness() * all;
  Vec3 sum = Vec3::Zero();
  for (Index n = 0; n < tissue.displacement_nodes(); ++n) {
    if (again.first_dof(n) < 0 && tissue.first_dof(n) >= 0) sum += forces.segment<3>(tissue.first_dof(n));
  }
  EXPECT_LT((sum + press.force_N).norm(), 0.02 * press.force_N.norm());
}

TEST(ProbeContact, on_linear_elements_has_nearly_the_force_and_field_of_quadratic_ones_throughout) {
  struct Pressed {
    Vec3 force;
    Eigen::Matrix3Xf field;   // of the nodes; those of the wall are fitted to the areas, and are left out
    Eigen::Matrix3Xd points;  // of the areas
  };
  const auto pressed = [](int cells, Element element) {
    const Block block = soft_block(cells, 0.1, element);
    ProbeContact contact(block.wall(reach_of(lying_on(0.0), 2.5)));
    const TetMesh& mesh = block.tissue->mesh();
    Pressed result{contact.press(lying_on(5.0)).force_N, Eigen::Matrix3Xf(3, mesh.node_count()),
                   Eigen::Matrix3Xd(3, contact.wall().count())};
    contact.displacement(result.field);
    for (Index n = 0; n < mesh.node_count(); ++n) {
      if (testing::is_top(mesh.nodes[static_cast<std::size_t>(n)])) result.field.col(n).setZero();
    }
    for (int i = 0; i < contact.wall().count(); ++i) result.points.col(i) = contact.displacement_of_point(i);
    return result;
  };
  for (const int cells : {6, 10}) {
    const Pressed linear = pressed(cells, Element::p1), quadratic = pressed(cells, Element::p2);
    EXPECT_LT((linear.force - quadratic.force).norm(), 0.05 * quadratic.force.norm()) << cells;
    const float largest = quadratic.field.colwise().norm().maxCoeff();
    EXPECT_LT((linear.field - quadratic.field).colwise().norm().maxCoeff(), 0.1F * largest) << cells;
    EXPECT_LT((linear.points - quadratic.points).colwise().norm().maxCoeff(),
              0.1 * quadratic.points.colwise().norm().maxCoeff())
        << cells;
  }
}

TEST(ProbeContact, a_cylinder_on_a_half_space_touches_a_strip_of_the_width_of_hertz) {
  // ν = 0, so a slab with free faces is in plane strain. a = √(4 F′ R / (π E)), and the pressure's second moment is
  // a²/4 (Johnson, Contact Mechanics, 1985, §4.2).
  constexpr double young = 0.01;
  constexpr double slab_mm = 0.4;
  constexpr double radius_mm = 60.0;
  // Elements of 0.2 mm under the cylinder, growing outwards.
  TetMesh mesh = box_mesh({0, -1, -1}, {slab_mm, 1, 0}, {1, 120, 50});
  for (Vec3& x : mesh.nodes)
    x = {x.x(), 60.0 * std::sinh(3.5 * x.y()) / std::sinh(3.5), 60.0 * std::sinh(3.5 * x.z()) / std::sinh(3.5)};
  const Block block(std::move(mesh), {young, 0.0}, testing::is_top,
                    [](const Vec3& x) { return x.z() < -59.999 || std::abs(x.y()) > 59.999; });
  const auto cylinder = [&](double depth) {
    return Capsule{{1000.0, 0.0, radius_mm - depth}, Vec3::UnitX(), radius_mm};
  };
  const WallReach reach = reach_of({{slab_mm / 2, 0.0, radius_mm}, Vec3::UnitX(), radius_mm}, 0.5, 150);
  std::vector<WallFace> middle;
  for (const WallFace& face : block.faces) {
    const auto& x = block.tissue->mesh().nodes[static_cast<std::size_t>(face.nodes[0])];
    if (std::abs(x.y()) < 8.0) middle.push_back(face);
  }
  const auto wall = std::make_shared<const WallCompliance>(
      WallCompliance::solve(*block.tissue, wall_points(*block.tissue, middle, reach)).value());
  ProbeContact contact(wall);
  for (const double depth : {0.5, 0.8}) {
    const ProbePress press = contact.press(cylinder(depth));
    double sum = 0.0;
    double second = 0.0;
    for (int i = 0; i < wall->count(); ++i) {
      const double y = wall->points[static_cast<std::size_t>(i)].position_mm.y() + contact.displacement_of_point(i).y();
      sum += contact.forces()[static_cast<std::size_t>(i)];
      second += contact.forces()[static_cast<std::size_t>(i)] * y * y;
    }
    ASSERT_GT(press.touching, 8);
    const double half_width = 2.0 * std::sqrt(second / sum);
    const double hertz = std::sqrt(4.0 * press.force_N.z() / slab_mm * radius_mm / (std::numbers::pi * young));
    EXPECT_NEAR(half_width / hertz, 1.0, 0.05) << "half width " << half_width << " mm, Hertz " << hertz << " mm";
  }
}

TEST(WallPoints, cover_the_wall_once_and_keep_its_side) {
  const Block block = soft_block();
  const auto points = wall_points(*block.tissue, block.faces, reach_of(lying_on(0.0), 2.5, 150));
  EXPECT_LE(points.size(), 150U);
  EXPECT_GE(points.size(), 120U);
  double area = 0.0;
  for (const WallPoint& point : points) {
    area += point.area_mm2;
    EXPECT_LT((point.outward + Vec3::UnitZ()).norm(), 1e-12) << "the wall is below the lumen";
    double sum = 0.0;
    for (const auto& [node, weight] : point.weights) sum += weight;
    EXPECT_NEAR(sum, 1.0, 1e-12);
  }
  EXPECT_NEAR(area, 1600.0, 1e-6);
}

TEST(WallPoints, their_number_does_not_depend_on_the_mesh) {
  const auto count = [](int cells) {
    const Block block = soft_block(cells);
    return wall_points(*block.tissue, block.faces, reach_of(lying_on(0.0), 4.0)).size();
  };
  EXPECT_NEAR(static_cast<double>(count(6)), static_cast<double>(count(14)), 12.0);
}

TEST(WallPoints, a_patient_without_rectum_is_refused_with_a_cure) {
  const TetMesh mesh = box_mesh({0, 0, 0}, {10, 10, 10}, {2, 2, 2});
  const auto wall = rectal_wall(mesh, Topology(mesh), "case.toml");
  ASSERT_FALSE(wall);
  EXPECT_NE(wall.error().message().find("case.toml"), std::string::npos);
  EXPECT_NE(wall.error().message().find("probe.kind"), std::string::npos);
}

}  // namespace
}  // namespace stylet
