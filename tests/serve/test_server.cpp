// SPDX-License-Identifier: GPL-3.0-or-later
// The server with real connections over the loopback interface, as docs/live_protocol.md describes it.
#include "serving.hpp"

#include "stylet/io/recording_io.hpp"
#include "stylet/io/scenario_io.hpp"
#include "stylet/sim/recorded_steps.hpp"
#include "support/value_of.hpp"

#include <sys/stat.h>

#include <atomic>
#include <bit>
#include <mutex>
#include <thread>

using namespace stylet;
using namespace stylet::test;

namespace {

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

}  // namespace

TEST(Server, a_hand_at_a_page_pushes_the_needle_in_and_sees_force_and_events) {
  const Serving serving;
  const auto client = ready_client(serving);
  EXPECT_EQ(client->scene["protocol"], 4);
  EXPECT_EQ(client->scene["cases"], nlohmann::json({"first", "second"}));
  EXPECT_EQ(client->scene["insertions"][0]["hole"], "D4");
  EXPECT_LT(client->depth_mm, 0.0F) << "before the skin";
  ASSERT_TRUE(client->take());
  ASSERT_TRUE(client->go_to(28.0F, 60.0F));
  EXPECT_TRUE(client->has_event("skin_contact"));
  EXPECT_TRUE(client->has_event("puncture"));
  EXPECT_GT(client->most_N, 0.1F);
  ASSERT_TRUE(client->until([&] { return client->displaced_nodes > 0; }));
  EXPECT_EQ(client->displaced_nodes, client->scene_nodes);
  client->hand(-5.0F, 100.0F);
  ASSERT_TRUE(client->until([&] { return client->has_event("withdrawn"); }));
}

TEST(Server, only_who_holds_the_needle_moves_it_and_it_changes_hands) {
  const Serving serving;
  const auto first = ready_client(serving);
  const auto second = ready_client(serving);
  ASSERT_TRUE(first->take());
  second->hand(20.0F, 100.0F);
  second->command(R"({"do":"pause"})");
  ASSERT_TRUE(second->until([&] { return !second->notices.empty(); })) << "is told why not";
  ASSERT_TRUE(second->passes(0.2)) << "no pause";
  EXPECT_LT(second->depth_mm, 0.0F);
  second->command(R"({"do":"take"})");
  ASSERT_TRUE(first->until([&] { return first->status.value("asking", 0) == 1; }));
  first->command(R"({"do":"release"})");
  ASSERT_TRUE(second->until([&] { return second->status.value("you_hold", false); }));
  ASSERT_TRUE(second->go_to(5.0F, 100.0F));
}

TEST(Server, the_needle_rests_when_its_holder_goes) {
  const Serving serving;
  auto holder = ready_client(serving);
  const auto watcher = ready_client(serving);
  ASSERT_TRUE(holder->take());
  ASSERT_TRUE(watcher->until([&] { return watcher->status.value("held", false); }));
  holder->hand(100.0F, 5.0F);
  ASSERT_TRUE(holder->until([&] { return holder->depth_mm > 0.0F; }));
  holder.reset();
  ASSERT_TRUE(watcher->until([&] { return !watcher->status.value("held", true); }));
  // The first pictures may be old: they have waited until this page, which was not read meanwhile, took them up.
  ASSERT_TRUE(watcher->until([&, before = watcher->frames] { return watcher->frames > before + 3; }));
  double then = watcher->time_s;
  ASSERT_TRUE(watcher->until([&] { return watcher->time_s > then + 0.1; }));
  const float there = watcher->depth_mm;
  then = watcher->time_s;
  ASSERT_TRUE(watcher->until([&] { return watcher->time_s > then + 0.3; }));
  EXPECT_EQ(watcher->depth_mm, there);
}

TEST(Server, let_go_of_a_push_the_base_stands_and_has_not_turned_back) {
  const Serving serving;
  const auto client = ready_client(serving);
  client->command(R"({"do":"take"})");
  client->hand(25.0F, 40.0F);
  ASSERT_TRUE(client->until([&] { return client->depth_mm > 12.0F; }));
  client->hand(client->depth_mm - 1.0F, 0.0F);  // a depth that a page has seen some time ago
  float deepest = client->depth_mm;
  const double then = client->time_s;
  ASSERT_TRUE(client->until([&] {
    EXPECT_GE(client->depth_mm, deepest) << "it turned back";
    deepest = std::max(deepest, client->depth_mm);
    return client->time_s > then + 0.5;
  }));
  EXPECT_LT(deepest, 25.0F);
  EXPECT_FALSE(client->has_event("retraction_start"));
  client->hand(5.0F, 40.0F);  // with a speed, a smaller depth is a pull
  EXPECT_TRUE(client->until([&] { return client->has_event("retraction_start"); }));
}

TEST(Server, a_replay_leaves_the_live_needle_as_it_was) {
  const Serving serving;
  const auto client = ready_client(serving);
  client->command(R"({"do":"take"})");
  ASSERT_TRUE(client->go_to(15.0F, 80.0F));
  const std::string first = client->recording();
  const auto kinds = [&] {  // kinds of the events of this insertion
    std::vector<std::string> names;
    for (const auto& event : client->events) {
      if (event["kind"] == "started") names.clear();
      names.push_back(event["kind"]);
    }
    return names;
  };
  client->events.clear();
  client->command(R"({"do":"reset"})");
  ASSERT_TRUE(client->until([&] { return client->recording() != first; }));
  client->hand(22.0F, 80.0F);
  ASSERT_TRUE(client->until([&] { return client->depth_mm > 21.9F && kinds().size() > 1; }));
  ASSERT_TRUE(client->passes(0.2));
  const std::string name = client->recording();
  const double stood_at = client->time_s;
  const float force = client->force_N;
  const std::vector<std::string> before = kinds();

  ASSERT_TRUE(client->replay(first));
  client->hand(0.0F, 80.0F);  // ignored, because this viewer does not hold the needle
  client->events.clear();
  ASSERT_TRUE(client->back_to_live());
  EXPECT_NEAR(client->depth_mm, 22.0F, 1e-3F);
  EXPECT_NEAR(client->force_N, force, 0.05F);
  EXPECT_GE(client->time_s, stood_at) << "its time goes on";
  EXPECT_LT(client->time_s, stood_at + 5.0) << "and did not while it was away";
  EXPECT_EQ(client->recording(), name) << "the same recording";
  EXPECT_GT(client->samples, 50u) << "the whole curve";
  EXPECT_EQ(kinds(), before);
  const double back_at = client->time_s;
  ASSERT_TRUE(client->until([&] { return client->time_s > back_at + 0.3; })) << "it runs";
  EXPECT_NEAR(client->depth_mm, 22.0F, 1e-3F) << "without a hand it stays";
  ASSERT_TRUE(client->go_to(26.0F, 80.0F));
  serving.server->stop();

  const auto run = value_of(read_recording(serving.folder.path / name / "run.h5"));
  double time = 0.0;
  const RecordedSteps steps(run.steps);
  for (std::int64_t k = 0; k < steps.count(); ++k) {
    const Step step = steps.at(k);
    ASSERT_NEAR(step.time_s, time + step.dt_s, 1e-9) << "a gap in the recording";
    time = step.time_s;
  }
  EXPECT_NEAR(run.steps.back().base_depth_mm, 26.0, 0.2);
  EXPECT_GT(time, back_at);
}

TEST(Server, a_case_that_cannot_be_loaded_leaves_needle_and_replay_as_they_were) {
  const Serving serving([](serve::ServerSettings& s) {
    s.session.cases.push_back({"broken", [](const Progress&) {
                                 std::this_thread::sleep_for(std::chrono::milliseconds(300));
                                 return Result<serve::LoadedCase>(input_error("case.toml", "it is broken", "Mend it"));
                               }});
  });
  const auto client = ready_client(serving);
  client->command(R"({"do":"take"})");
  const std::string first = client->recording();
  ASSERT_TRUE(client->go_to(5.0F, 80.0F));
  client->command(R"({"do":"reset"})");
  ASSERT_TRUE(client->until([&] { return client->recording() != first; }));
  client->hand(15.0F, 80.0F);
  ASSERT_TRUE(client->until([&] { return client->depth_mm > 14.9995F; }));
  const std::string name = client->recording();
  const std::uint32_t scenes = client->scenes;
  const auto goes_on = [&] {
    const double then = client->time_s;
    ASSERT_TRUE(client->until([&] { return client->ready() && client->time_s > then + 0.2; }));
    EXPECT_NEAR(client->depth_mm, 15.0F, 1e-3F);
    EXPECT_EQ(client->recording(), name);
  };

  client->command(R"({"do":"case","index":2})");
  EXPECT_SAYS(client->notice(1), "it is broken");
  goes_on();
  EXPECT_EQ(client->scenes, scenes) << "nothing else was shown";

  ASSERT_TRUE(client->replay(first));
  client->command(R"({"do":"play","rate":0.1})");
  ASSERT_TRUE(client->until([&] { return client->time_s > 0.0 && client->status["replay"]["playing"] == true; }));
  const double shown_s = client->time_s;
  client->command(R"({"do":"case","index":2})");
  ASSERT_TRUE(client->until([&] { return client->notices.size() == 2 && client->ready(); }));
  EXPECT_EQ(client->status["mode"], "replay");
  EXPECT_EQ(client->status["replay"]["name"], first);
  EXPECT_EQ(client->status["replay"]["playing"], true);
  ASSERT_TRUE(client->until([&] { return client->time_s > shown_s; })) << "it goes on";
  ASSERT_TRUE(client->back_to_live());
  goes_on();
  ASSERT_TRUE(client->go_to(18.0F, 80.0F));
}

TEST(Server, says_in_which_regions_the_needle_is) {
  const Serving serving;
  const auto client = ready_client(serving);
  client->command(R"({"do":"take"})");
  EXPECT_EQ(client->status["inside"], nlohmann::json::array());
  client->hand(28.0F, 80.0F);
  ASSERT_TRUE(client->until([&] { return client->status["inside"] == nlohmann::json({"prostate", "body"}); }));
  client->hand(-5.0F, 80.0F);
  ASSERT_TRUE(client->until([&] { return client->status["inside"].empty(); }));
  for (const auto& region : client->scene["regions"]) EXPECT_EQ(region["spared"], false) << region;
}

TEST(Server, another_hole_another_case_and_back_to_the_start) {
  const Serving serving;
  const auto client = ready_client(serving);
  client->command(R"({"do":"take"})");
  client->command(R"({"do":"hole","hole":"E3.5"})");
  ASSERT_TRUE(client->until([&] { return client->status.value("hole", "") == "E3.5" && client->ready(); }));
  EXPECT_EQ(client->scene["insertions"][0]["hole"], "D4") << "what the case plans stays known";
  client->command(R"({"do":"hole","hole":"Z9"})");
  ASSERT_TRUE(client->until([&] { return client->notices.size() == 1; })) << "no such hole";
  EXPECT_NE(client->notices[0]["text"].get<std::string>().find("Z9"), std::string::npos);
  client->command(R"({"do":"hole","hole":"A1"})");
  ASSERT_TRUE(client->until([&] { return client->notices.size() == 2; })) << "it misses the patient";
  ASSERT_TRUE(client->go_to(10.0F, 100.0F)) << "the one before goes on";
  client->command(R"({"do":"reset"})");
  ASSERT_TRUE(client->until([&] { return client->depth_mm < 0.0F; }));
  client->command(R"({"do":"case","index":1})");
  ASSERT_TRUE(client->until([&] { return client->scene["case"] == 1; }));
  client->command(R"({"do":"case","index":7})");
  ASSERT_TRUE(client->until([&] { return client->notices.size() == 3; }));
}

TEST(Server, needles_that_stay_do_so_through_each_hole_but_their_own) {
  Scenario scenario = hole_scenario();
  scenario.procedure.stabilising = {"C3"};
  const Serving serving([&](serve::ServerSettings& s) { s.session.cases = {box_case("beside a needle", scenario)}; });
  const auto client = ready_client(serving);
  EXPECT_EQ(client->scene["stabilising"], nlohmann::json({"C3"}));
  client->command(R"({"do":"take"})");
  client->command(R"({"do":"hole","hole":"C3"})");
  ASSERT_TRUE(client->until([&] { return client->notices.size() == 1; })) << "a needle is in it";
  EXPECT_NE(client->notices[0]["text"].get<std::string>().find("is taken"), std::string::npos);
  client->command(R"({"do":"hole","hole":"E3.5"})");
  ASSERT_TRUE(client->until([&] { return client->status.value("hole", "") == "E3.5" && client->ready(); }));
  ASSERT_TRUE(client->go_to(10.0F, 100.0F));
  EXPECT_EQ(client->resting, 1u);
}

TEST(Server, a_recording_replays_in_the_page_and_repeats_to_the_last_bit) {
  Serving serving;
  const auto client = ready_client(serving);
  client->command(R"({"do":"take"})");
  ASSERT_TRUE(client->go_to(25.0F, 80.0F));
  ASSERT_TRUE(client->go_to(10.0F, 80.0F));
  const double rests_from = client->time_s + 0.2;
  ASSERT_TRUE(client->until([&] { return client->time_s > rests_from + 1.0; }));
  ASSERT_TRUE(client->go_to(8.0F, 80.0F));
  const std::string name = client->recording();
  client->command(R"({"do":"reset"})");  // completes the recording
  ASSERT_TRUE(client->until([&] { return client->recording() != name; }));

  const auto csv = get(serving.port(), "/recordings/" + name + "/forces.csv");
  EXPECT_EQ(csv.result(), http::status::ok);
  EXPECT_EQ(csv.body().substr(0, 6), "time_s");

  ASSERT_TRUE(client->replay(name));
  EXPECT_GT(client->samples, 100u) << "the whole curve";
  const double duration = client->status["replay"]["duration_s"];
  client->command(R"({"do":"seek","time_s":)" + std::to_string(0.5 * duration) + "}");
  ASSERT_TRUE(client->until([&] { return std::abs(client->time_s - 0.5 * duration) < 1e-5; }));
  client->command(R"({"do":"play","rate":20})");
  ASSERT_TRUE(client->until([&] { return client->time_s >= duration - 1e-9; }));
  ASSERT_TRUE(client->back_to_live());
  serving.server->stop();

  const auto run = value_of(read_recording(serving.folder.path / name / "run.h5"));
  ASSERT_GT(run.steps.size(), 100u);
  EXPECT_FALSE(run.frames.empty());
  EXPECT_FALSE(run.events.empty());
  // Of a rest only its end is recorded. Steps of another duration do not count as equal.
  int at_rest = 0;
  for (const Frame& frame : run.frames) at_rest += frame.time_s > rests_from && frame.time_s < rests_from + 0.9 ? 1 : 0;
  EXPECT_LE(at_rest, 1);
  std::int64_t rest = 0;
  for (const Step& step : run.steps) rest = std::max(rest, step.rest_steps);
  EXPECT_GT(rest, 20) << "steps at rest are only counted";
  const auto scenario = value_of(parse_scenario(run.info.scenario_text, "recording"));
  Kept kept;
  const auto again = run_recorded(compiled(scenario, run.mesh), run.steps, kept);
  ASSERT_TRUE(again.ok()) << again.error().message();
  const RecordedSteps recorded(run.steps);
  ASSERT_EQ(static_cast<std::int64_t>(kept.steps.size()), recorded.count());
  for (std::size_t k = 0; k < kept.steps.size(); ++k) {
    const Step a = recorded.at(static_cast<std::int64_t>(k));
    const Step& b = kept.steps[k];
    ASSERT_TRUE(same_bits(a.time_s, b.time_s));
    if (!recorded.is_recorded(static_cast<std::int64_t>(k))) {
      ASSERT_TRUE(is_at_rest(a, b)) << "step " << k << " of " << kept.steps.size();
      continue;
    }
    ASSERT_TRUE(same_bits(a.force_axial_N, b.force_axial_N) && same_bits(a.force_lateral_N, b.force_lateral_N) &&
                same_bits(a.force_sagittal_N, b.force_sagittal_N) && same_bits(a.torque_Nmm.x(), b.torque_Nmm.x()) &&
                same_bits(a.torque_Nmm.y(), b.torque_Nmm.y()) && same_bits(a.torque_Nmm.z(), b.torque_Nmm.z()))
        << "step " << k << " of " << kept.steps.size();
  }
}

TEST(Server, malformed_messages_are_dropped_and_counted) {
  const Serving serving;
  const auto client = ready_client(serving);
  for (int k = 0; k < 10; ++k) client->send("nonsense", 8);
  client->command("{");
  ASSERT_TRUE(client->until([&] { return client->status.value("dropped_messages", 0) == 11; }));
  EXPECT_TRUE(client->take()) << "still heard";
}

TEST(Server, a_message_too_long_or_a_flood_ends_the_connection_and_nothing_else) {
  const Serving serving;
  const auto good = ready_client(serving);
  const auto ends = [](const std::function<void()>& talk) {
    try {
      talk();
    } catch (const boost::system::system_error&) {
      return true;
    }
    return false;
  };
  LiveClient wordy(serving.port());
  const std::string much(2000, 'x');
  EXPECT_TRUE(ends([&] {
    wordy.send(much.data(), much.size());
    for (int k = 0; k < 100000; ++k) wordy.read();
  }));
  LiveClient flood(serving.port());
  EXPECT_TRUE(ends([&] {
    for (int k = 0; k < 1'000'000; ++k) flood.send("nonsense", 8);
  }));
  EXPECT_TRUE(good->passes(0.2));
}

TEST(Server, a_viewer_that_does_not_read_loses_pictures_and_keeps_nobody_waiting) {
  const Serving serving;
  const auto reader = ready_client(serving);
  ASSERT_TRUE(reader->take());
  LiveClient sleeper(serving.port());  // reads nothing for a while
  const std::uint32_t before = reader->frames;
  for (bool in = true; reader->frames < before + 100; in = !in) ASSERT_TRUE(reader->go_to(in ? 15.0F : 0.0F, 60.0F));
  ASSERT_TRUE(sleeper.until([&] { return sleeper.ready(); }));
  const double now = reader->time_s;
  EXPECT_TRUE(sleeper.until([&] { return sleeper.time_s >= now; }));
}

TEST(Server, a_page_that_takes_nothing_up_gets_all_states_and_no_more_pictures_than_the_bound) {
  const Serving serving;
  const auto holder = ready_client(serving);
  ASSERT_TRUE(holder->take());
  LiveClient idle(serving.port());
  ASSERT_TRUE(idle.until([&] { return idle.ready(); }));
  idle.answers = false;
  std::atomic<bool> ends{false};
  std::thread moves([&] {
    for (bool in = true; !ends; in = !in) {
      if (!holder->go_to(in ? 25.0F : 0.0F, 60.0F)) return;
    }
  });
  const auto hears_states = [&](std::uint32_t count) {
    const std::uint32_t others = idle.received - idle.frames;
    return idle.until([&] { return idle.received - idle.frames > others + count; });
  };
  EXPECT_TRUE(hears_states(10));
  const std::uint32_t before = idle.frames;
  EXPECT_TRUE(hears_states(4));
  EXPECT_EQ(idle.frames, before) << "what is under way is bounded";
  const double then = idle.time_s;
  idle.seen(idle.received - 1);
  EXPECT_TRUE(idle.until([&] { return idle.frames > before; }));
  EXPECT_GT(idle.time_s, then + 0.2) << "the newest picture, ten and more after the next";
  EXPECT_TRUE(idle.until([&] { return idle.status["lag_s"].is_number() && idle.status["lag_s"] > 0.5; }));
  ends = true;
  moves.join();
}

TEST(Server, a_needle_at_rest_costs_little_in_front_of_the_skin_and_in_the_tissue) {
  const Serving serving;
  const auto client = ready_client(serving);
  ASSERT_TRUE(client->take());
  for (const float depth_mm : {-3.0F, 20.0F}) {
    ASSERT_TRUE(client->go_to(depth_mm));
    ASSERT_TRUE(client->passes(1.0)) << "it comes to rest";
    const auto begun = std::chrono::steady_clock::now();
    const std::size_t before = client->received_bytes;
    ASSERT_TRUE(client->passes(2.0));
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begun;
    EXPECT_LE(static_cast<double>(client->received_bytes - before), 50e3 * seconds.count()) << depth_mm;
  }
}

TEST(Server, stops_the_needle_of_a_holder_who_falls_silent_and_lets_it_go_on) {
  const Serving serving([](serve::ServerSettings& s) { s.hand_silence_s = 0.8; });
  const auto holder = ready_client(serving);
  const auto watcher = ready_client(serving);
  ASSERT_TRUE(holder->take());
  holder->hand(100.0F, 10.0F);
  const auto stands = [&] {  // its depth after it has stood for a while
    float depth_mm = watcher->depth_mm;
    double since_s = watcher->time_s;
    EXPECT_TRUE(watcher->until([&] {
      if (watcher->depth_mm != depth_mm) since_s = watcher->time_s;
      depth_mm = watcher->depth_mm;
      return watcher->time_s > since_s + 0.5;
    }));
    return depth_mm;
  };
  ASSERT_TRUE(watcher->until([&] { return watcher->depth_mm > 1.0F; }));  // nobody reads what the holder gets
  const float there = stands();
  EXPECT_LT(there, 90.0F);
  holder->hand(100.0F, 10.0F);  // as from a page whose messages have been under way for long
  EXPECT_EQ(stands(), there) << "the page does not know yet that its hand was stopped";
  EXPECT_FALSE(watcher->has_event("retraction_start"));
  EXPECT_TRUE(watcher->status.value("held", false)) << "it still holds the needle";
  ASSERT_TRUE(holder->until([&] { return holder->status.value("hand_stopped", false); }));
  ASSERT_TRUE(holder->until([&] { return !holder->status.value("hand_stopped", true); }));
  ASSERT_TRUE(holder->go_to(there + 2.0F));
}

TEST(Server, tells_the_connection_one_too_many_and_lets_it_in_later) {
  const Serving serving([](serve::ServerSettings& s) { s.connections_per_address = 3; });
  boost::asio::io_context io;
  std::vector<tcp::socket> silent;
  for (int k = 0; k < 3; ++k) silent.push_back(connected(io, serving.port()));
  const auto refused = get(serving.port(), "/");
  EXPECT_EQ(refused.result(), http::status::service_unavailable);
  EXPECT_NE(refused.body().find("too many connections"), std::string::npos);
  silent.clear();
  auto status = http::status::unknown;
  for (int k = 0; k < 1000 && status != http::status::ok; ++k) {
    status = get(serving.port(), "/").result();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(status, http::status::ok);
}

TEST(Server, tells_the_viewer_one_too_many) {
  const Serving serving([](serve::ServerSettings& s) { s.viewers = 1; });
  const auto client = ready_client(serving);
  EXPECT_THROW(LiveClient second(serving.port()), boost::system::system_error);
  const auto refused = get(serving.port(), "/live");
  EXPECT_EQ(refused.result(), http::status::service_unavailable);
  EXPECT_NE(refused.body().find("too many viewers"), std::string::npos);
}

TEST(Server, gives_a_recording_whose_name_has_quotes) {
  const Serving serving;
  const auto client = ready_client(serving);
  ASSERT_TRUE(client->take());
  ASSERT_TRUE(client->passes(0.1));
  const std::string name = client->recording();
  client->command(R"({"do":"reset"})");
  ASSERT_TRUE(client->until([&] { return client->recording() != name; }));
  std::filesystem::rename(serving.folder.path / name, serving.folder.path / "a\"; b=\"c");
  const auto curve = get(serving.port(), "/recordings/a%22%3B%20b%3D%22c/forces.csv");
  ASSERT_EQ(curve.result(), http::status::ok);
  EXPECT_EQ(curve[http::field::content_disposition],
            "attachment; filename=\"a__ b__c.csv\"; filename*=UTF-8''a%22%3B%20b%3D%22c.csv");
}

TEST(Server, the_page_is_for_this_machine_and_its_own_origin) {
  const Serving serving;
  const std::string host = "localhost:" + std::to_string(serving.port());
  EXPECT_EQ(get(serving.port(), "/", host).result(), http::status::ok);
  EXPECT_EQ(get(serving.port(), "/live.js", host).result(), http::status::ok);
  EXPECT_EQ(get(serving.port(), "/live.css", host).result(), http::status::ok);
  EXPECT_EQ(get(serving.port(), "/", "evil.example").result(), http::status::forbidden);
  EXPECT_EQ(get(serving.port(), "/recordings", host, "http://evil.example").result(), http::status::forbidden);
  EXPECT_EQ(get(serving.port(), "/recordings", host, "http://" + host).result(), http::status::ok);
  EXPECT_EQ(get(serving.port(), "/recordings/../../etc/passwd", host).result(), http::status::not_found);
  EXPECT_EQ(get(serving.port(), "/recordings/..%2f/forces.csv", host).result(), http::status::not_found);
  EXPECT_EQ(get(serving.port(), "/nothing", host).result(), http::status::not_found);
}

TEST(Server, asks_also_on_this_machine_for_the_token) {
  const Serving serving([](serve::ServerSettings& s) {
    s.asks_for_token = true;
    s.token = "0123";
  });
  EXPECT_EQ(get(serving.port(), "/").result(), http::status::ok) << "the page itself holds nothing of anybody";
  EXPECT_EQ(get(serving.port(), "/recordings").result(), http::status::unauthorized);
  EXPECT_EQ(get(serving.port(), "/recordings?token=0124").result(), http::status::unauthorized);
  EXPECT_EQ(get(serving.port(), "/recordings?token=0123").result(), http::status::ok);
  EXPECT_THROW(LiveClient client(serving.port()), boost::system::system_error);
  EXPECT_THROW(LiveClient client(serving.port(), "/live?token=0124"), boost::system::system_error);
  LiveClient client(serving.port(), "/live?token=0123");
  EXPECT_TRUE(client.until([&] { return client.ready(); }));
  EXPECT_NE(serving.server->url().find("token=0123"), std::string::npos);
}

TEST(Server, makes_a_token_and_keeps_it_for_the_next_start) {
  const auto token_with = [&](const std::filesystem::path& file) {
    const Serving serving([&](serve::ServerSettings& s) {
      s.asks_for_token = true;
      s.token_file = file;
    });
    EXPECT_EQ(get(serving.port(), "/recordings").result(), http::status::unauthorized);
    const std::string url = serving.server->url();
    const std::string token = url.substr(url.find("?token=") + 7);
    EXPECT_EQ(token.size(), 32u);
    EXPECT_EQ(get(serving.port(), "/recordings?token=" + token).result(), http::status::ok);
    return token;
  };
  const std::string first = token_with("");
  EXPECT_NE(token_with(""), first);
  const auto file = std::filesystem::temp_directory_path() / ("stylet-token-" + std::to_string(::getpid()));
  const std::string kept = token_with(file);
  EXPECT_EQ(token_with(file), kept);
  std::filesystem::remove(file);
}

TEST(Server, a_holder_who_does_not_answer_any_more_loses_the_needle) {
  const Serving serving([](serve::ServerSettings& s) { s.silence_s = 1.0; });
  const auto watcher = ready_client(serving);
  const auto holder = ready_client(serving);
  ASSERT_TRUE(holder->take());
  holder->hand(100.0F, 1.0F);
  // From here on the holder reads nothing and so answers no ping, while its connection stays open.
  ASSERT_TRUE(watcher->until([&] { return watcher->status.value("held", false); }));
  const float moving = watcher->depth_mm;
  ASSERT_TRUE(watcher->until([&] { return watcher->depth_mm > moving; }));
  ASSERT_TRUE(watcher->until([&] { return !watcher->status.value("held", true); }));
  EXPECT_EQ(watcher->status["viewers"], 1);
  // The first pictures may be old: they have waited until this page, which was not read meanwhile, took them up.
  ASSERT_TRUE(watcher->until([&, before = watcher->frames] { return watcher->frames > before + 3; }));
  double then = watcher->time_s;
  ASSERT_TRUE(watcher->until([&] { return watcher->time_s > then + 0.1; }));
  const float there = watcher->depth_mm;
  EXPECT_LT(there, 90.0F);
  then = watcher->time_s;
  ASSERT_TRUE(watcher->until([&] { return watcher->time_s > then + 0.3; }));
  EXPECT_EQ(watcher->depth_mm, there) << "the needle stays where it was";
  ASSERT_TRUE(watcher->take());
}

TEST(Server, who_answers_pings_stays_however_little_it_says) {
  const Serving serving([](serve::ServerSettings& s) { s.silence_s = 0.5; });
  const auto holder = ready_client(serving);
  ASSERT_TRUE(holder->take());
  ASSERT_TRUE(holder->passes(2.0));
  EXPECT_EQ(holder->status["you_hold"], true);
}

TEST(Server, recordings_can_be_read_by_nobody_else_whatever_the_umask) {
  namespace fs = std::filesystem;
  for (const mode_t mask : {mode_t{0}, mode_t{0777}}) {
    const mode_t before = ::umask(mask);
    {
      const Serving serving;
      ready_client(serving);
      ::umask(before);
      EXPECT_EQ(fs::status(serving.folder.path).permissions(), fs::perms(0700));
      const auto recordings = recordings_of(serving);
      ASSERT_EQ(recordings.size(), 1u);
      EXPECT_EQ(fs::status(recordings[0]).permissions(), fs::perms(0700));
      EXPECT_EQ(fs::status(recordings[0] / "run.h5").permissions(), fs::perms(0600));
    }
    ::umask(before);
  }
}

TEST(Server, warns_of_a_disk_that_gets_full_and_goes_on_without_recording_when_it_is) {
  std::atomic<std::uintmax_t> free = 500'000'000;
  std::mutex mutex;
  std::string said;
  const Serving serving([&](serve::ServerSettings& s) {
    s.session.free_bytes = [&](const std::filesystem::path&) { return free.load(); };
    s.session.room_every_s = 0.05;
    s.session.say = [&](const std::string& text) {
      const std::lock_guard lock(mutex);
      said += text + "\n";
    };
  });
  const auto client = ready_client(serving);
  const auto recording = [&](const char* key) { return client->status["recording"].value(key, ""); };
  ASSERT_TRUE(client->until([&] { return !recording("warning").empty(); }));
  EXPECT_SAYS(recording("warning"), "0.5 GB");
  EXPECT_EQ(recording("problem"), "");
  client->command(R"({"do":"take"})");
  ASSERT_TRUE(client->go_to(5.0F, 100.0F));
  free = 100'000'000;
  ASSERT_TRUE(client->until([&] { return !recording("problem").empty(); }));
  EXPECT_SAYS(recording("problem"), "nearly full");
  ASSERT_TRUE(client->go_to(10.0F, 100.0F)) << "the simulation goes on";
  const auto run = value_of(read_recording(recordings_of(serving).at(0) / "run.h5"));
  EXPECT_GT(run.steps.back().base_depth_mm, 4.0) << "what was recorded before is whole";
  EXPECT_LT(run.steps.back().base_depth_mm, 9.0);
  const std::lock_guard lock(mutex);
  EXPECT_SAYS(said, "0.5 GB");
  EXPECT_SAYS(said, "nearly full");
}

TEST(Server, removes_old_recordings_but_not_the_one_it_replays) {
  const Serving serving([](serve::ServerSettings& s) {
    s.session.keep_bytes = 1;  // smaller than any recording
    s.session.room_every_s = 0.05;
  });
  const auto client = ready_client(serving);
  const auto recording = [&](const char* key) { return client->status["recording"].value(key, ""); };
  const std::string first = recording("name");
  ASSERT_TRUE(client->until([&] { return !recording("problem").empty(); })) << "it takes more by itself";
  EXPECT_SAYS(recording("problem"), "--keep");
  client->command(R"({"do":"take"})");
  ASSERT_TRUE(client->replay(first));
  // Waits longer than a second, because a recording's name has the second of its start, and a removed name may be
  // reused.
  std::this_thread::sleep_for(std::chrono::milliseconds(1200));
  EXPECT_TRUE(std::filesystem::exists(serving.folder.path / first / "run.h5"));
  client->command(R"({"do":"live"})");
  ASSERT_TRUE(client->until([&] { return client->status.value("mode", "") == "live" && recording("name") == first; }))
      << "the needle is as it was";
  client->command(R"({"do":"reset"})");
  ASSERT_TRUE(client->until([&] { return client->status.value("mode", "") == "live" && recording("name") != first; }));
  ASSERT_TRUE(client->until([&] { return !std::filesystem::exists(serving.folder.path / first); }));
  EXPECT_TRUE(std::filesystem::exists(serving.folder.path / recording("name") / "run.h5"));
}

TEST(Server, says_what_is_wrong_with_an_address_a_port_or_a_case) {
  serve::ServerSettings s;
  s.session.cases = {box_case("first")};
  s.address = "nowhere";
  EXPECT_SAYS(serve::Server::open(s).error().message(), "nowhere");
  s.address = "0.0.0.0";
  s.asks_for_token = false;
  EXPECT_SAYS(serve::Server::open(s).error().message(), "everybody who can reach 0.0.0.0");
  s.asks_for_token = true;
  s.token = "a b";
  EXPECT_SAYS(serve::Server::open(s).error().message(), "'a b' has characters that a web address cannot hold");
  s.token.clear();
  const Serving serving;
  s.address = "127.0.0.1";
  s.port = serving.port();
  EXPECT_SAYS(serve::Server::open(s).error().message(), "another port");

  const Serving broken([](serve::ServerSettings& settings) {
    settings.session.cases[0].load = [](const Progress&) {
      return Result<serve::LoadedCase>(input_error("case.toml", "it is broken", "Mend it"));
    };
  });
  LiveClient client(broken.port());
  ASSERT_TRUE(client.until([&] { return client.status.value("state", "") == "failed"; }));
  EXPECT_SAYS(client.status["message"].get<std::string>(), "it is broken");
  EXPECT_EQ(client.status["cure"], "Mend it");
  client.command(R"({"do":"take"})");
  client.command(R"({"do":"case","index":1})");
  EXPECT_TRUE(client.until([&] { return client.ready(); })) << "another case can be opened";
}
