// SPDX-License-Identifier: GPL-3.0-or-later
// The map of the template's holes, made while a needle moves.
#include "map_maker.hpp"
#include "serving.hpp"

#include "stylet/sim/run.hpp"

#include <chrono>
#include <thread>

using namespace stylet;
using namespace stylet::serve;
using namespace stylet::test;

namespace {

/// The box with a template of two holes in front of its gland, and a fast and shallow insertion.
Scenario two_holes() {
  Scenario s = hole_scenario();
  s.grid.columns = {"D", "E"};
  s.grid.rows = {"4"};
  s.insertions[0].speed_mm_per_s = 80.0;
  return s;
}

PlanOfHole plans_of(const Scenario& scenario) {
  return [plan = scenario.insertions.front()](const std::string& hole) { return plan_through(plan, hole); };
}

/// Waits until a condition on the map holds, at most five minutes. @return the newest map
LiveMap when(MapMaker& maker, const std::function<bool(const LiveMap&)>& is_true) {
  LiveMap map;
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(5);
  while (std::chrono::steady_clock::now() < end) {
    if (auto news = maker.news()) map = std::move(*news);
    if (is_true(map)) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return map;
}

}  // namespace

TEST(MapMaker, has_clearances_at_once_and_predictions_when_they_are_wanted) {
  const Scenario scenario = two_holes();
  const auto model = compiled(scenario);
  MapMaker maker(model, plans_of(scenario));
  const LiveMap ways = when(maker, [](const LiveMap& m) { return m.map.has_value(); });
  ASSERT_TRUE(ways.map);
  ASSERT_EQ(ways.map->holes.size(), 2U);
  EXPECT_TRUE(ways.map->holes[0].clearance_mm[0]);
  EXPECT_FALSE(ways.map->holes[0].prediction);
  EXPECT_FALSE(ways.predicting);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FALSE(maker.news()) << "nothing is inserted that nobody has asked for";

  maker.want_predictions(true);
  const LiveMap whole = when(maker, [](const LiveMap& m) { return m.predicted == 2; });
  ASSERT_EQ(whole.predicted, 2);
  EXPECT_FALSE(whole.predicting) << "all are there";
  for (const HoleRow& row : whole.map->holes) {
    KnownTargets none;
    const auto alone = predict_hole(scenario, model->mesh(), plans_of(scenario)(row.hole), none);
    ASSERT_TRUE(row.prediction && alone);
    ASSERT_TRUE(row.prediction->tip_error_mm && alone->tip_error_mm);
    EXPECT_LT((*row.prediction->tip_error_mm - *alone->tip_error_mm).norm(), 1e-9) << "but for rounding";
  }
}

TEST(MapMaker, stops_between_reports_of_progress_and_goes_on_when_asked_again) {
  const Scenario scenario = two_holes();
  MapMaker maker(compiled(scenario), plans_of(scenario));
  when(maker, [](const LiveMap& m) { return m.map.has_value(); });
  maker.want_predictions(true);
  maker.want_predictions(false);
  const LiveMap stopped = when(maker, [](const LiveMap& m) { return !m.predicting; });
  EXPECT_FALSE(stopped.predicting);
  maker.want_predictions(true);
  EXPECT_EQ(when(maker, [](const LiveMap& m) { return m.predicted == 2; }).predicted, 2);
}

TEST(MapMaker, says_why_there_is_no_map) {
  TetMesh mesh = box_patient();
  mesh.regions[1] = "muscle";
  const Scenario scenario = two_holes();
  MapMaker maker(compiled(scenario, mesh), plans_of(scenario));
  const LiveMap none = when(maker, [](const LiveMap& m) { return !m.why_not.empty(); });
  EXPECT_SAYS(none.why_not, "the patient has no target");
  EXPECT_FALSE(none.map);
}

TEST(MapMaker, of_a_server_tells_every_page) {
  const Serving serving;
  const auto holder = ready_client(serving);
  ASSERT_TRUE(holder->until([&] { return holder->map.contains("map") && !holder->map["map"].is_null(); }));
  EXPECT_EQ(holder->map["map"]["planned"], "D4");
  EXPECT_EQ(holder->map["predicted"], 0);
  const auto watcher = ready_client(serving);
  ASSERT_TRUE(watcher->until([&] { return watcher->map.contains("map") && !watcher->map["map"].is_null(); }));
  watcher->command(R"({"do":"predict","on":1})");
  EXPECT_TRUE(watcher->until([&] { return !watcher->notices.empty(); })) << "it does not hold the needle";

  ASSERT_TRUE(holder->take());
  holder->command(R"({"do":"predict","on":1})");
  EXPECT_TRUE(watcher->until([&] {
    holder->read();  // a page that reads nothing loses its connection
    return watcher->map.value("predicted", 0) >= 1;
  }));
  const auto& holes = watcher->map["map"]["holes"];
  const auto planned = std::find_if(holes.begin(), holes.end(), [](const auto& h) { return h["hole"] == "D4"; });
  ASSERT_NE(planned, holes.end());
  EXPECT_EQ((*planned)["predicted"], true) << "the planned hole is the first";
  holder->command(R"({"do":"predict","on":0})");
  EXPECT_TRUE(holder->until([&] { return holder->map["predicting"] == false; }));

  // With another hole of the same patient the map stays; with another case it does not.
  holder->command(R"({"do":"hole","hole":"d4"})");
  ASSERT_TRUE(holder->until([&] { return holder->status.value("hole", "") == "d4"; }));
  EXPECT_GE(holder->map.value("predicted", 0), 1);
  holder->command(R"({"do":"case","index":1})");
  EXPECT_TRUE(holder->until([&] { return holder->scene["case"] == 1 && holder->map["predicted"] == 0; }));
}
