// SPDX-License-Identifier: GPL-3.0-or-later
// An implant carried out over the live protocol.
#include "small_implant.hpp"
#include "stylet/implant/seed_fate.hpp"

#include <gtest/gtest.h>

using namespace stylet;
using namespace stylet::test;

namespace {

/// A page that holds the needle of a case with a plan.
struct Implanting {
  Serving serving;
  std::unique_ptr<LiveClient> page = ready_client(serving);

  explicit Implanting(const std::function<void(Scenario&)>& change = {})
      : serving([&](serve::ServerSettings& s) {
          s.session.cases = {implant_case(change), box_case("without")};
        }) {
    page->command(R"({"do":"take"})");
    EXPECT_TRUE(page->until([&] { return page->status.value("you_hold", false) && page->plan.contains("needles"); }));
  }
  [[nodiscard]] std::size_t dropped() const {
    return page->implant.contains("seeds") ? page->implant["seeds"].size() : 0;
  }
  [[nodiscard]] bool is_computed() const {
    return page->implant.contains("now") && !page->implant["now"].is_null() && !page->implant.value("computing", true);
  }
  bool go_to(double depth_mm) {
    page->hand(static_cast<float>(depth_mm), 80.0F);
    return page->until([&] { return std::abs(page->depth_mm - depth_mm) < 0.05; });
  }
  bool drop() {
    const std::size_t before = dropped();
    page->command(R"({"do":"drop"})");
    return page->until([&] { return dropped() == before + 1; });
  }
  [[nodiscard]] double drop_depth(std::size_t needle, std::size_t seed) const {
    return page->plan["needles"][needle]["seeds"][seed]["drop_depth_mm"];
  }
};

}  // namespace

TEST(LiveImplant, a_row_of_seeds_is_dropped_and_has_a_dose) {
  Implanting at;
  LiveClient& page = *at.page;
  EXPECT_EQ(page.plan["needles"].size(), 2u);
  EXPECT_EQ(page.plan["current"], 0);
  EXPECT_EQ(page.scene["insertions"].size(), 2u) << "the plan's needles are shown";
  EXPECT_EQ(page.status["insertion"], "left");
  for (std::size_t seed = 0; seed < 3; ++seed) {
    ASSERT_TRUE(at.go_to(at.drop_depth(0, seed)));
    ASSERT_TRUE(at.drop());
    const auto& last = page.implant["seeds"].back();
    EXPECT_TRUE(last["in_tissue"]);
    EXPECT_LT(last["error_mm"], 8.0);
    // The causes add up to the error.
    for (int axis = 0; axis < 3; ++axis) {
      double sum = 0.0;
      for (const auto& [cause, part] : last["why"].items()) sum += part[axis].get<double>();
      EXPECT_NEAR(sum, last["rest_mm"][axis].get<double>() - last["planned_mm"][axis].get<double>(), 0.01);
    }
    EXPECT_LT(std::abs(last["why"]["hand"][2].get<double>()), 0.3) << "the hand was at the planned depth";
  }
  ASSERT_TRUE(page.until([&] { return at.is_computed(); }));
  EXPECT_EQ(page.implant["now"]["seeds"], 3);
  EXPECT_GT(page.implant["now"]["d90_Gy"], 0.0);
  EXPECT_GT(page.implant["planned"]["d90_Gy"], page.implant["now"]["d90_Gy"]);
  ASSERT_TRUE(page.until([&] { return page.dose_points > 0; }));

  // Drawn out, the tissue goes back and takes the seeds along.
  ASSERT_TRUE(at.go_to(-5.0));
  ASSERT_TRUE(page.until([&] {
    for (std::size_t k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        const double rest = page.implant["seeds"][k]["rest_mm"][axis];
        if (std::abs(page.seeds["now_mm"][k][axis].get<double>() - rest) > 0.5) return false;
      }
    }
    return true;
  })) << page.seeds;

  // A fourth seed is not in this needle.
  page.command(R"({"do":"drop"})");
  EXPECT_SAYS(page.notice(), "all its 3 seeds");
}

TEST(LiveImplant, a_drop_in_air_is_refused_with_words) {
  Implanting at;
  at.page->command(R"({"do":"drop"})");
  EXPECT_SAYS(at.page->notice(), "not in the tissue");
  EXPECT_EQ(at.dropped(), 0u);
}

TEST(LiveImplant, what_is_foretold_of_a_seed_is_what_the_dropped_seed_has) {
  Implanting at;
  LiveClient& page = *at.page;
  EXPECT_TRUE(page.status["seed_off_mm"].is_null()) << "the tip is in the air";
  ASSERT_TRUE(at.go_to(at.drop_depth(0, 0)));
  const auto arrived = std::chrono::steady_clock::now();
  ASSERT_TRUE(page.until([&] {
    return std::chrono::steady_clock::now() - arrived > std::chrono::seconds(2) &&
           page.status["seed_off_mm"].is_number();
  }));
  const double foretold = page.status["seed_off_mm"];
  ASSERT_TRUE(at.drop());
  const auto& seed = page.implant["seeds"][0];
  double square = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double off = seed["rest_mm"][axis].get<double>() - seed["planned_mm"][axis].get<double>() -
                       seed["why"]["hand"][axis].get<double>();
    square += off * off;
  }
  EXPECT_NEAR(foretold, std::sqrt(square), 0.3) << "counted from a rigid straight needle on the same base";
}

TEST(LiveImplant, the_last_seed_can_be_taken_back) {
  Implanting at;
  LiveClient& page = *at.page;
  ASSERT_TRUE(at.go_to(at.drop_depth(0, 0)));
  ASSERT_TRUE(at.drop());
  page.command(R"({"do":"undo"})");
  ASSERT_TRUE(page.until([&] { return at.dropped() == 0 && at.is_computed(); }));
  EXPECT_EQ(page.implant["now"]["d90_Gy"], 0.0);
  page.command(R"({"do":"undo"})");
  EXPECT_SAYS(page.notice(), "no seed");
}

TEST(LiveImplant, another_needle_comes_at_once_and_the_seeds_stay) {
  Implanting at;
  LiveClient& page = *at.page;
  ASSERT_TRUE(at.go_to(at.drop_depth(0, 0)));
  ASSERT_TRUE(at.drop());
  const auto rest = page.implant["seeds"][0]["rest_mm"];
  ASSERT_TRUE(page.until([&] { return page.plan["needles"][1]["ready"].get<bool>(); })) << "compiled in the background";
  const auto asked = std::chrono::steady_clock::now();
  page.command(R"({"do":"needle","index":1})");
  bool was_loading = false;
  ASSERT_TRUE(page.until([&] {
    was_loading = was_loading || page.status.value("state", "") == "loading";
    return page.plan["current"] == 1 && page.status.value("insertion", "") == "right" && page.depth_mm < 0.0F;
  }));
  EXPECT_FALSE(was_loading);
  EXPECT_LT(std::chrono::steady_clock::now() - asked, std::chrono::seconds(5)) << "also under a sanitizer";
  EXPECT_EQ(page.implant["seeds"][0]["rest_mm"], rest);
  ASSERT_TRUE(at.go_to(at.drop_depth(1, 0)));
  ASSERT_TRUE(page.until([&] {  // the first seed is moved by the second needle
    const auto& now = page.seeds["now_mm"];
    return now.size() == 1 && std::abs(now[0][2].get<double>() - rest[2].get<double>()) > 0.05;
  }));
  ASSERT_TRUE(at.drop());
  EXPECT_EQ(page.implant["seeds"][1]["needle"], 1);
}

TEST(LiveImplant, a_case_without_a_plan_has_none) {
  Implanting at;
  LiveClient& page = *at.page;
  page.command(R"({"do":"case","index":1})");
  ASSERT_TRUE(page.until([&] {
    return page.plan["needles"].empty() && page.status.value("insertion", "") == "hole D4";
  })) << page.status;
  page.command(R"({"do":"drop"})");
  EXPECT_SAYS(page.notice(), "no plan");
}

TEST(LiveImplant, a_replay_has_the_seeds_of_each_moment_and_leaves_the_live_ones_as_they_are) {
  Implanting at;
  LiveClient& page = *at.page;
  ASSERT_TRUE(page.until([&] { return page.status.value("stage", "?").empty(); })) << "the displacements can be seen";
  ASSERT_TRUE(at.go_to(at.drop_depth(0, 0)));
  ASSERT_TRUE(page.until([&] { return page.displaced_nodes > 0; })) << "from now on the recording has frames";
  ASSERT_TRUE(at.drop());
  ASSERT_TRUE(page.until([&] { return at.is_computed(); }));
  const auto first = page.implant["seeds"][0];
  const double d90 = page.implant["now"]["d90_Gy"];
  ASSERT_TRUE(page.until([&] { return page.plan["needles"][1]["ready"].get<bool>(); }));
  page.command(R"({"do":"needle","index":1})");
  ASSERT_TRUE(page.until([&] { return page.plan["current"] == 1 && page.depth_mm < 0.0F; }));
  const std::string name = page.recording();
  ASSERT_TRUE(at.go_to(at.drop_depth(1, 0)));
  const double before_drop_s = page.time_s;
  ASSERT_TRUE(at.drop());
  ASSERT_TRUE(page.until([&] { return at.is_computed(); }));
  page.command(R"({"do":"undo"})");
  ASSERT_TRUE(page.until([&] { return at.dropped() == 1 && at.is_computed(); }));
  ASSERT_TRUE(at.drop());
  ASSERT_TRUE(page.until([&] { return at.is_computed(); }));
  const auto live_seeds = page.implant["seeds"];
  const auto live_now = page.implant["now"]["d90_Gy"];

  // Recordings are written to the disk five times a second.
  ASSERT_TRUE(page.until([&, until = page.time_s + 1.0] { return page.time_s > until; }));
  page.command(R"({"do":"replay","name":")" + name + R"("})");
  ASSERT_TRUE(
      page.until([&] { return page.status.value("mode", "") == "replay" && page.implant["seeds"].size() == 1; }));
  EXPECT_EQ(page.plan["current"], 1);
  EXPECT_EQ(page.plan["needles"].size(), 2u);
  EXPECT_EQ(page.implant["seeds"][0]["rest_mm"], first["rest_mm"]) << "the seed of the earlier needle";
  EXPECT_NEAR(page.implant["now"]["d90_Gy"].get<double>(), d90, 1e-9);
  const auto seek = [&](double time_s, std::size_t seeds) {
    page.command(R"({"do":"seek","time_s":)" + std::to_string(time_s) + "}");
    return page.until([&] {
      return std::abs(page.time_s - time_s) < 1e-3 && at.dropped() == seeds && page.seeds["now_mm"].size() == seeds;
    });
  };
  EXPECT_TRUE(seek(before_drop_s, 1)) << page.implant;
  // The earlier seed has moved with the tissue that the second needle pushes. Its place comes after the picture's time.
  EXPECT_TRUE(page.until([&] {
    return std::abs(page.seeds["now_mm"][0][2].get<double>() - first["rest_mm"][2].get<double>()) > 0.05;
  })) << page.seeds;
  EXPECT_TRUE(seek(page.status["replay"]["duration_s"], 2)) << page.implant;
  EXPECT_EQ(page.implant["seeds"], live_seeds);
  EXPECT_EQ(page.implant["now"]["d90_Gy"], live_now);
  page.command(R"({"do":"undo"})");
  EXPECT_SAYS(page.notice(), "recording");

  page.command(R"({"do":"live"})");
  ASSERT_TRUE(page.until([&] {
    return page.status.value("mode", "") == "live" && page.plan["needles"].size() == 2 && at.dropped() == 2 &&
           page.implant["now"].contains("goals") && !page.implant["now"]["goals"].empty();
  }));
  EXPECT_EQ(page.implant["seeds"], live_seeds);
}

TEST(LiveImplant, seeds_jump_at_their_release_by_the_numbers_of_stylet_implant) {
  const Scenario::Seed choice{.release_mm = 0.5, .release_sd_mm = 2.0, .random = 7};
  Implanting at([&](Scenario& scenario) { scenario.seed = choice; });
  LiveClient& page = *at.page;
  std::vector<SeedHistory> expected(3);
  settle_seeds(expected, choice, 0);
  const auto jump = [&](std::size_t seed) {
    const auto& of = page.implant["seeds"][seed];
    double along = 0.0;
    for (int axis = 0; axis < 3; ++axis)
      along += of["axis"][axis].get<double>() * of["why"]["release"][axis].get<double>();
    return along;
  };
  for (std::size_t seed = 0; seed < 3; ++seed) {
    ASSERT_TRUE(at.go_to(at.drop_depth(0, seed)));
    ASSERT_TRUE(at.drop());
    EXPECT_NEAR(jump(seed), expected[seed].by(SeedCause::release).z(), 0.01);
  }
  EXPECT_NEAR(jump(0), expected[0].by(SeedCause::release).z(), 0.01) << "a later seed does not change it";
  // Taken back and dropped again, the seed jumps by the same number.
  page.command(R"({"do":"undo"})");
  ASSERT_TRUE(page.until([&] { return at.dropped() == 2; }));
  ASSERT_TRUE(at.drop());
  EXPECT_NEAR(jump(2), expected[2].by(SeedCause::release).z(), 0.01);
  bool is_said = false;
  for (const auto& why : page.implant["why"]) is_said = is_said || (why["cause"] == "release" && why["mean_mm"] > 0.0);
  EXPECT_TRUE(is_said) << page.implant["why"];
}

TEST(LiveImplant, a_strand_keeps_its_spacing_and_a_recording_has_it) {
  Implanting at([](Scenario& scenario) { scenario.seed.stranded = true; });
  LiveClient& page = *at.page;
  for (const double beside_mm : {0.0, 2.0, -1.0}) {
    ASSERT_TRUE(at.go_to(at.drop_depth(0, at.dropped()) + beside_mm));
    ASSERT_TRUE(at.drop());
  }
  const auto rest = [&](std::size_t seed) {
    const auto& x = page.implant["seeds"][seed]["rest_mm"];
    return Vec3(x[0], x[1], x[2]);
  };
  const auto planned = [&](std::size_t seed) {
    const auto& x = page.implant["seeds"][seed]["planned_mm"];
    return Vec3(x[0], x[1], x[2]);
  };
  for (std::size_t seed = 1; seed < 3; ++seed)
    EXPECT_NEAR((rest(seed) - rest(seed - 1)).norm(), (planned(seed) - planned(seed - 1)).norm(), 0.15);
  ASSERT_TRUE(page.until([&, until = page.time_s + 1.0] { return page.time_s > until; }));
  const auto live = page.implant["seeds"];
  page.command(R"({"do":"replay","name":")" + page.recording() + R"("})");
  ASSERT_TRUE(page.until([&] { return page.status.value("mode", "") == "replay"; }));
  page.command(R"({"do":"seek","time_s":1000})");
  ASSERT_TRUE(page.until([&] { return at.dropped() == 3; }));
  EXPECT_EQ(page.implant["seeds"], live) << "also those that the strand has moved";
}

TEST(LiveImplant, a_lost_seed_is_said_in_words_and_gives_no_dose) {
  Implanting at([](Scenario& scenario) { scenario.seed.loss_percent = 100.0; });
  LiveClient& page = *at.page;
  ASSERT_TRUE(at.go_to(at.drop_depth(0, 0)));
  ASSERT_TRUE(at.drop());
  EXPECT_TRUE(page.implant["seeds"][0]["lost"]);
  ASSERT_TRUE(page.until([&] { return at.is_computed() && !page.notices.empty(); }));
  EXPECT_EQ(page.implant["now"]["d90_Gy"], 0.0);
  EXPECT_NE(page.notices.back()["text"].get<std::string>().find("Seed 1 of needle left is lost"), std::string::npos);
}

TEST(LiveImplant, a_preloaded_needle_leaves_its_train_where_it_was_held_as_it_is_drawn_back) {
  Implanting at([](Scenario& scenario) { scenario.procedure.technique = SeedTechnique::preloaded; });
  LiveClient& page = *at.page;
  EXPECT_EQ(page.plan["technique"], "preloaded");
  const double plane_mm = page.plan["needles"][0]["depth_mm"];
  ASSERT_TRUE(at.go_to(plane_mm));
  page.command(R"({"do":"drop"})");
  ASSERT_TRUE(page.until([&] { return !page.implant["train_from_mm"].is_null(); }));
  EXPECT_NEAR(page.implant["train_from_mm"], plane_mm, 0.1);
  EXPECT_EQ(at.dropped(), 0u) << "nothing is left while the needle rests";
  page.command(R"({"do":"drop"})");
  EXPECT_SAYS(page.notice(), "left already");
  // Each seed is left when the tip has passed it.
  ASSERT_TRUE(at.go_to(at.drop_depth(0, 0) - 2.0));
  ASSERT_TRUE(page.until([&] { return at.dropped() == 1; }));
  ASSERT_TRUE(at.go_to(at.drop_depth(0, 2) - 2.0));
  ASSERT_TRUE(page.until([&] { return at.dropped() == 3 && page.implant["train_from_mm"].is_null(); }));
  double first_superior = 0.0;
  for (std::size_t seed = 0; seed < 3; ++seed) {
    const auto& of = page.implant["seeds"][seed];
    EXPECT_TRUE(of["in_tissue"]);
    EXPECT_LT(std::abs(of["why"]["hand"][2].get<double>()), 0.1) << "the train was at its planned place";
    EXPECT_NEAR(of["dropped_mm"][2].get<double>(), of["planned_mm"][2].get<double>(), 0.3);
    const double off = of["rest_mm"][2].get<double>() - of["planned_mm"][2].get<double>();
    if (seed == 0) first_superior = off;
    if (seed == 2) {
      EXPECT_GT(off, first_superior) << "the cannula drags the tissue to inferior on its way out";
    }
  }
  // The train is taken back as a whole.
  page.command(R"({"do":"undo"})");
  ASSERT_TRUE(page.until([&] { return at.dropped() == 0; }));
  // A train that has been begun can be called off.
  ASSERT_TRUE(at.go_to(plane_mm));
  page.command(R"({"do":"drop"})");
  ASSERT_TRUE(page.until([&] { return !page.implant["train_from_mm"].is_null(); }));
  page.command(R"({"do":"undo"})");
  ASSERT_TRUE(page.until([&] { return page.implant["train_from_mm"].is_null(); }));
  ASSERT_TRUE(at.go_to(0.0));
  EXPECT_EQ(at.dropped(), 0u);
}
