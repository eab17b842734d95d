// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay_room.hpp"

#include "stylet/io/event_words.hpp"
#include "stylet/io/scenario_io.hpp"

#include <algorithm>

namespace stylet::serve {

Reply ReplayRoom::ask(const Request& request) {
  using enum Command::Do;
  switch (request.command.what) {
    case replay:
      return {ToReplay{request.command.text}};
    case live:
      return {ToLive{}};
    case seek:
      replay_->seek(request.command.number);
      return {};
    case play:
      replay_->play(request.command.number);
      return {};
    default:
      return {};
  }
}

Result<Reply> ReplayRoom::enter(const std::string& name, const CaseList& cases) {
  FolderLock in_use(shelf_.folder(name), FolderLock::Kind::shared);  // first, so that nobody removes it meanwhile
  auto recording = shelf_.read(name);
  if (!recording) return recording.error();
  auto scenario = parse_scenario(recording->info.scenario_text, name);
  if (!scenario) return scenario.error();
  if (recording->frames.empty() && recording->steps.empty())
    return failure(name, "the recording ends before its first step", "Choose another recording");
  PlannedInsertion plan;
  plan.entry = recording->info.entry_mm;
  plan.direction = recording->info.direction;
  plan.name = name;
  for (const Step& step : recording->steps) plan.depth_mm = std::max(plan.depth_mm, step.base_depth_mm);
  MadeScene made = make_scene(recording->mesh, recording->info.target_regions, *scenario, {plan},
                              recording->info.warnings, cases, nullptr);
  Reply reply;
  reply.show.emplace_back(std::move(made.scene));
  results::EventWords words;
  for (const Event& e : recording->events)
    reply.show.emplace_back(LiveEvent{to_string(e.kind), e.time_s, e.depth_mm, e.force_N, e.region, words.label(e)});
  reply.show.emplace_back(ShownPlan{});
  (void)leave();
  name_ = name;
  hole_ = scenario->insertions.front().hole.value_or("");
  in_use_ = std::move(in_use);
  // A copy of the mesh, since the replay may end while a picture of it is being made.
  patient_ = {.mesh = std::make_shared<const TetMesh>(recording->mesh),
              .scenario = *std::move(scenario),
              .gland = recording->info.target_regions,
              .is_recorded = true};
  replay_ = std::make_unique<Replay>(std::move(*recording), std::move(made.points));
  moments_ = std::make_unique<RecordedMoments>(replay_->recording());
  if (replay_->recording().implant) {
    seeds_ = std::make_unique<ReplayedSeeds>(*replay_);
    reply.show.emplace_back(seeds_->plan());
  }
  return reply;
}

Reply ReplayRoom::leave() {
  if (!replay_) return {};
  moments_.reset();
  seeds_.reset();
  replay_.reset();
  patient_ = {};
  in_use_ = {};
  name_.clear();
  inside_.clear();
  return {Stay{}, {ShownPlan{}}};
}

Reply ReplayRoom::tick(double dt_s, bool whole_curve) {
  Reply reply;
  const bool is_playing = replay_->rate() > 0.0;
  replay_->advance(dt_s);
  reply.is_urgent = is_playing && replay_->rate() == 0.0;  // it has reached its end
  auto frame = replay_->picture(whole_curve);
  if (!frame) return reply;
  if (seeds_) {
    if (auto news = seeds_->news()) reply.show.emplace_back(*std::move(news));
    reply.show.emplace_back(seeds_->places());
  }
  reply.show.emplace_back(std::move(frame));
  std::vector<std::string> inside = replay_->inside();
  reply.is_urgent = reply.is_urgent || inside != inside_;
  inside_ = std::move(inside);
  return reply;
}

std::pair<Moment, std::optional<ProbeSettings>> ReplayRoom::moment() const {
  return {moments_->at(replay_->time_s()), moments_->probe_at(replay_->time_s())};
}

void ReplayRoom::describe(SessionStatus& status) const {
  status.replay = {};
  if (!replay_) return;
  status.replay = {name_, replay_->time_s(), replay_->duration_s(), replay_->rate()};
  status.insertion = name_;
  status.hole = hole_;
  status.inside = inside_;
  status.device_problem.clear();
  status.recording = {};
  status.loop = {};
}

}  // namespace stylet::serve
