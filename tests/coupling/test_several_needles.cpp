// SPDX-License-Identifier: GPL-3.0-or-later
// Several needles in one tissue: needles at rest hold the tissue, bend and slip, and all laws hold for all needles.
#include "coupling/needle_in_block.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace stylet {
namespace {

using test::BlockOptions;
using test::NeedleInBlock;

constexpr double kTolerance = 1e-6;  // of the largest force

BlockOptions block_for(int needles, CouplingSettings::Method method = CouplingSettings::Method::near_field) {
  BlockOptions options;
  options.coupling.needles = needles;
  options.coupling.method = method;
  options.coupling.capacity = 40;
  return options;
}

std::unique_ptr<Needle> another_needle() {
  return BeamNeedle::build({150.0, 1.27, 15700, 12100}, 20, 42).value();
}

/// A block with several needles. Each is driven along its own axis.
struct Row {
  explicit Row(int needles, CouplingSettings::Method method = CouplingSettings::Method::near_field,
               BlockOptions options = {})
      : block([&] {
          options.coupling.needles = needles;
          options.coupling.method = method;
          options.coupling.capacity = 40;
          return options;
        }()) {
    for (int k = 1; k < needles; ++k) EXPECT_TRUE(insertion().add_needle(another_needle()));
    places.resize(static_cast<std::size_t>(needles));
  }
  Insertion& insertion() { return *block.insertion; }

  /// Takes up a needle that is in the air.
  void aim(int needle, const Vec3& through, const Vec3& axis = Vec3::UnitZ()) {
    take_up(needle);
    block.sideways.setZero();
    block.aim(through, axis);
  }
  void take_up(int needle) {
    places[static_cast<std::size_t>(insertion().held())] = {block.point, block.axis, block.sideways, block.depth};
    const auto done = insertion().take_up(needle);
    ASSERT_TRUE(done) << done.error().message();
    const Place& place = places[static_cast<std::size_t>(needle)];
    block.point = place.point;
    block.axis = place.axis;
    block.sideways = place.sideways;
    block.depth = place.depth;
  }

  struct Place {
    Vec3 point = Vec3::Zero();
    Vec3 axis = Vec3::UnitZ();
    Vec3 sideways = Vec3::Zero();
    double depth = -1.0;
  };
  NeedleInBlock block;
  std::vector<Place> places;
};

/// Largest violation of the equations of all needles at once, over the largest force: each needle is in equilibrium
/// under its contacts, and no contact is beyond its friction.
struct Violation {
  double needle = 0.0;
  double gap = 0.0;
  double friction = 0.0;
  int sliding_at_rest = 0;
};

Violation violation(Row& row, const std::vector<RegionLaws>& laws) {
  Insertion& insertion = row.insertion();
  Violation worst;
  double peak = 1.0;
  for (int k = 0; k < insertion.needles(); ++k) {
    for (const ContactState& contact : insertion.contacts_of(k)) peak = std::max(peak, contact.force.norm());
  }
  for (int k = 0; k < insertion.needles(); ++k) {
    const auto contacts = insertion.contacts_of(k);
    const Needle& needle = insertion.needle(k);
    const auto twin = another_needle();
    twin->set_base(needle.base());
    twin->set_state(needle.state());
    std::vector<PointLoad> loads;
    for (const ContactState& contact : contacts)
      loads.push_back({std::clamp(contact.s, 0.0, needle.length()), -contact.force});
    worst.needle = std::max(worst.needle, twin->residual(loads) / needle.length() / peak);
    const FrictionLaw& law = laws.front().friction;
    for (const ContactState& contact : contacts) {
      if (contact.tip || contact.s > needle.length() - 5.0) continue;  // young contacts yield
      const Vec3 t = needle.tangent(contact.s);
      const Vec3 gap = contact.position - needle.point(contact.s);
      const double own = 0.1;  // [mm/N], less than the tissue's compliance at a contact
      worst.gap = std::max(worst.gap, gap.norm() / own / peak);
      const double axial = std::abs(contact.force.dot(t));
      const double most = contact.sticking ? law.static_N_per_mm * contact.length
                                           : (law.coulomb_N_per_mm + law.viscous_Ns_per_mm2 * law.viscous_to_mm_per_s) *
                                                 contact.length;
      worst.friction = std::max(worst.friction, (axial - most) / peak);
      if (k != insertion.held() && !contact.sticking) ++worst.sliding_at_rest;
    }
  }
  return worst;
}

TEST(SeveralNeedles, all_laws_hold_for_all_needles_in_random_procedures) {
  int slid = 0;
  for (const unsigned seed : {1u, 2u, 3u}) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const BlockOptions options;
    Row row(3, seed == 1 ? CouplingSettings::Method::embedded : CouplingSettings::Method::near_field);
    for (int k = 0; k < 3; ++k) {
      row.aim(k, Vec3(9.0 * (k - 1) + unit(random), 2.0 * unit(random), 0),
              Vec3(0.03 * unit(random), 0.03 * unit(random), 1));
      row.block.go(35.0 + 10.0 * unit(random));
    }
    for (int turn = 0; turn < 6; ++turn) {
      row.take_up(turn % 3);
      row.block.sideways += 0.5 * Vec3(unit(random), unit(random), 0);
      row.block.go(row.block.depth + 6.0 * unit(random));
      const Violation now = violation(row, options.laws);
      EXPECT_LT(now.needle, kTolerance) << "seed " << seed << " turn " << turn;
      EXPECT_LT(now.gap, kTolerance) << "seed " << seed << " turn " << turn;
      EXPECT_LT(now.friction, kTolerance) << "seed " << seed << " turn " << turn;
      slid += now.sliding_at_rest;
    }
    EXPECT_EQ(row.block.flags & (Step::not_converged | Step::out_of_contacts), 0u) << "seed " << seed;
  }
  EXPECT_GT(slid, 0) << "no needle at rest has slipped: the test does not test that";
}

}  // namespace
}  // namespace stylet
