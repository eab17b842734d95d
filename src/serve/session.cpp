// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/serve/session.hpp"

#include "field_maker.hpp"
#include "folder_lock.hpp"
#include "image_desk.hpp"
#include "implant_desk.hpp"
#include "live_run.hpp"
#include "map_maker.hpp"
#include "replay.hpp"
#include "replayed_seeds.hpp"
#include "room_watch.hpp"
#include "scene.hpp"
#include "shelf.hpp"

#include "stylet/io/recorded_moments.hpp"
#include "stylet/io/scenario_io.hpp"
#include "stylet/sim/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace stylet::serve {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kRequests = 256;
constexpr std::size_t kMostEvents = 1000;
constexpr auto kStatusEvery = std::chrono::milliseconds(500);
constexpr auto kProgressEvery = std::chrono::milliseconds(50);
constexpr auto kImplantEvery = std::chrono::milliseconds(3);
// SessionStatus::stage while the session is ready and a part of the picture is missing.
constexpr const char* kFieldStage = "the picture of the tissue's motion";
constexpr const char* kNoField = "there is too little memory to show how the tissue moves";

HandTarget resting() {
  HandTarget rest;
  rest.rest = true;
  return rest;
}

/// The insertion through a hole: the case's own if it plans one, otherwise a copy of its first insertion through this
/// hole, to the far end of the target.
InsertionPlan plan_for(const std::vector<InsertionPlan>& plans, const std::string& hole) {
  const auto known = std::find_if(plans.begin(), plans.end(), [&](const auto& p) { return p.hole == hole; });
  if (known != plans.end()) return *known;
  InsertionPlan plan = plan_through(plans.front(), hole);
  plan.depth_mm = 0.0;
  return plan;
}

/// Whether a request puts another needle into the open case, instead of opening a case.
bool is_other_needle(const Request& request) {
  using Kind = Request::Kind;
  return request.kind == Kind::hole || request.kind == Kind::insertion || request.kind == Kind::needle;
}

}  // namespace

struct Session::Parts {
  Parts(SessionSettings settings_, Audience& audience_)
      : settings(std::move(settings_)),
        audience(audience_),
        shelf(settings.recordings, settings.archive),
        room([this] { return look_after_room(); }, settings.say,
             std::chrono::milliseconds(std::lround(1e3 * settings.room_every_s))) {}

  // Guarded by the mutex: other threads use these members.
  std::mutex mutex;
  std::condition_variable_any wake;
  std::deque<Request> requests;
  std::shared_ptr<PageDevice> hand;  ///< of the current live run
  std::optional<HandTarget> wanted;  ///< not used

  // Used by the session's thread only.
  SessionSettings settings;
  Audience& audience;
  Shelf shelf;
  std::size_t open_case = 0;
  OpenModel open;                                      ///< has no model if none could be opened
  std::unique_ptr<FieldMaker> field_maker;             ///< of the open model, until its field is complete
  std::vector<std::unique_ptr<FieldMaker>> abandoned;  ///< of earlier models; their threads have not ended
  std::unique_ptr<MapMaker> map_maker;                 ///< of the open case
  std::vector<std::unique_ptr<MapMaker>> former_maps;  ///< of earlier cases; their threads have not ended
  LiveMap map;                                         ///< the latest map of map_maker
  bool map_is_shown = false;                           ///< the viewers have the map
  /// The plan of the open case; the open model may have an insertion through another hole.
  struct Planned {
    Scenario scenario;
    std::vector<PlannedInsertion> insertions;
  } planned;
  std::unique_ptr<ImplantDesk> implant;                       ///< of the open case, if it has a plan of seeds
  std::vector<std::unique_ptr<ImplantDesk>> former_implants;  ///< of earlier cases; their threads have not ended
  ImageDesk images;
  std::uint64_t dropper = 0;  ///< viewer that has asked for the drop that is under way
  std::size_t insertion = 0;
  bool page_has_drawn = false;  ///< some page has drawn its first picture; then a FieldMaker does not wait
  std::unique_ptr<LiveRun> live;
  /// The live run while a recording is replayed: it is paused and continues afterwards.
  struct SetAside {
    std::unique_ptr<LiveRun> run;
    SessionStatus status;
  };
  std::optional<SetAside> aside;
  std::vector<LiveEvent> happened;  ///< events of the live run
  std::unique_ptr<Replay> replay;
  std::unique_ptr<ReplayedSeeds> replayed_seeds;  ///< of `replay`, if it has an implant
  std::unique_ptr<RecordedMoments> moments;       ///< of `replay`, for pictures
  FolderLock replayed;                            ///< keeps the replayed recording from being removed
  SessionStatus status;
  bool whole_curve = true;
  Clock::time_point next_status;
  Clock::time_point last_progress;
  RoomWatch room;

  std::jthread thread;  ///< last member, so that it starts when the others exist

  void run(const std::stop_token& stop);
  void carry_out(const Request& request);
  void tick(double dt_s);
  void show_companion();
  std::string companion_trouble;  ///< the last sentence for the terminal about the companion
  void heed_room();
  [[nodiscard]] RoomReport look_after_room() const;
  void show_inside();
  void say_status();
  Progress progress();
  void fail(const Error& error) {
    status.state = SessionStatus::State::failed;
    status.failure = {error.where + ": " + error.what, error.cure};
  }
  void refuse(const Request& request, const Error& error) {
    audience.refuse(request.viewer, {error.where + ": " + error.what, error.cure});
  }

  void open_model(const Request& request, std::size_t case_number,
                  const std::function<Result<LoadedCase>(const Progress&)>& load);
  void show_model(std::size_t which);
  void take_field();
  void abandon_field();
  void begin_map();
  void begin_case(std::unique_ptr<ImplantDesk> plan);
  void keep_needle();
  /// Whether a seed is being dropped or its dose computed; then the session looks for the result more often.
  [[nodiscard]] bool is_implant_busy() const {
    return implant && !replay && (implant->state().is_computing || (live && live->seeds().dropping() > 0));
  }
  void follow_implant();
  void take_drop();
  void show_replayed_seeds();
  [[nodiscard]] std::vector<ShownSeed> shown_seeds();
  void open_images();
  void take_moment();
  void serve_images();
  void show_images();
  void end_replay();
  void choose_needle(const Request& request, std::size_t which);
  void use_model(const Request& request, const NeedleModels::Ready& ready);
  void drop_seed(const Request& request);
  void show_map();
  void choose_hole(const Request& request);
  void choose_plan(const Request& request, const InsertionPlan& plan, const std::string& where);
  void place(const Request& request, std::size_t which);
  Result<> start_replay(const std::string& name);
  void pump();
  void end_live();
  void hold_live();
  void go_on();
  void set_live_aside();
  void back_to_live();
  void set_hand(std::shared_ptr<PageDevice> device);
  [[nodiscard]] CaseList cases() const;
};

Session::Session(SessionSettings settings, Audience& audience)
    : parts_(std::make_unique<Parts>(std::move(settings), audience)) {}

Session::~Session() { stop(); }

void Session::stop() {
  if (!parts_->thread.joinable()) return;
  parts_->thread.request_stop();
  parts_->thread.join();
}

void Session::start() {
  parts_->thread = std::jthread([p = parts_.get()](const std::stop_token& stop) { p->run(stop); });
}

bool Session::ask(Request request) {
  {
    const std::lock_guard lock(parts_->mutex);
    if (parts_->requests.size() >= kRequests) return false;
    parts_->requests.push_back(std::move(request));
  }
  parts_->wake.notify_all();
  return true;
}

void Session::aim(const HandTarget& target) {
  const std::lock_guard lock(parts_->mutex);
  if (parts_->hand) parts_->hand->aim(target);
}

void Session::let_go() { aim(resting()); }

CaseList Session::Parts::cases() const {
  CaseList list;
  for (const CaseSource& source : settings.cases) list.titles.push_back(source.title);
  list.open = open_case;
  list.dt_ms = 1e3 * settings.runner.period_s;
  return list;
}

void Session::Parts::set_hand(std::shared_ptr<PageDevice> device) {
  const std::lock_guard lock(mutex);
  hand = std::move(device);
}

void Session::Parts::pump() {
  live->pump([this](const LiveEvent& event) {
    happened.push_back(event);
    if (happened.size() > kMostEvents) happened.erase(happened.begin() + 1);  // keeps the first event, "started"
    audience.tell(event);
  });
}

/// Ends the loop and completes its recording.
void Session::Parts::end_live() {
  set_hand(nullptr);
  if (live) pump();
  if (aside) aside->run->pump([](const LiveEvent&) {});
  aside.reset();
  live.reset();
  room.set_recording(false);
  status.recording = {};
  status.inside.clear();
  status.device_problem.clear();
}

/// Pauses the live run, if there is one, and takes the hand off the needle until go_on().
void Session::Parts::hold_live() {
  if (!live) return;
  set_hand(nullptr);
  if (live->hand()) live->hand()->aim(resting());
  live->runner().pause();
  pump();
}

void Session::Parts::go_on() {
  if (!live) return;
  set_hand(live->hand());
  if (!status.paused) live->runner().resume();
}

/// Pauses the live run until back_to_live().
void Session::Parts::set_live_aside() {
  if (!live) return;
  hold_live();
  aside = SetAside{std::move(live), status};
  status.recording = {};
  status.device_problem.clear();
}

/// Ends the replay, if there is one, and shows the implant of the open case again instead of the recorded one.
void Session::Parts::end_replay() {
  if (!replay) return;
  moments.reset();
  replayed_seeds.reset();
  replay.reset();
  replayed = {};
  audience.show(LivePlan{});
  if (implant) implant->show_again();
}

void Session::Parts::back_to_live() {
  end_replay();
  open_images();
  show_model(insertion);
  SetAside was = std::move(*aside);
  aside.reset();
  for (const LiveEvent& event : happened) audience.tell(event);
  live = std::move(was.run);
  const SessionStatus now = std::exchange(status, std::move(was.status));
  status.stage = field_maker ? kFieldStage : open.field ? "" : kNoField;
  status.fraction = now.fraction;
  go_on();
  whole_curve = true;
}

Progress Session::Parts::progress() {
  return [this](std::string_view stage, double fraction) {
    const auto now = Clock::now();
    if (now < last_progress + kProgressEvery && stage == status.stage) return;
    last_progress = now;
    status.stage = stage;
    status.fraction = fraction;
    audience.tell(status);
  };
}

void Session::Parts::say_status() {
  if (live) {
    status.loop = live->loop();
    status.recording.seconds = live->time_s();
  }
  if (replay) {
    status.replay.time_s = replay->time_s();
    status.replay.rate = replay->rate();
  }
  audience.tell(status);
  next_status = Clock::now() + kStatusEvery;
}

/// Starts the loop for one of the model's insertions, with the needle in front of the skin.
void Session::Parts::place(const Request& request, std::size_t which) {
  end_live();
  end_replay();
  status.replay = {};
  insertion = which;
  if (open.way != which) show_model(which);
  const PlannedInsertion& plan = open.model->insertions()[which];
  const std::optional<std::size_t> needle = implant ? implant->needle_of(*open.model) : std::nullopt;
  const std::string plan_name = needle ? implant->plan().needles[*needle].name : plan.name;
  const std::string name = shelf.new_name(plan_name);
  std::unique_ptr<Device> other = settings.companion ? settings.companion->device() : nullptr;
  status.device = other ? settings.companion->name() : "page";
  if (implant) {
    implant->set_current(needle);
    implant->set_train(std::nullopt);
  }
  const std::optional<RecordedPlan> plan_of_seeds =
      implant ? std::optional(recorded_plan(implant->plan())) : std::optional<RecordedPlan>();
  auto run = LiveRun::start(open, which, shelf.folder(name), settings.runner, settings.recorded_frames_per_s,
                            std::move(other), plan_of_seeds ? &*plan_of_seeds : nullptr);
  if (!run) {
    refuse(request, run.error());
    return fail(run.error());
  }
  live = std::move(*run);
  room.set_recording(true);
  set_hand(live->hand());
  status.state = SessionStatus::State::ready;
  status.stage = field_maker ? kFieldStage : open.field ? "" : kNoField;
  status.fraction = -1.0;
  status.paused = false;
  status.insertion = plan_name;
  status.hole =
      needle ? implant->plan().needles[*needle].hole : open.model->scenario().insertions[which].hole.value_or("");
  status.recording.name = name;
  whole_curve = true;
  happened = {{.kind = "started", .time_s = 0.0, .depth_mm = 0.0, .force_N = 0.0, .region = plan_name}};
  audience.tell(happened.front());
  if (!implant) return;
  keep_needle();
  live->record_implant(implant->state(), implant->is_score_current());
  live->seeds().set(implant->rest_mm(), implant->seeds_of_current());
}

/// Shows the scene of the open model, with finer surfaces along the planned path of one of its insertions.
void Session::Parts::show_model(std::size_t which) {
  const Model& model = *open.model;
  MadeScene made = make_scene(model.mesh(), model.target_regions(), planned.scenario, planned.insertions,
                              open.warnings(), cases(), &model.insertions()[which]);
  open.points = std::move(made.points);
  open.way = which;
  audience.show(made.scene);
  if (settings.companion) settings.companion->show(*made.scene);
}

/// Takes the displacement field over when it is complete; until then updates the fraction that is done.
void Session::Parts::take_field() {
  std::erase_if(abandoned, [](const auto& maker) { return maker->done(); });
  if (!field_maker) return;
  status.fraction = field_maker->fraction();
  if (!field_maker->done()) return;
  open.field = field_maker->field();
  field_maker.reset();
  status.stage = open.field ? "" : kNoField;
  status.fraction = -1.0;
  next_status = {};
  keep_needle();
  if (!open.field) return;
  if (live) live->set_field(open.field);
  open_images();
  if (aside) aside->run->set_field(open.field);
}

/// Stops the preparation of a field without waiting for its thread, which may be factorising, and that takes long.
void Session::Parts::abandon_field() {
  if (!field_maker) return;
  field_maker->give_up();
  abandoned.push_back(std::move(field_maker));
}

/// Starts the map of a newly opened case.
void Session::Parts::begin_map() {
  if (map_maker) {
    map_maker->give_up();
    former_maps.push_back(std::move(map_maker));
  }
  map_maker = std::make_unique<MapMaker>(
      open.model, [plans = planned.scenario.insertions, has_plan = implant != nullptr](const std::string& hole) {
        const InsertionPlan plan = plan_for(plans, hole);
        return has_plan ? plan_through(plan, hole) : plan;
      });
  map = {};
  map_is_shown = false;
}

/// Sends the map to the viewers when it has changed. During a replay they get an empty map, because a replay shows
/// another needle, perhaps in another patient.
void Session::Parts::show_map() {
  std::erase_if(former_maps, [](const auto& maker) { return maker->done(); });
  std::optional<LiveMap> news = map_maker ? map_maker->news() : std::nullopt;
  if (news) map = std::move(*news);
  const bool is_to_be_shown = replay == nullptr;
  if (!news && is_to_be_shown == map_is_shown) return;
  map_is_shown = is_to_be_shown;
  audience.show(is_to_be_shown ? map : LiveMap{});
}

/// Takes over what the newly opened model plans, or the plan of seeds that its case has.
void Session::Parts::begin_case(std::unique_ptr<ImplantDesk> plan) {
  if (implant) {
    implant->models().give_up();
    former_implants.push_back(std::move(implant));
    if (!plan) audience.show(LivePlan{});
  }
  implant = std::move(plan);
  planned = {open.model->scenario(), open.model->insertions()};
  if (!implant) return;
  planned.scenario.insertions.clear();
  planned.insertions.clear();
  for (std::size_t k = 0; k < implant->insertions().size(); ++k) {
    const PlannedNeedle& needle = implant->plan().needles[k];
    InsertionPlan& of = planned.scenario.insertions.emplace_back(implant->insertions()[k]);
    if (!needle.hole.empty()) of.hole = needle.hole;
    PlannedInsertion& shown = planned.insertions.emplace_back();
    shown.name = needle.name;
    shown.entry = needle.entry_mm;
    shown.direction = needle.direction;
    shown.depth_mm = needle.depth_mm;
  }
}

/// Keeps the open model if it is that of a needle of the plan. Once its displacement field is complete, the models of
/// the other needles are compiled.
void Session::Parts::keep_needle() {
  const auto needle = implant ? implant->needle_of(*open.model) : std::nullopt;
  if (!needle) return;
  implant->models().keep(*needle, {open.model, open.field});
  if (!field_maker) implant->models().begin_after(*needle);
}

/// Takes up a finished drop.
void Session::Parts::take_drop() {
  const auto drop = live->seeds().take_drop();
  if (!drop) return;
  const Result<SeedHistory> added = implant->add(*drop);
  if (!added) {
    audience.refuse(dropper, {added.error().where + ": " + added.error().what, added.error().cure});
    return;
  }
  if (added->lost) {
    audience.refuse(
        dropper,
        {fmt::format("Seed {} of needle {} is lost: it has left the patient and gives no dose.",
                     implant->seeds_of_current().size(), implant->plan().needles[added->needle].name),
         fmt::format("The scenario loses {} % of the seeds (seed.loss_percent).", planned.scenario.seed.loss_percent)});
  }
  live->seeds().set(implant->rest_mm(), implant->seeds_of_current());
  if (drop->found) return;
  audience.refuse(dropper, {"The motion of the tissue is not known where this seed was dropped; it is counted as "
                            "resting there.",
                            "Take it back, and drop it nearer to the planned path of the needle."});
}

/// Takes up finished drops, records what has changed of the implant, and tells it to the viewers. During a replay they
/// see the recorded implant instead.
void Session::Parts::follow_implant() {
  std::erase_if(former_implants, [](const auto& former) { return former->models().done(); });
  if (!implant || replay) return;
  if (live) {
    take_drop();
    implant->set_train(implant->is_preloaded() ? live->seeds().began_at_mm() : std::nullopt);
  }
  ImplantDesk::Changes changes = implant->take_changes();
  if (live && changes.state) live->record_implant(implant->state(), implant->is_score_current());
  if (changes.plan) audience.show(implant->plan());
  if (changes.state) audience.show(implant->state());
  if (changes.dose) audience.show(std::move(changes.dose));
  if (!live) return;
  if (auto places = live->seeds().news()) audience.show(LiveSeeds{std::move(*places)});
}

/// Shows the seeds that were in the tissue at the present moment of the replay, where they were then.
void Session::Parts::show_replayed_seeds() {
  if (!replayed_seeds) return;
  if (const auto news = replayed_seeds->news()) audience.show(*news);
  audience.show(replayed_seeds->places());
}

/// Shows pictures of the patient that is open now, live or recorded.
void Session::Parts::open_images() {
  if (replay) {
    const RunRecording& recording = replay->recording();
    auto scenario = parse_scenario(recording.info.scenario_text, status.replay.name);
    if (!scenario) return;  // the replay has begun, so its scenario was read
    moments = std::make_unique<RecordedMoments>(recording);
    // A copy of the mesh, since the replay may end while a picture of it is being made.
    images.open({.mesh = std::make_shared<const TetMesh>(recording.mesh),
                 .scenario = *std::move(scenario),
                 .gland = recording.info.target_regions,
                 .is_recorded = true});
    return;
  }
  if (!open.model) return;
  images.open({std::shared_ptr<const TetMesh>(open.model, &open.model->mesh()), planned.scenario,
               open.model->target_regions(), open.field});
}

/// The dropped seeds where they are now.
std::vector<ShownSeed> Session::Parts::shown_seeds() {
  std::vector<ShownSeed> shown;
  if (!implant) return shown;
  const std::vector<SeedHistory>& dropped = implant->state().seeds;
  const std::vector<Vec3> now = live->seeds().now_mm();
  std::optional<std::size_t> last_needle;
  for (std::size_t k = 0; k < std::min(now.size(), dropped.size()); ++k) {
    if (dropped[k].lost) continue;
    join_to_last(shown, planned.scenario.seed.stranded && dropped[k].needle == last_needle);
    last_needle = dropped[k].needle;
    shown.push_back({now[k], dropped[k].axis, implant->plan().seed_length_mm, implant->plan().seed_diameter_mm});
  }
  return shown;
}

/// Records where the probe is, and passes the newest moment on if pictures of it are made.
void Session::Parts::take_moment() {
  if (live) live->record_probe(images.probe());
  if (!images.is_busy()) return;
  if (replay) {
    if (moments) images.take(moments->at(replay->time_s()), moments->probe_at(replay->time_s()));
    return;
  }
  if (live && live->time_s() > 0.0) images.take(live->runner().snapshot(), shown_seeds());
}

/// Lets a companion have pictures and move the probe. Like the rest of what it sees, pictures are of the live needle.
void Session::Parts::serve_images() {
  if (!settings.companion) return;
  const bool is_anew = !images.is_busy();
  images.serve(live && settings.companion->wants_images());
  images.track(live ? settings.companion->probe_pose() : std::nullopt);
  if (is_anew) take_moment();
}

/// Shows a new picture to those who look, and tells what is missing.
void Session::Parts::show_images() {
  const bool is_shown = images.shown() != ShownImage::none;
  if (auto image = images.news()) {
    if (live && image->in_patient && settings.companion->wants_images()) settings.companion->show(*image);
    if (is_shown) audience.show(std::move(image));
  }
  SessionStatus::Image now{to_string(images.shown()), images.problem(), images.stage(),
                           images.is_tracked() ? settings.companion->name() : "page", images.probe_problem()};
  if (now == status.image) return;
  if (!is_shown && settings.companion && settings.say && !now.problem.empty() && now.problem != status.image.problem)
    settings.say(settings.companion->name() + " gets no pictures: " + now.problem);
  status.image = std::move(now);
  next_status = {};
}

void Session::Parts::drop_seed(const Request& request) {
  const auto no = [&](const std::string& why, const std::string& cure) {
    audience.refuse(request.viewer, {why, cure});
  };
  if (!implant) return no("this case has no plan of seeds", "Open a scenario with [plan]");
  if (!live) return no("no needle is in your hand now, so no seed can be dropped", "Return to the live needle");
  if (status.paused) return no("the simulation is paused, so no seed can be dropped", "Resume it, then drop the seed");
  if (live->seeds().dropping() > 0) {
    if (implant->is_preloaded()) no("the train is being left already", "Draw the needle back over it");
    return;  // otherwise the key was pressed twice within some hundredths of a second
  }
  if (const auto seed = implant->next_seed(); !seed) return refuse(request, seed.error());
  dropper = request.viewer;
  live->record_next_picture();  // the needle may have come here a moment ago
  const double half_mm = 0.5 * implant->seed_length_mm();
  if (!implant->is_preloaded()) return live->seeds().order_drop(half_mm);
  const std::vector<double> behind = implant->train_mm();
  if (behind.size() > TissueProbe::kTrain) {
    return no(fmt::format("the needle has {} seeds, and the live page can leave at most {} as a train", behind.size(),
                          TissueProbe::kTrain),
              "Set procedure.technique = \"pushed\"");
  }
  live->seeds().order_train(behind, half_mm);
}

/// Puts a needle of the plan in front of the patient: at once if its model is compiled.
void Session::Parts::choose_needle(const Request& request, std::size_t which) {
  if (const auto ready = implant->models().find(which)) return use_model(request, *ready);
  const std::string where = "needle " + implant->plan().needles[which].name;
  Scenario scenario = planned.scenario;
  scenario.insertions = {implant->insertions()[which]};
  open_model(request, open_case, [this, &scenario, &where](const Progress& progress) -> Result<LoadedCase> {
    auto model = Model::compile(scenario, open.model->mesh(), where, {}, progress);
    if (model && open.model->own_parts().is_any()) model = (*model)->with(open.model->own_parts());
    if (!model) return model.error();
    return LoadedCase{*model, open.notes};
  });
}

void Session::Parts::use_model(const Request& request, const NeedleModels::Ready& ready) {
  // The former run ends after the next one has started: locking the memory of all models anew would take a second.
  hold_live();
  const std::unique_ptr<LiveRun> former = std::move(live);
  abandon_field();
  open = {.model = ready.model, .notes = std::move(open.notes), .field = ready.field, .points = {}, .way = 0};
  open_images();
  show_model(0);
  if (!open.field) {
    field_maker = std::make_unique<FieldMaker>(
        open.model, std::chrono::duration<double>(page_has_drawn ? 0.0 : settings.field_waits_s));
  }
  place(request, 0);
}

/// Opens a model in place of the open one. If that fails, the open model continues.
void Session::Parts::open_model(const Request& request, std::size_t case_number,
                                const std::function<Result<LoadedCase>(const Progress&)>& load) {
  const SessionStatus before = status;
  hold_live();
  status.state = SessionStatus::State::loading;
  status.fraction = -1.0;
  status.stage = "reading";
  say_status();
  auto loaded = load(progress());
  Result<> usable = loaded ? DisplayField::check(*loaded->model) : Result<>(loaded.error());
  std::unique_ptr<ImplantDesk> plan;
  if (usable.ok() && loaded->implant && !is_other_needle(request)) {
    auto desk = ImplantDesk::open(loaded->implant, loaded->model, settings.cases[case_number].title);
    if (desk) plan = std::move(*desk);
    if (!desk) usable = desk.error();
  }
  if (usable.ok()) {
    end_live();
    abandon_field();
    open = {.model = loaded->model, .notes = std::move(loaded->notes), .field = nullptr, .points = {}, .way = 0};
    if (!is_other_needle(request)) begin_case(std::move(plan));
    open_images();
    open_case = case_number;
    show_model(0);
    if (!is_other_needle(request)) begin_map();
    field_maker = std::make_unique<FieldMaker>(
        open.model, std::chrono::duration<double>(page_has_drawn ? 0.0 : settings.field_waits_s));
    return place(request, 0);
  }
  if (live || replay) {
    refuse(request, usable.error());
    status = before;
    return go_on();
  }
  if (open.model) {
    refuse(request, usable.error());
    return place(request, insertion);
  }
  fail(usable.error());
}

void Session::Parts::choose_hole(const Request& request) {
  if (implant) {
    if (const auto needle = implant->needle_through(request.text)) return choose_needle(request, *needle);
  }
  choose_plan(request, plan_for(planned.scenario.insertions, request.text), "hole " + request.text);
}

/// Starts an insertion by a plan in the same patient. The model is compiled for this plan unless the open model has it.
void Session::Parts::choose_plan(const Request& request, const InsertionPlan& plan, const std::string& where) {
  const auto& there = open.model->scenario().insertions;
  for (std::size_t i = 0; i < there.size(); ++i) {
    if (there[i] == plan) return place(request, i);
  }
  Scenario scenario = planned.scenario;
  scenario.insertions = {plan};
  // An impossible plan is refused before the current insertion ends.
  if (auto good = check_scenario(scenario, where); !good) return refuse(request, good.error());
  if (auto good = plan_insertion(*open.model, plan, where); !good) return refuse(request, good.error());
  open_model(request, open_case, [this, &scenario, &where](const Progress& progress) -> Result<LoadedCase> {
    auto model = Model::compile(scenario, open.model->mesh(), where, {}, progress);
    if (model && open.model->own_parts().is_any()) model = (*model)->with(open.model->own_parts());
    if (!model) return model.error();
    return LoadedCase{*model, open.notes};
  });
}

Result<> Session::Parts::start_replay(const std::string& name) {
  FolderLock in_use(shelf.folder(name),
                    FolderLock::Kind::shared);  // first, because the live run may hold the lock of this recording
  if (live) live->runner().pause();             // its steps are not fetched while a long recording is read
  auto recording = shelf.read(name);
  auto scenario = recording ? parse_scenario(recording->info.scenario_text, name) : Result<Scenario>(recording.error());
  Result<> shown = scenario ? Result<>(Ok{}) : Result<>(scenario.error());
  if (shown && recording->frames.empty() && recording->steps.empty())
    shown = failure(name, "the recording ends before its first step", "Choose another recording");
  if (!shown) {
    if (live && !status.paused) live->runner().resume();
    return shown;
  }
  set_live_aside();
  PlannedInsertion plan;
  plan.entry = recording->info.entry_mm;
  plan.direction = recording->info.direction;
  plan.name = name;
  for (const Step& step : recording->steps) plan.depth_mm = std::max(plan.depth_mm, step.base_depth_mm);
  MadeScene made = make_scene(recording->mesh, recording->info.target_regions, *scenario, {plan},
                              recording->info.warnings, cases(), nullptr);
  audience.show(made.scene);
  for (const Event& e : recording->events)
    audience.tell(LiveEvent{to_string(e.kind), e.time_s, e.depth_mm, e.force_N, e.region});
  moments.reset();
  replayed_seeds.reset();
  replayed = std::move(in_use);
  replay = std::make_unique<Replay>(std::move(*recording), std::move(made.points));
  audience.show(LivePlan{});
  if (replay->recording().implant) {
    replayed_seeds = std::make_unique<ReplayedSeeds>(*replay);
    audience.show(replayed_seeds->plan());
  }
  status.state = SessionStatus::State::ready;
  status.replay = {.name = name, .time_s = 0.0, .duration_s = replay->duration_s(), .rate = 0.0};
  status.insertion = name;
  open_images();
  status.hole = scenario->insertions.front().hole.value_or("");
  status.loop = {};
  whole_curve = true;
  return Ok{};
}

void Session::Parts::carry_out(const Request& request) {
  using Kind = Request::Kind;
  const auto number = static_cast<std::size_t>(std::max(0.0, request.number));
  const auto missing = [&](const char* what, std::size_t count) {
    refuse(request,
           input_error(what, fmt::format("there is no number {}; the {} entries are counted from 0", number, count),
                       "Choose one of these numbers"));
  };
  switch (request.kind) {
    case Kind::image: {
      const auto shown = shown_image(request.text);
      if (!shown)
        return refuse(request, input_error("picture", "there is no picture \"" + request.text + "\"",
                                           "Choose none, transverse, sagittal or xray"));
      images.show(*shown);
      take_moment();
      break;
    }
    case Kind::set:
      if (auto done = images.set(request.text, request.number); !done) return refuse(request, done.error());
      break;
    case Kind::predict:
      if (map_maker) map_maker->want_predictions(request.number > 0.0);
      break;
    case Kind::greet:
      whole_curve = true;
      break;
    case Kind::drawn:
      page_has_drawn = true;
      if (field_maker) field_maker->begin();
      break;
    case Kind::open_case:
      if (number >= settings.cases.size()) return missing("case", settings.cases.size());
      open_model(request, number, settings.cases[number].load);
      break;
    case Kind::replay:
      if (auto started = start_replay(request.text); !started) refuse(request, started.error());
      break;
    case Kind::live:
      if (!replay) break;
      if (aside) {
        back_to_live();
        break;
      }
      if (settings.cases.empty()) return missing("case", 0);
      if (!open.model) return open_model(request, open_case, settings.cases[open_case].load);
      end_replay();
      show_model(insertion);
      place(request, insertion);
      break;
    case Kind::seek:
      if (replay) replay->seek(request.number);
      break;
    case Kind::play:
      if (replay) replay->play(request.number);
      break;
    case Kind::hole:
      if (live) choose_hole(request);
      break;
    case Kind::insertion:
      if (!live) break;
      if (number >= planned.insertions.size()) return missing("insertion", planned.insertions.size());
      if (implant) {
        choose_needle(request, number);
        break;
      }
      choose_plan(request, planned.scenario.insertions[number], planned.insertions[number].name);
      break;
    case Kind::needle:
      if (!live) break;
      if (!implant || number >= implant->plan().needles.size())
        return missing("needle of the plan", implant ? implant->plan().needles.size() : 0);
      choose_needle(request, number);
      break;
    case Kind::drop:
      drop_seed(request);
      break;
    case Kind::undo:
    case Kind::clear:
      if (!implant) break;
      if (replay) {
        return refuse(request, input_error("the seeds", "a recording is being shown, whose seeds cannot be changed",
                                           "Return to the live needle"));
      }
      if (live && live->seeds().dropping() > 0) {
        live->seeds().call_off();
        const bool has_left_some = implant->is_preloaded() && !implant->seeds_of_current().empty();
        if (request.kind == Kind::undo && !has_left_some) break;  // the dropped seed is back in the needle
      }
      if (request.kind == Kind::clear) implant->clear();
      if (request.kind == Kind::undo) {
        if (const auto taken = implant->take_back(); !taken) return refuse(request, taken.error());
      }
      if (live) live->seeds().set(implant->rest_mm(), implant->seeds_of_current());
      break;
    case Kind::reset:
      if (live) place(request, insertion);
      break;
    case Kind::pause:
    case Kind::resume:
      if (!live) break;
      status.paused = request.kind == Kind::pause;
      status.paused ? live->runner().pause() : live->runner().resume();
      break;
    case Kind::step:
      if (live && status.paused) live->runner().single_step(static_cast<int>(std::clamp(request.number, 1.0, 100.0)));
      break;
  }
  say_status();
}

void Session::Parts::show_companion() {
  live->show_to(*settings.companion);
  if (std::string trouble = settings.companion->trouble(); trouble != companion_trouble) {
    if (!trouble.empty() && settings.say) settings.say(settings.companion->name() + ": " + trouble);
    companion_trouble = std::move(trouble);
  }
  std::string problem = live->device_problem(*settings.companion);
  if (problem == status.device_problem) return;
  status.device_problem = std::move(problem);
  next_status = {};
}

RoomReport Session::Parts::look_after_room() const {
  return make_room(settings.recordings, {.most_bytes = settings.keep_bytes},
                   settings.free_bytes ? settings.free_bytes : free_bytes);
}

void Session::Parts::heed_room() {
  const RoomReport report = room.report();
  if (!report.stop.empty()) live->stop_recording(report.stop);
  SessionStatus::Recording& told = status.recording;
  const std::string& problem = live->recording_problem();
  if (problem == told.problem && report.warning == told.warning) return;
  if (problem != told.problem && settings.say) settings.say("The recording " + told.name + ": " + problem + ".");
  told.problem = problem;
  told.warning = report.warning;
  next_status = {};
}

/// Where the needle is comes with the status: it changes seldom, and has to be said at once.
void Session::Parts::show_inside() {
  std::vector<std::string> inside = live ? live->inside() : replay->inside();
  if (inside == status.inside) return;
  status.inside = std::move(inside);
  next_status = {};
}

void Session::Parts::tick(double dt_s) {
  take_field();
  show_map();
  follow_implant();
  serve_images();
  show_images();
  std::shared_ptr<const LiveFrame> frame;
  if (live) {
    pump();
    frame = live->picture(whole_curve);
    if (settings.companion) show_companion();
    heed_room();
  } else if (replay) {
    const bool playing = replay->rate() > 0.0;
    replay->advance(dt_s);
    frame = replay->picture(whole_curve);
    if (frame) show_replayed_seeds();
    if (playing && replay->rate() == 0.0) next_status = {};  // the replay has reached its end: send the status at once
  }
  if (frame) {
    whole_curve = false;
    audience.show(std::move(frame));
    take_moment();
    show_inside();
  }
  if (Clock::now() >= next_status) say_status();
}

void Session::Parts::run(const std::stop_token& stop) {
  if (settings.replay.empty()) {
    open_model({.kind = Request::Kind::open_case, .viewer = 0, .text = {}, .number = 0.0}, 0,
               settings.cases.front().load);
  } else {
    if (auto started = start_replay(settings.replay); !started) fail(started.error());
  }
  say_status();
  const auto period =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / settings.pictures_per_s));
  auto before = Clock::now();
  while (!stop.stop_requested()) {
    std::deque<Request> waiting;
    {
      std::unique_lock lock(mutex);
      const auto next = is_implant_busy() ? std::min(before + period, Clock::now() + kImplantEvery) : before + period;
      wake.wait_until(lock, stop, next, [&] { return !requests.empty(); });
      waiting.swap(requests);
    }
    const auto begun = Clock::now();
    for (const Request& request : waiting) {
      if (!stop.stop_requested()) carry_out(request);
    }
    const auto now = Clock::now();
    before += now - begun;  // a replay does not advance while requests are carried out
    if (now < before + period) {
      if (is_implant_busy()) follow_implant();
      continue;
    }
    tick(std::chrono::duration<double>(now - before).count());
    before = now;
  }
  end_live();
}

}  // namespace stylet::serve
