// SPDX-License-Identifier: GPL-3.0-or-later
// The probe in the demo patient, and on large blocks.
#include "pressed_block.hpp"
#include "stylet/measure/demo.hpp"
#include "stylet/probe/patient_probe.hpp"
#include "support/sanitized.hpp"

#include <gtest/gtest.h>

#include <map>

namespace stylet {
namespace {

/// Beyond the gland's base, as a coil or a balloon is; the lumen bends back there.
constexpr double kBeyondBase_mm = 30.0;

class ProbeInPatient : public ::testing::Test {
 protected:
  struct Made {
    std::unique_ptr<const measure::ProbedDemo> demo;
    std::unique_ptr<PatientProbe> probe;
  };
  static Made& made(Index nodes) {
    static std::map<Index, Made> all;
    Made& made = all[nodes];
    if (!made.probe) {
      made.demo = std::make_unique<const measure::ProbedDemo>(measure::probed_demo(nodes).value());
      made.probe = std::make_unique<PatientProbe>(
          PatientProbe::prepare(made.demo->patient(), {.kind = ProbeKind::biplane, .depth_mm = {}}, "demo").value());
    }
    return made;
  }
  static ProbeSettings at(const PatientProbe& probe, double beyond_mm, double lift_mm) {
    ProbeSettings settings;
    settings.kind = ProbeKind::biplane;
    settings.depth_mm = probe.seat().gland_mm + beyond_mm;
    settings.lift_mm = lift_mm;
    return settings;
  }
};

TEST_F(ProbeInPatient, has_between_120_and_150_areas_of_the_wall_on_every_mesh) {
  EXPECT_GE(made(3000).probe->wall().count(), 120);
  EXPECT_LE(made(3000).probe->wall().count(), 150);
}

TEST_F(ProbeInPatient, force_grows_with_lift_also_where_the_lumen_bends_back_behind_the_tip) {
  PatientProbe& probe = *made(3000).probe;
  for (const double beyond : {0.0, 15.0, 25.0, 35.0}) {
    double last = -1e9;
    for (double lift = -4.0; lift <= 16.0; lift += 1.0) {
      const double force = probe.press(at(probe, beyond, lift)).force_N.y();
      EXPECT_GT(force, last) << "lift " << lift << " mm, array " << beyond << " mm above the middle of the gland";
      last = force;
    }
  }
}

TEST_F(ProbeInPatient, no_area_of_the_wall_is_deeper_in_the_probe_than_a_twentieth_of_a_millimetre) {
  PatientProbe& probe = *made(3000).probe;
  for (const double beyond : {0.0, 30.0}) {
    for (const double lift : {0.0, 4.0, 8.0, 12.0, 16.0}) {
      const ProbeSettings settings = at(probe, beyond, lift);
      EXPECT_LE(probe.press(settings).penetration_mm, 0.05);
      const Capsule capsule = capsule_of(probe.place(settings));
      for (int i = 0; i < probe.wall().count(); ++i) {
        const Vec3 place =
            probe.wall().points[static_cast<std::size_t>(i)].position_mm + probe.contact().displacement_of_point(i);
        EXPECT_GE(capsule.nearest(place).mm, -0.05);
      }
    }
  }
}

TEST_F(ProbeInPatient, gland_that_is_pressed_as_by_a_coil_widens_and_lengthens_as_published) {
  // 79 patients: AP −8.6 ± 7.8, LR +4.5 ± 5.8, SI +8.8 ± 6.9, volume +0.6 ± 5.7 % (Osman 2014).
  PatientProbe& probe = *made(3000).probe;
  GlandForm gland;
  for (double lift = 0.0; lift <= 25.0 && gland.change_percent.y() > -8.6; lift += 0.5) {
    probe.press(at(probe, kBeyondBase_mm, lift));
    gland = probe.gland();
  }
  EXPECT_NEAR(gland.change_percent.y(), -8.6, 0.5);
  EXPECT_GT(gland.change_percent.x(), 4.5 - 5.8);
  EXPECT_LT(gland.change_percent.x(), 4.5 + 5.8);
  EXPECT_GT(gland.change_percent.z(), 8.8 - 6.9);
  EXPECT_LT(gland.change_percent.z(), 8.8 + 6.9);
  EXPECT_LT(std::abs(gland.volume_percent), 3.0);
  EXPECT_LT(gland.shift_mm.y(), -0.5) << "to anterior";
}

TEST_F(ProbeInPatient, the_reference_of_the_contours_is_not_deformed) {
  const auto& demo = *made(3000).demo;
  ProbeSettings drawn = at(*made(3000).probe, 10.0, 6.0);
  drawn.in_contours = true;
  PatientProbe probe = PatientProbe::prepare(demo.patient(), drawn, "demo").value();
  probe.press(drawn);
  EXPECT_LT(probe.gland().change_percent.norm(), 1e-3);
  ProbeSettings moved = drawn;
  moved.lift_mm = 2.0;
  probe.press(moved);
  EXPECT_GT(probe.gland().change_percent.y(), 0.5) << "the gland regains its depth when the probe sinks";
  moved.lift_mm = 10.0;
  probe.press(moved);
  EXPECT_LT(probe.gland().change_percent.y(), -0.5);
}

TEST(ProbeOnBlocks, force_is_the_same_on_1700_5000_and_20000_nodes) {
  if (test::kSanitized) GTEST_SKIP() << test::kTooLongSanitized;
  const auto force = [](int cells, std::size_t least) {
    const testing::Block block = testing::soft_block(cells, 0.0);
    EXPECT_GE(block.tissue->mesh().nodes.size(), least);
    ProbeContact contact(block.wall(testing::reach_of(testing::lying_on(0.0), 2.5)));
    return contact.press(testing::lying_on(5.0)).force_N.z();
  };
  const double finest = force(33, 19000);
  EXPECT_NEAR(force(20, 4800) / finest, 1.0, 0.05);
  EXPECT_NEAR(force(14, 1700) / finest, 1.0, 0.05);
}

}  // namespace
}  // namespace stylet
