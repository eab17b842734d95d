// SPDX-License-Identifier: GPL-3.0-or-later
#include "live_room.hpp"

#include "implant_desk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace stylet::serve {

namespace {

constexpr std::size_t kMostEvents = 1000;

HandTarget resting() {
  HandTarget rest;
  rest.rest = true;
  return rest;
}

}  // namespace

LiveRoom::LiveRoom(const SessionSettings& settings)
    : settings_(settings),
      shelf_(settings.recordings, settings.archive),
      watch_(
          [&settings] {
            return make_room(settings.recordings, {.most_bytes = settings.keep_bytes},
                             settings.free_bytes ? settings.free_bytes : free_bytes);
          },
          settings.say, std::chrono::milliseconds(std::lround(1e3 * settings.room_every_s))) {}

Result<Reply> LiveRoom::enter(const NeedleStart& start) {
  Reply reply = hold();
  // The former run ends after the next one has started: locking the memory of all models anew would take a second.
  if (run_) pump(reply);
  const std::unique_ptr<LiveRun> former = std::move(run_);
  watch_.set_recording(false);
  if (std::exchange(is_aside_, false) && start.implant) start.implant->show_again();
  implant_ = start.implant;
  std::optional<RecordedPlan> plan;
  const std::string name = shelf_.new_name(start.name);
  if (implant_) {
    implant_->set_current(start.needle);
    implant_->set_train(std::nullopt);
    implant_->begin_recording(name);
    plan = implant_->plan();
  }
  std::unique_ptr<Device> other = settings_.companion ? settings_.companion->device() : nullptr;
  told_ = {};
  told_.insertion = start.name;
  told_.hole = start.hole;
  told_.recording.name = name;
  told_.device = other ? settings_.companion->name() : "page";
  auto run = LiveRun::start(start.open, start.insertion, shelf_.folder(name), settings_.runner,
                            settings_.recorded_frames_per_s, std::move(other), plan ? &*plan : nullptr, settings_.say);
  if (!run) {
    told_.recording = {};
    return run.error();
  }
  run_ = std::move(*run);
  watch_.set_recording(true);
  hand_.give(run_->hand());
  words_ = {};
  happened_ = {
      {.kind = "started", .time_s = 0.0, .depth_mm = 0.0, .force_N = 0.0, .region = start.name, .label = "Start"}};
  reply.show.emplace_back(happened_.front());
  if (!implant_) return reply;
  run_->record_implant(implant_->state(), implant_->is_score_current());
  set_seeds();
  return reply;
}

void LiveRoom::end() {
  hand_.give(nullptr);
  Reply untold;
  if (run_) pump(untold);
  run_.reset();
  watch_.set_recording(false);
}

void LiveRoom::pump(Reply& reply) {
  run_->pump([&](const Event& is) {
    if (implant_) implant_->count(is);
    const LiveEvent event{to_string(is.kind), is.time_s, is.depth_mm, is.force_N, is.region, words_.label(is)};
    happened_.push_back(event);
    if (happened_.size() > kMostEvents) happened_.erase(happened_.begin() + 1);  // keeps the first event, "started"
    reply.show.emplace_back(event);
  });
}

Reply LiveRoom::hold() {
  Reply reply;
  if (!is_live()) return reply;
  hand_.give(nullptr);
  if (run_->hand()) run_->hand()->aim(resting());
  run_->runner().pause();
  pump(reply);
  return reply;
}

void LiveRoom::freeze() {
  if (is_live()) run_->runner().pause();
}

void LiveRoom::go_on() {
  if (!is_live()) return;
  hand_.give(run_->hand());
  if (!told_.paused) run_->runner().resume();
}

Reply LiveRoom::set_aside() {
  Reply reply = hold();
  is_aside_ = true;
  return reply;
}

Reply LiveRoom::come_back() {
  is_aside_ = false;
  if (implant_) implant_->show_again();
  go_on();
  return {Stay{}, {happened_.begin(), happened_.end()}};
}

Reply LiveRoom::ask(const Request& request) {
  using enum Command::Do;
  switch (request.command.what) {
    case pause:
    case resume:
      told_.paused = request.command.what == pause;
      told_.paused ? run_->runner().pause() : run_->runner().resume();
      return {};
    case step:
      if (told_.paused) run_->runner().single_step(static_cast<int>(std::clamp(request.command.number, 1.0, 100.0)));
      return {};
    case drop:
      return drop_seed(request);
    case undo:
    case clear:
      return take_back(request);
    default:
      return {};
  }
}

Reply LiveRoom::drop_seed(const Request& request) {
  const auto no = [&](const std::string& why, const std::string& cure) {
    return Reply::refusal(request, Notice{why, cure});
  };
  if (!implant_) return no("this case has no plan of seeds", "Open a scenario with [plan]");
  if (!is_live()) return no("no needle is in your hand now, so no seed can be dropped", "Return to the live needle");
  if (told_.paused) return no("the simulation is paused, so no seed can be dropped", "Resume it, then drop the seed");
  if (run_->seeds().dropping() > 0) {
    if (implant_->is_preloaded()) return no("the train is being left already", "Draw the needle back over it");
    return {};  // the key was pressed twice within some hundredths of a second
  }
  if (const auto seed = implant_->next_seed(); !seed) return Reply::refusal(request, seed.error());
  dropper_ = request.viewer;
  run_->record_next_picture();  // the needle may have come here a moment ago
  const double half_mm = 0.5 * implant_->plan().seed_length_mm;
  if (!implant_->is_preloaded()) {
    run_->seeds().order_drop(half_mm);
    return {};
  }
  const std::vector<double> behind = implant_->train_mm();
  if (behind.size() > TissueProbe::kTrain) {
    return no(fmt::format("the needle has {} seeds, and the live page can leave at most {} as a train", behind.size(),
                          TissueProbe::kTrain),
              "Set procedure.technique = \"pushed\"");
  }
  run_->seeds().order_train(behind, half_mm);
  return {};
}

/// Takes the last seed back, or all.
Reply LiveRoom::take_back(const Request& request) {
  const bool is_all = request.command.what == Command::Do::clear;
  if (!implant_) return {};
  if (is_aside_) {
    return Reply::refusal(request, input_error("the seeds", "a recording is being shown, whose seeds cannot be changed",
                                               "Return to the live needle"));
  }
  if (run_ && run_->seeds().dropping() > 0) {
    run_->seeds().call_off();
    const bool has_left_some = implant_->is_preloaded() && !implant_->seeds_of_current().empty();
    if (!is_all && !has_left_some) return {};  // the dropped seed is back in the needle
  }
  if (is_all) {
    implant_->clear();
  } else if (const auto taken = implant_->take_back(); !taken) {
    return Reply::refusal(request, taken.error());
  }
  set_seeds();
  return follow_implant();
}

void LiveRoom::set_seeds() {
  if (run_) run_->seeds().set(implant_->rest_mm(), implant_->seeds_of_current());
}

/// Takes up a finished drop.
void LiveRoom::take_drop(Reply& reply) {
  const auto drop = run_->seeds().take_drop();
  if (!drop) return;
  const Result<SeedHistory> added = implant_->add(*drop);
  if (!added) {
    reply.show.emplace_back(Refusal{dropper_, notice_of(added.error())});
    return;
  }
  if (added->lost) {
    reply.show.emplace_back(Refusal{
        dropper_,
        {fmt::format("Seed {} of needle {} is lost: it has left the patient and gives no dose.",
                     implant_->seeds_of_current().size(), implant_->plan().needles[added->needle].name),
         fmt::format("The scenario loses {} % of the seeds (seed.loss_percent).", implant_->fate().loss_percent)}});
  }
  set_seeds();
  if (drop->found) return;
  reply.show.emplace_back(Refusal{dropper_,
                                  {"The motion of the tissue is not known where this seed was dropped; it is counted "
                                   "as resting there.",
                                   "Take it back, and drop it nearer to the planned path of the needle."}});
}

Reply LiveRoom::follow_implant() {
  Reply reply;
  if (!implant_ || is_aside_) return reply;
  if (run_) {
    take_drop(reply);
    implant_->set_train(implant_->is_preloaded() ? run_->seeds().began_at_mm() : std::nullopt);
  }
  ImplantDesk::Changes changes = implant_->take_changes();
  if (run_ && changes.state) run_->record_implant(implant_->state(), implant_->is_score_current());
  if (changes.plan) reply.show.emplace_back(implant_->shown_plan());
  if (changes.state) reply.show.emplace_back(implant_->state());
  if (changes.dose) reply.show.emplace_back(std::move(changes.dose));
  if (changes.problem) reply.show.emplace_back(Refusal{0, notice_of(*changes.problem)});
  if (!run_) return reply;
  if (auto places = run_->seeds().news()) reply.show.emplace_back(LiveSeeds{std::move(*places)});
  return reply;
}

bool LiveRoom::is_busy() const {
  return implant_ && !is_aside_ && (implant_->state().is_computing || (run_ && run_->seeds().dropping() > 0));
}

Reply LiveRoom::tick(bool whole_curve) {
  Reply reply;
  if (!run_) return reply;
  pump(reply);
  auto frame = run_->picture(whole_curve);
  if (settings_.companion) show_companion(reply);
  heed_disk(reply);
  if (!frame) return reply;
  reply.show.emplace_back(std::move(frame));
  // Where the needle is comes with the status: it changes seldom, and has to be said at once.
  std::vector<std::string> inside = run_->inside();
  reply.is_urgent = reply.is_urgent || inside != told_.inside;
  told_.inside = std::move(inside);
  return reply;
}

void LiveRoom::show_companion(Reply& reply) {
  Companion& companion = *settings_.companion;
  run_->show_to(companion);
  std::string problem = run_->device_problem(companion);
  reply.is_urgent = reply.is_urgent || problem != told_.device_problem;
  told_.device_problem = std::move(problem);
}

void LiveRoom::heed_disk(Reply& reply) {
  const RoomReport report = watch_.report();
  if (!report.stop.empty()) run_->stop_recording(report.stop);
  SessionStatus::Recording& told = told_.recording;
  const std::string& problem = run_->recording_problem();
  if (problem == told.problem && report.warning == told.warning) return;
  if (problem != told.problem && settings_.say) settings_.say("The recording " + told.name + ": " + problem + ".");
  told.problem = problem;
  told.warning = report.warning;
  reply.is_urgent = true;
}

void LiveRoom::set_field(const std::shared_ptr<const DisplayField>& field) {
  if (run_) run_->set_field(field);
}

void LiveRoom::record_probe(const ProbeSettings& probe) {
  if (is_live()) run_->record_probe(probe);
}

std::optional<LoopState> LiveRoom::moment() {
  if (!run_ || run_->time_s() <= 0.0) return std::nullopt;
  LoopState state = loop_state(run_->runner().snapshot());
  if (!implant_) return state;
  const std::vector<SeedHistory>& dropped = implant_->state().seeds;
  const std::vector<Vec3> now = run_->seeds().now_mm();
  std::optional<std::size_t> last_needle;
  for (std::size_t k = 0; k < std::min(now.size(), dropped.size()); ++k) {
    if (dropped[k].lost) continue;
    join_to_last(state.seeds, implant_->fate().stranded && dropped[k].needle == last_needle);
    last_needle = dropped[k].needle;
    state.seeds.push_back(
        {now[k], dropped[k].axis, implant_->plan().seed_length_mm, implant_->plan().seed_diameter_mm});
  }
  return state;
}

void LiveRoom::describe(SessionStatus& status) const {
  status.paused = told_.paused;
  status.insertion = told_.insertion;
  status.hole = told_.hole;
  status.inside = told_.inside;
  status.device = told_.device;
  status.device_problem = told_.device_problem;
  status.recording = told_.recording;
  status.seed_off_mm = is_live() ? run_->seed_off_mm() : std::nullopt;
  if (!run_) return;
  status.recording.seconds = run_->time_s();
  status.loop = run_->loop();
}

}  // namespace stylet::serve
