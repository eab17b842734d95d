// SPDX-License-Identifier: GPL-3.0-or-later
// The rooms of a session, each without the others, and the session without a connection.
#include "catalogue.hpp"
#include "implant_desk.hpp"
#include "rectum_case.hpp"
#include "session.hpp"
#include "small_implant.hpp"

#include <chrono>
#include <ctime>
#include <fstream>
#include <mutex>
#include <thread>

using namespace stylet;
using namespace stylet::serve;
using namespace stylet::test;

namespace {

using Do = Command::Do;

SessionSettings room_settings(const ProcessFolder& folder, std::vector<CaseSource> cases) {
  SessionSettings s;
  s.cases = std::move(cases);
  s.recordings = folder.path;
  s.runner.period_s = 4e-3;
  s.runner.late_after_s = 0.5;
  s.runner.realtime_scheduling = false;
  s.runner.lock_memory = false;
  s.field_waits_s = 0.0;
  return s;
}

Request ask_for(Do what, double number = 0.0, const std::string& text = {}) { return {{what, text, number}, 7}; }

/// The messages of one kind in a reply.
template <class Kind>
std::vector<Kind> shown_by(const Reply& reply) {
  std::vector<Kind> found;
  for (const Message& message : reply.show) {
    if (const auto* one = std::get_if<Kind>(&message)) found.push_back(*one);
  }
  return found;
}

/// The text of the only refusal in a reply; empty: there is none.
std::string refused_by(const Reply& reply) {
  const auto refusals = shown_by<Refusal>(reply);
  if (refusals.empty()) return {};
  EXPECT_EQ(refusals.front().viewer, 7u);
  EXPECT_TRUE(std::holds_alternative<Stay>(reply.next));
  return refusals.front().why.text;
}

/// A case that is open, and the needle that it names.
struct Opened {
  ProcessFolder folder;
  SessionSettings settings;
  OpenCase room;
  NeedleStart start;

  explicit Opened(CaseSource source = box_case("first"))
      : settings(room_settings(folder, {std::move(source), box_case("second")})), room(settings) {
    const Reply reply = open(ask_for(Do::open_case));
    start = *std::get<ToLive>(reply.next).start;
  }
  Reply open(const Request& request) {
    const Reply wish = room.ask(request);
    return *room.open(std::get<ToOpen>(wish.next), {});
  }
};

/// A needle that is live, with at least one step.
struct LiveNeedle : Opened {
  LiveRoom live{settings};

  explicit LiveNeedle(CaseSource source = box_case("first")) : Opened(std::move(source)) {
    const auto entered = live.enter(start);
    EXPECT_TRUE(entered);
    EXPECT_EQ(shown_by<LiveEvent>(*entered).at(0).kind, "started");
    until([&] { return live.moment().has_value(); });
  }
  void until(const std::function<bool()>& is_true) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!is_true()) {
      ASSERT_LT(std::chrono::steady_clock::now(), end);
      (void)live.tick(false);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  /// Waits until the loop says that it is paused. @return the simulated time at which it stands
  double stands_at() {
    until([&] {
      const auto frames = shown_by<std::shared_ptr<const LiveFrame>>(live.tick(true));
      return !frames.empty() && (frames.back()->bits & LiveFrame::paused) != 0;
    });
    return live.moment()->time_s;
  }
  [[nodiscard]] SessionStatus status() const {
    SessionStatus status;
    live.describe(status);
    return status;
  }
  /// Ends the needle and gives the name of its recording.
  std::string recorded() {
    std::string name = status().recording.name;
    live.end();
    return name;
  }
};

/// An audience that keeps what it gets.
struct KeptAudience final : Audience {
  void show(const Message& message) override {
    const std::scoped_lock lock(mutex);
    messages.push_back(message);
  }
  void tell(const SessionStatus& now) override {
    const std::scoped_lock lock(mutex);
    status = now;
  }
  bool until(const std::function<bool()>& is_true) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < end) {
      {
        const std::scoped_lock lock(mutex);
        if (is_true()) return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  SessionStatus now() {
    const std::scoped_lock lock(mutex);
    return status;
  }
  /// Number of messages of a kind. The mutex must be held.
  template <class Kind>
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(messages, [](const Message& m) { return std::holds_alternative<Kind>(m); }));
  }
  std::mutex mutex;
  std::vector<Message> messages;
  SessionStatus status;
};

/// A session whose first case is live.
struct InSession {
  ProcessFolder folder;
  KeptAudience kept;
  Session session;

  explicit InSession(std::vector<CaseSource> cases = {box_case("first"), box_case("second")})
      : session(room_settings(folder, std::move(cases)), kept) {
    session.start();
    EXPECT_TRUE(kept.until([&] { return kept.status.state == SessionStatus::State::ready; }));
    // Recordings are written to the disk five times a second.
    EXPECT_TRUE(kept.until([&] { return kept.status.recording.seconds > 0.5; }));
  }
  /// Asks, and waits for a status that satisfies a condition.
  bool ask(const Request& request, const std::function<bool(const SessionStatus&)>& good) {
    return session.ask(request) && kept.until([&] { return good(kept.status); });
  }
};

/// A drop that ImplantDesk::add() accepts.
ProbedDrop some_drop() {
  ProbedDrop made;
  made.tip_in_tissue = made.found = true;
  made.axis = {0.0, 0.0, 1.0};
  return made;
}

std::optional<InterruptedImplant> interrupted_in(const LiveNeedle& needle) {
  return find_interrupted(Shelf(needle.folder.path), needle.start.implant->plan(), false);
}

}  // namespace

TEST(OpenCase, names_what_to_open_and_refuses_what_is_not_there) {
  Opened first;
  EXPECT_EQ(first.room.list().open, 0u);
  EXPECT_EQ(first.start.hole, "D4");
  EXPECT_SAYS(refused_by(first.room.ask(ask_for(Do::open_case, 2))), "case: there is no number 2");
  EXPECT_SAYS(refused_by(first.room.ask(ask_for(Do::insertion, 9))), "insertion: there is no number 9");
  EXPECT_SAYS(refused_by(first.room.ask(ask_for(Do::needle))), "needle of the plan: there is no number 0");
  EXPECT_NE(refused_by(first.room.ask(ask_for(Do::hole, 0.0, "Z99"))), "");

  const Reply second = first.open(ask_for(Do::open_case, 1));
  EXPECT_TRUE(std::holds_alternative<ToLive>(second.next));
  EXPECT_EQ(shown_by<std::shared_ptr<const Scene>>(second).size(), 1u);
  EXPECT_EQ(first.room.list().open, 1u);
}

TEST(OpenCase, puts_the_same_needle_back_at_once_and_opens_a_model_for_another_hole) {
  Opened first;
  const Reply again = first.room.ask(ask_for(Do::reset));
  ASSERT_TRUE(std::holds_alternative<ToLive>(again.next));
  EXPECT_EQ(std::get<ToLive>(again.next).start->hole, "D4");
  const Reply other = first.room.ask(ask_for(Do::hole, 0.0, "d4"));
  ASSERT_TRUE(std::holds_alternative<ToOpen>(other.next));
  EXPECT_TRUE(std::get<ToOpen>(other.next).is_other_needle);
  EXPECT_FALSE(std::get<ToOpen>(other.next).is_compiled);
}

TEST(OpenCase, that_cannot_be_loaded_leaves_the_open_one) {
  Opened first;
  const ToOpen wrong{1, [](const Progress&) -> Result<LoadedCase> { return input_error("a.toml", "bad", "mend it"); }};
  const auto opened = first.room.open(wrong, {});
  ASSERT_FALSE(opened);
  EXPECT_EQ(first.room.list().open, 0u);
  EXPECT_EQ(std::get<ToLive>(first.room.last_needle(ask_for(Do::live)).next).start->hole, "D4");
}

TEST(LiveRoom, pauses_takes_steps_and_goes_on) {
  LiveNeedle needle;
  (void)needle.live.ask(ask_for(Do::pause));
  EXPECT_TRUE(needle.status().paused);
  const double before = needle.stands_at();
  (void)needle.live.ask(ask_for(Do::step, 3));
  needle.until([&] { return needle.live.moment()->time_s > before + 2.5 * needle.settings.runner.period_s; });
  const double after = needle.live.moment()->time_s;
  EXPECT_NEAR(after, before + 3 * needle.settings.runner.period_s, 1e-9);
  (void)needle.live.ask(ask_for(Do::resume));
  EXPECT_FALSE(needle.status().paused);
  needle.until([&] { return needle.live.moment()->time_s > after + 5 * needle.settings.runner.period_s; });
}

TEST(LiveRoom, set_aside_for_a_recording_stands_still_and_comes_back_with_its_events) {
  LiveNeedle needle;
  EXPECT_TRUE(needle.live.is_live());
  (void)needle.live.set_aside();
  EXPECT_FALSE(needle.live.is_live());
  EXPECT_TRUE(needle.live.has_needle());
  const double stands_at = needle.stands_at();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  (void)needle.live.tick(true);
  EXPECT_EQ(needle.live.moment()->time_s, stands_at);

  const auto events = shown_by<LiveEvent>(needle.live.come_back());
  ASSERT_FALSE(events.empty());
  EXPECT_EQ(events.front().kind, "started");
  needle.until([&] { return needle.live.moment()->time_s > stands_at; });
}

TEST(LiveRoom, another_needle_completes_the_recording_of_the_former) {
  LiveNeedle needle;
  const std::string former = needle.status().recording.name;
  ASSERT_TRUE(needle.live.enter(needle.start));
  EXPECT_NE(needle.status().recording.name, former);
  const auto recording = Shelf(needle.folder.path).read(former);
  ASSERT_TRUE(recording) << recording.error().message();
  EXPECT_FALSE(recording->steps.empty());
}

TEST(LiveRoom, drops_seeds_of_a_plan_only_and_keeps_them_during_a_replay) {
  EXPECT_SAYS(refused_by(LiveNeedle().live.ask(ask_for(Do::drop))), "this case has no plan of seeds");
  LiveNeedle with(implant_case());
  EXPECT_SAYS(refused_by(with.live.ask(ask_for(Do::undo))), "no seed has been dropped yet");
  (void)with.live.ask(ask_for(Do::pause));
  EXPECT_SAYS(refused_by(with.live.ask(ask_for(Do::drop))), "the simulation is paused");
  (void)with.live.set_aside();
  EXPECT_SAYS(refused_by(with.live.ask(ask_for(Do::drop))), "no needle is in your hand now");
  EXPECT_SAYS(refused_by(with.live.ask(ask_for(Do::clear))), "whose seeds cannot be changed");
  EXPECT_TRUE(with.live.follow_implant().show.empty()) << "the recorded implant is shown";
  (void)with.live.come_back();
  EXPECT_EQ(shown_by<ShownPlan>(with.live.follow_implant()).size(), 1u);
}

TEST(OpenCase, offers_an_interrupted_implant_and_takes_it_up_to_the_last_bits) {
  const auto source = implant_case([](Scenario& scenario) {
    scenario.seed = {.stranded = true, .release_mm = 0.5, .release_sd_mm = 2.0, .loss_percent = 30.0, .random = 7};
  });
  LiveNeedle first(source);
  EXPECT_SAYS(refused_by(first.room.ask(ask_for(Do::interrupted, 1.0))), "there is none to go on with");
  ImplantDesk& desk = *first.start.implant;
  const auto drop = [&](double along_mm) {
    ProbedDrop made;
    made.tip_in_tissue = made.found = true;
    made.time_s = along_mm;
    made.place = {0.3, 5.0, along_mm};
    made.rest = {0.1, 5.2, along_mm - 2.0};
    made.straight = {0.0, 5.0, along_mm};
    made.lasting = {0.0, 0.0, 0.3};
    made.axis = {0.0, 0.0, 1.0};
    EXPECT_TRUE(desk.add(made));
    (void)first.live.follow_implant();
  };
  drop(42.0);
  drop(31.0);
  desk.count({EventKind::bone_contact, 1.0, 1.0, 1.0, "bone"});
  desk.set_current(1);
  drop(36.0);
  desk.set_current(0);
  drop(24.0);
  ASSERT_TRUE(desk.take_back());
  (void)first.live.follow_implant();
  const LiveImplant before = desk.state();
  ASSERT_EQ(before.seeds.size(), 3u);

  // Nothing was closed; another server, or another day, finds what is on the disk.
  OpenCase other(first.settings);
  const Reply wish = other.ask(ask_for(Do::open_case));
  ASSERT_TRUE(other.open(std::get<ToOpen>(wish.next), {}));
  SessionStatus status;
  first.until([&] {
    other.describe(status);
    return status.interrupted.has_value();
  });
  EXPECT_EQ(status.interrupted->recording, first.status().recording.name);
  EXPECT_EQ(status.interrupted->seeds, 3u);
  EXPECT_EQ(status.interrupted->planned_seeds, 5u);
  EXPECT_EQ(status.interrupted->needle, "left");
  EXPECT_NEAR(static_cast<double>(status.interrupted->recorded_s), static_cast<double>(std::time(nullptr)), 60.0);
  const Reply up = other.ask(ask_for(Do::interrupted, 1.0));
  const auto opened = other.open(std::get<ToOpen>(up.next), {});
  ASSERT_TRUE(opened) << opened.error().message();
  const NeedleStart start = *std::get<ToLive>(opened->next).start;
  EXPECT_EQ(start.needle, 0u);
  const LiveImplant& after = start.implant->state();
  ASSERT_EQ(after.seeds.size(), before.seeds.size());
  for (std::size_t k = 0; k < before.seeds.size(); ++k) {
    const SeedHistory &was = before.seeds[k], &is = after.seeds[k];
    EXPECT_TRUE(was.is_same_drop(is));
    EXPECT_EQ(was.lost, is.lost);
    EXPECT_LT((was.rest_mm - is.rest_mm).norm(), 1e-12);
    for (const SeedCauseWords& words : kSeedCauses)
      EXPECT_LT((was.by(words.cause) - is.by(words.cause)).norm(), 1e-12) << words.name;
  }
  other.describe(status);
  EXPECT_FALSE(status.interrupted) << "it was taken up";
  EXPECT_EQ(start.implant->plan().implant, desk.plan().implant);
}

TEST(OpenCase, leaves_an_interrupted_implant_that_nobody_wants) {
  LiveNeedle first(implant_case());
  EXPECT_FALSE(interrupted_in(first)) << "nothing was done to the seeds";
  ASSERT_TRUE(first.start.implant->add(some_drop()));
  (void)first.live.follow_implant();
  ASSERT_TRUE(interrupted_in(first));
  OpenCase other(first.settings);
  const Reply wish = other.ask(ask_for(Do::open_case));
  ASSERT_TRUE(other.open(std::get<ToOpen>(wish.next), {}));
  SessionStatus status;
  first.until([&] {
    other.describe(status);
    return status.interrupted.has_value();
  });
  EXPECT_EQ(refused_by(other.ask(ask_for(Do::interrupted, 0.0))), "");
  other.describe(status);
  EXPECT_FALSE(status.interrupted);
  (void)first.live.ask(ask_for(Do::clear));
  EXPECT_FALSE(interrupted_in(first)) << "its seeds were all taken back";
}

TEST(FindInterrupted, takes_the_last_needle_also_the_next_day_and_among_other_recordings) {
  LiveNeedle needle(implant_case());
  needle.start.implant->count({EventKind::region_entered, 1.0, 60.0, 1.0, "rectum"});
  const auto next = [&](std::size_t which) {
    needle.start.needle = which;
    needle.start.name = needle.start.implant->plan().needles[which].name;
    EXPECT_TRUE(needle.live.enter(needle.start));
    EXPECT_TRUE(needle.start.implant->add(some_drop()));
    (void)needle.live.follow_implant();
  };
  next(1);
  next(0);  // mostly in the same second, in which the names are not in the order of time
  ASSERT_TRUE(interrupted_in(needle));
  EXPECT_EQ(interrupted_in(needle)->needle, 0u);
  next(1);
  const std::string last = needle.status().recording.name;
  const Shelf shelf(needle.folder.path);
  for (const std::string& name : shelf.names())
    std::filesystem::rename(shelf.folder(name), needle.folder.path / ("2026-01-01" + name.substr(10)));
  const auto implant = std::exchange(needle.start.implant, nullptr);
  ASSERT_TRUE(needle.live.enter(needle.start)) << "a newer recording, which has no plan";
  needle.start.implant = implant;
  const auto found = interrupted_in(needle);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->recording, "2026-01-01" + last.substr(10));
  EXPECT_EQ(found->needle, 1u);
  EXPECT_EQ(found->seeds.size(), 3u);
  EXPECT_EQ(found->tally, ImplantTally{.organ_entries = 1});
}

TEST(LiveRoom, says_in_each_recording_what_the_needles_before_have_done) {
  LiveNeedle needle(implant_case());
  const std::string first = needle.status().recording.name;
  needle.start.implant->count({EventKind::region_entered, 1.0, 60.0, 1.0, "rectum"});
  ASSERT_TRUE(needle.live.enter(needle.start));
  const std::string second = needle.status().recording.name;
  needle.live.end();
  const Shelf shelf(needle.folder.path);
  const RecordedPlan one = shelf.read(first)->implant->plan, two = shelf.read(second)->implant->plan;
  EXPECT_EQ(one.implant, first);
  EXPECT_EQ(one.before, ImplantTally{});
  EXPECT_EQ(two.implant, first);
  EXPECT_EQ(two.before, ImplantTally{.organ_entries = 1});
}

TEST(Catalogue, tells_of_each_recording_and_reads_only_what_has_changed) {
  LiveNeedle needle(implant_case());
  const std::string first = needle.status().recording.name;
  ASSERT_TRUE(needle.live.enter(needle.start));
  Catalogue catalogue{Shelf(needle.folder.path)};
  const auto list = catalogue.list();
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[1].name, first);
  EXPECT_EQ(list[1].problem, "");
  EXPECT_TRUE(list[1].has_ended) << "by the next needle";
  EXPECT_FALSE(list[0].has_ended);
  EXPECT_EQ(list[1].needle, "left");
  EXPECT_GT(list[1].duration_s, 0.0);
  EXPECT_EQ(list[1].planned_seeds, 5u);
  // A file that nobody can read any more is not read again while it looks the same.
  const auto file = needle.folder.path / first / "run.h5";
  const auto written = std::filesystem::last_write_time(file);
  const auto bytes = std::filesystem::file_size(file);
  std::ofstream(file) << std::string(bytes, 'x');
  std::filesystem::last_write_time(file, written);
  EXPECT_EQ(catalogue.list()[1].problem, "");
  std::filesystem::last_write_time(file, written + std::chrono::seconds(1));
  EXPECT_NE(catalogue.list()[1].problem, "");
}

TEST(ReplayRoom, shows_a_recording_and_names_where_a_page_wants_to_go) {
  LiveNeedle needle;
  const std::string name = needle.recorded();
  ReplayRoom room(needle.settings);
  EXPECT_EQ(std::get<ToReplay>(room.ask(ask_for(Do::replay, 0.0, name)).next).name, name);
  EXPECT_FALSE(room.enter("there is none", needle.room.list()));
  const auto entered = room.enter(name, needle.room.list());
  ASSERT_TRUE(entered);
  EXPECT_EQ(shown_by<std::shared_ptr<const Scene>>(*entered).size(), 1u);
  EXPECT_FALSE(room.enter("there is none", needle.room.list()));
  SessionStatus status;
  room.describe(status);
  EXPECT_EQ(status.replay.name, name) << "a recording that cannot be read leaves the one that is shown";
  EXPECT_EQ(status.hole, "D4");

  (void)room.ask(ask_for(Do::play, 1.0));
  (void)room.tick(0.5 * status.replay.duration_s, false);
  (void)room.ask(ask_for(Do::seek, status.replay.duration_s));
  const Reply last = room.tick(0.1, true);
  EXPECT_TRUE(last.is_urgent) << "it has reached its end";
  EXPECT_EQ(shown_by<std::shared_ptr<const LiveFrame>>(last).size(), 1u);

  EXPECT_FALSE(std::get<ToLive>(room.ask(ask_for(Do::live)).next).start);
  EXPECT_EQ(shown_by<ShownPlan>(room.leave()).size(), 1u);
  room.describe(status);
  EXPECT_EQ(status.replay.name, "");
}

TEST(PictureRoom, keeps_settings_of_the_live_probe_over_a_replay) {
  Opened opened(case_with_rectum());
  PictureRoom room(opened.settings);
  room.open(opened.room.patient());
  EXPECT_TRUE(room.wants_moment()) << "of the patient that is new";
  EXPECT_SAYS(refused_by(room.ask(ask_for(Do::image, 0.0, "colour"))), "there is no picture \"colour\"");
  EXPECT_SAYS(refused_by(room.ask(ask_for(Do::set, 3.0, "tissue.creep"))), "it is not a key of the pictures");
  EXPECT_SAYS(refused_by(room.ask(ask_for(Do::set, 1000.0, "probe.lift_mm"))), "probe.lift_mm");
  EXPECT_EQ(refused_by(room.ask(ask_for(Do::set, 8.0, "probe.lift_mm"))), "");
  EXPECT_FALSE(room.wants_moment());
  EXPECT_EQ(refused_by(room.ask(ask_for(Do::image, 0.0, "transverse"))), "");
  EXPECT_TRUE(room.wants_moment());
  EXPECT_FALSE(room.wants_moment()) << "once";

  ImageSubject recorded = opened.room.patient();
  recorded.mesh = std::make_shared<const TetMesh>(*recorded.mesh);
  recorded.scenario.probe.lift_mm = 2.0;
  recorded.is_recorded = true;
  room.open(recorded);
  EXPECT_EQ(room.desk().probe().lift_mm, 2.0);
  room.open(opened.room.patient());
  EXPECT_EQ(room.desk().probe().lift_mm, 8.0);
}

TEST(Session, asked_for_a_replay_while_a_needle_is_live_sets_it_aside_and_asked_for_it_goes_on) {
  InSession in;
  const std::string first = in.kept.now().recording.name;
  EXPECT_TRUE(in.ask(ask_for(Do::open_case, 1), [&](const auto& s) {
    return s.state == SessionStatus::State::ready && s.recording.name != first;
  })) << "another case while the needle records";
  const std::string second = in.kept.now().recording.name;
  EXPECT_TRUE(in.ask(ask_for(Do::replay, 0.0, first), [&](const auto& s) { return s.replay.name == first; }));
  EXPECT_EQ(in.kept.now().recording.name, "");
  EXPECT_TRUE(in.ask(ask_for(Do::pause), [](const auto& s) { return !s.replay.name.empty(); }))
      << "not during a replay";
  EXPECT_TRUE(in.ask(ask_for(Do::live), [&](const auto& s) { return s.recording.name == second; }));
  EXPECT_FALSE(in.kept.now().paused);
  const double then = in.kept.now().recording.seconds;
  EXPECT_TRUE(in.kept.until([&] { return in.kept.status.recording.seconds > then; })) << "the loop goes on";
  EXPECT_TRUE(in.ask(ask_for(Do::seek, 1.0), [](const auto& s) { return s.replay.name.empty(); }))
      << "no replay to seek in";
}

TEST(Session, whose_recording_cannot_be_shown_goes_on_with_the_needle) {
  InSession in;
  const std::string name = in.kept.now().recording.name;
  ASSERT_TRUE(in.session.ask(ask_for(Do::replay, 0.0, "there is none")));
  EXPECT_TRUE(in.kept.until([&] { return in.kept.count<Refusal>() == 1; }));
  const double then = in.kept.now().recording.seconds;
  EXPECT_TRUE(in.kept.until([&] { return in.kept.status.recording.seconds > then + 0.02; }));
  EXPECT_EQ(in.kept.now().recording.name, name);
}

TEST(Session, opens_a_case_out_of_a_replay_and_forgets_the_needle_that_was_aside) {
  InSession in;
  const std::string first = in.kept.now().recording.name;
  ASSERT_TRUE(in.ask(ask_for(Do::replay, 0.0, first), [&](const auto& s) { return s.replay.name == first; }));
  EXPECT_TRUE(in.ask(ask_for(Do::open_case, 1), [&](const auto& s) {
    return s.replay.name.empty() && !s.recording.name.empty() && s.recording.name != first;
  }));
}
