// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of the reference solutions that the near field is compared with.
#include "coupling/near_field/navier.hpp"
#include "evidence/validate/bonded_cylinder.hpp"
#include "evidence/validate/surface_load.hpp"
#include "stylet/coupling/near_field/half_space.hpp"

#include <gtest/gtest.h>

namespace stylet {
namespace {

const Medium kReferenceMedium{3.4e-3, 0.45};

TEST(SurfaceForce, is_in_balance_below_the_surface_and_leaves_it_free_of_traction) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto u = [&](const Vec3& x) { return Vec3(validate::surface_force(x, kReferenceMedium).col(axis)); };
    EXPECT_LT(test::body_force(u, Vec3(2, 1, 3), kReferenceMedium).norm(), 1e-6);
    const Mat3 s = test::stress(u, Vec3(3, -4, 1e-6 + 1e-4), kReferenceMedium);
    EXPECT_LT(s.col(2).norm(), 1e-3 * s.norm());
  }
}

TEST(FreeSurface, image_is_what_surface_loads_that_take_kelvins_tractions_off_add_up_to) {
  for (const double depth : {1.0, 3.0, 10.0}) {
    for (const Vec3& way : {Vec3(0, 0, 0), Vec3(3, 0, 0), Vec3(-2, 2, 3), Vec3(6, -4, 60)}) {
      const Vec3 source(0.3, 0.4, depth);
      const SurfacePair surface{Vec3::UnitZ(), depth + way.z(), depth};
      const Mat3 mindlin = free_surface_image(way, surface, 1e-9, kReferenceMedium);
      const Mat3 superposed = validate::surface_part(source + way, source, kReferenceMedium);
      EXPECT_LT((mindlin - superposed).norm(), 1e-6 * mindlin.norm()) << depth << ": " << way.transpose();
    }
  }
}

TEST(BondedCylinder, tends_to_the_slender_body_the_longer_it_is) {
  double before = 1.0;
  for (const double length : {10.0, 40.0, 160.0}) {
    const auto cylinder = validate::bonded_cylinder(length, 0.635, 1.0, kReferenceMedium);
    const auto slender = validate::slender_cylinder(length, 0.635, 1.0, kReferenceMedium);
    const double off = std::max(cylinder.lateral_N / slender.lateral_N, cylinder.axial_N / slender.axial_N) - 1.0;
    EXPECT_GT(off, 0.0) << length;  // flat ends add a little stiffness
    EXPECT_LT(off, before) << length;
    before = off;
  }
  EXPECT_LT(before, 0.02);
}

}  // namespace
}  // namespace stylet
