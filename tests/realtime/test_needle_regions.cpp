// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/needle_regions.hpp"

#include "sim/box_patient.hpp"
#include "stylet/sim/simulation.hpp"

using namespace stylet;
using namespace stylet::test;

namespace {

/// A needle in the box patient, and the names of the regions in which it is.
struct Watched {
  std::shared_ptr<const Model> model = compiled(box_scenario());
  Simulation simulation{model};
  const PlannedInsertion& plan = model->insertions()[0];
  Pose base = plan.motion.at(0.0);
  NeedleRegions regions;

  Watched() { simulation.place(base, plan.entry, plan.direction); }
  void move(double mm) {
    base.origin += mm * plan.direction;
    simulation.prepare();
    simulation.step(base, 4e-3);
    regions.follow(simulation.insertion());
  }
  void go_to(double depth_mm) {
    const double way = depth_mm - simulation.last_step().base_depth_mm;
    const int steps = static_cast<int>(std::ceil(std::abs(way) / 0.2));
    for (int k = 0; k < steps; ++k) move(way / steps);
  }
  [[nodiscard]] std::vector<std::string> inside() const {
    std::array<std::int16_t, 8> room{};
    const auto contacts = simulation.insertion().contacts();
    const std::size_t count = regions.now(simulation.insertion(), simulation.last_step().tip_state, contacts, room);
    std::vector<std::string> names;
    for (std::size_t k = 0; k < count; ++k) names.push_back(model->mesh().regions[static_cast<std::size_t>(room[k])]);
    return names;
  }
};

using Names = std::vector<std::string>;

}  // namespace

TEST(NeedleRegions, are_those_of_tip_and_shaft_on_the_way_in_and_out_and_in_again) {
  Watched needle;
  EXPECT_EQ(needle.inside(), Names{});
  needle.go_to(0.5);
  EXPECT_EQ(needle.inside(), Names{}) << "it presses on the skin";
  needle.go_to(14.0);
  EXPECT_EQ(needle.inside(), Names{"body"});
  needle.go_to(32.0);
  EXPECT_EQ(needle.inside(), (Names{"prostate", "body"}));
  needle.go_to(8.0);
  EXPECT_EQ(needle.inside(), Names{"body"}) << "drawn back out of the gland";
  needle.go_to(32.0);
  EXPECT_EQ(needle.inside(), (Names{"prostate", "body"})) << "again, in its track";
  needle.go_to(-8.0);
  EXPECT_EQ(needle.inside(), Names{}) << "out";
  needle.go_to(32.0);
  EXPECT_EQ(needle.inside(), (Names{"prostate", "body"})) << "in the track of before";
}
