// SPDX-License-Identifier: GPL-3.0-or-later
#include "open_case.hpp"

#include "stylet/core/parallel.hpp"
#include "stylet/sim/plan.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet::serve {

namespace {

// SessionStatus::stage while the session is ready and a part of the picture is missing.
constexpr const char* kFieldStage = "the picture of the tissue's motion";
constexpr const char* kNoField = "how the tissue moves cannot be shown: ";

/// The insertion through a hole: the case's own if it plans one, otherwise a copy of its first insertion through this
/// hole, to the far end of the target.
InsertionPlan plan_for(const std::vector<InsertionPlan>& plans, const std::string& hole) {
  const auto known = std::find_if(plans.begin(), plans.end(), [&](const auto& p) { return p.hole == hole; });
  if (known != plans.end()) return *known;
  InsertionPlan plan = plan_through(plans.front(), hole);
  plan.depth_mm = 0.0;
  return plan;
}

std::size_t number_of(const Request& request) {
  return static_cast<std::size_t>(std::max(0.0, request.command.number));
}

Reply missing(const Request& request, const char* what, std::size_t count) {
  return Reply::refusal(request, input_error(what,
                                             fmt::format("there is no number {}; the {} entries are counted from 0",
                                                         number_of(request), count),
                                             "Choose one of these numbers"));
}

}  // namespace

Reply OpenCase::ask(const Request& request) {
  using enum Command::Do;
  const std::size_t number = number_of(request);
  switch (request.command.what) {
    case open_case:
      if (number >= settings_.cases.size()) return missing(request, "case", settings_.cases.size());
      return {ToOpen{number, settings_.cases[number].load}};
    case hole:
      return choose_hole(request);
    case insertion:
      if (number >= insertions_.size()) return missing(request, "insertion", insertions_.size());
      if (implant_) return choose_needle(number);
      return choose_plan(request, scenario_.insertions[number], insertions_[number].name);
    case needle: {
      const std::size_t count = implant_ ? implant_->plan().needles.size() : 0;
      return number < count ? choose_needle(number) : missing(request, "needle of the plan", count);
    }
    case interrupted:
      return answer_offer(request);
    case reset:
      return put(insertion_);
    case predict:
      if (map_maker_) map_maker_->want_predictions(request.command.number > 0.0);
      return {};
    case drawn:
      page_has_drawn_ = true;
      if (field_maker_) field_maker_->begin();
      return {};
    default:
      return {};
  }
}

Reply OpenCase::choose_hole(const Request& request) {
  const std::string& hole = request.command.text;
  if (implant_) {
    if (const auto needle = implant_->needle_through(hole)) return choose_needle(*needle);
  }
  return choose_plan(request, plan_for(scenario_.insertions, hole), "hole " + hole);
}

/// An insertion by a plan in the same patient. The model is compiled for this plan unless the open model has it.
Reply OpenCase::choose_plan(const Request& request, const InsertionPlan& plan, const std::string& where) {
  const auto& there = open_.model->scenario().insertions;
  if (const auto known = std::ranges::find(there, plan); known != there.end())
    return put(static_cast<std::size_t>(known - there.begin()));
  // An impossible plan is refused before the current insertion ends.
  Scenario scenario = scenario_;
  scenario.insertions = {plan};
  if (auto good = check_scenario(scenario, where); !good) return Reply::refusal(request, good.error());
  if (auto good = plan_insertion(*open_.model, plan, where); !good) return Reply::refusal(request, good.error());
  return {other_needle(plan, where)};
}

/// A needle of the plan of seeds: at once if its model is compiled.
Reply OpenCase::choose_needle(std::size_t which) {
  const auto ready = implant_->models().find(which);
  if (!ready) return {other_needle(implant_->insertions()[which], "needle " + implant_->plan().needles[which].name)};
  const auto load = [made = LoadedCase{ready->model, open_.notes}](const Progress&) -> Result<LoadedCase> {
    return made;
  };
  return {ToOpen{.number = number_, .load = load, .is_other_needle = true, .is_compiled = true, .field = ready->field}};
}

/// The implant that can be gone on with; null: there is none, or seeds of another one have been dropped.
const InterruptedImplant* OpenCase::offer() const {
  return search_ && implant_ && implant_->state().seeds.empty() ? search_->found() : nullptr;
}

/// Takes the interrupted implant up, with the needle that it had in front of the patient; or leaves it.
Reply OpenCase::answer_offer(const Request& request) {
  const InterruptedImplant* implant = offer();
  if (!implant) {
    return Reply::refusal(
        request, input_error("the implant", "there is none to go on with", "Carry out the plan from its first needle"));
  }
  if (request.command.number <= 0.0) {
    leaving_.add(std::exchange(search_, nullptr));
    return {};
  }
  Reply reply = choose_needle(implant->needle);
  std::get<ToOpen>(reply.next).goes_on = true;
  return reply;
}

ToOpen OpenCase::other_needle(const InsertionPlan& plan, const std::string& where) const {
  const auto load = [plan, where, needles = OtherNeedles(*open_.model),
                     notes = open_.notes](const Progress& progress) -> Result<LoadedCase> {
    const auto model = needles.compile(plan, where, progress);
    if (!model) return model.error();
    return LoadedCase{*model, notes};
  };
  return {number_, load, true};
}

Result<Reply> OpenCase::open(const ToOpen& what, const Progress& progress) {
  const double before = work_seconds();
  auto loaded = what.load(progress);
  if (!loaded) return loaded.error();
  log(*loaded->model, "the model", work_seconds() - before);
  if (auto usable = DisplayField::check(*loaded->model); !usable) return usable.error();
  std::shared_ptr<ImplantDesk> implant;
  if (loaded->implant && !what.is_other_needle) {
    auto desk = ImplantDesk::open(loaded->implant, loaded->model, settings_.cases[what.number].title);
    if (!desk) return desk.error();
    implant = *std::move(desk);
  }
  if (what.goes_on) {
    if (auto done = implant_->go_on_with(*offer()); !done) return done.error();
    leaving_.add(std::exchange(search_, nullptr));
  }
  Reply reply;
  leaving_.add(std::exchange(field_maker_, nullptr));
  open_ = {.model = loaded->model, .notes = std::move(loaded->notes), .field = what.field, .points = {}, .way = 0};
  number_ = what.number;
  if (!what.is_other_needle) begin_case(std::move(implant), reply);
  show_scene(0, reply);
  if (!what.is_other_needle) begin_map();
  if (!open_.field) {
    field_maker_ = std::make_shared<FieldMaker>(
        open_.model, std::chrono::duration<double>(page_has_drawn_ ? 0.0 : settings_.field_waits_s));
  }
  return put(0, std::move(reply));
}

/// Takes over what the newly opened model plans, or the plan of seeds that its case has.
void OpenCase::begin_case(std::shared_ptr<ImplantDesk> implant, Reply& reply) {
  if (implant_ && !implant) reply.show.emplace_back(ShownPlan{});
  leaving_.add(std::exchange(implant_, std::move(implant)));
  leaving_.add(std::exchange(search_, nullptr));
  scenario_ = open_.model->scenario();
  insertions_ = open_.model->insertions();
  if (!implant_) return;
  search_ = std::make_shared<ImplantSearch>(Shelf(settings_.recordings, settings_.archive), implant_->plan());
  scenario_.insertions.clear();
  insertions_.clear();
  for (std::size_t k = 0; k < implant_->insertions().size(); ++k) {
    const RecordedPlan::Needle& needle = implant_->plan().needles[k];
    InsertionPlan& of = scenario_.insertions.emplace_back(implant_->insertions()[k]);
    if (!needle.hole.empty()) of.hole = needle.hole;
    PlannedInsertion& shown = insertions_.emplace_back();
    shown.name = needle.name;
    shown.entry = needle.entry_mm;
    shown.direction = needle.direction;
    shown.depth_mm = needle.depth_mm;
  }
}

void OpenCase::begin_map() {
  leaving_.add(std::move(map_maker_));
  map_maker_ = std::make_shared<MapMaker>(
      open_.model, [plans = scenario_.insertions, has_plan = implant_ != nullptr](const std::string& hole) {
        const InsertionPlan plan = plan_for(plans, hole);
        return has_plan ? plan_through(plan, hole) : plan;
      });
  map_ = {};
  map_is_shown_ = false;
}

/// Makes the scene, with finer surfaces along the planned path of one of the model's insertions.
void OpenCase::show_scene(std::size_t way, Reply& reply) {
  const Model& model = *open_.model;
  MadeScene made = make_scene(model.mesh(), model.target_regions(), scenario_, insertions_, open_.warnings(), list(),
                              &model.insertions()[way]);
  open_.points = std::move(made.points);
  open_.way = way;
  if (settings_.companion) settings_.companion->show(*made.scene);
  reply.show.emplace_back(std::move(made.scene));
}

Message OpenCase::scene() {
  Reply reply;
  show_scene(insertion_, reply);
  return reply.show.front();
}

/// Adds the transition to one of the open model's insertions.
Reply OpenCase::put(std::size_t which, Reply reply) {
  insertion_ = which;
  if (open_.way != which) show_scene(which, reply);
  NeedleStart start{open_,
                    which,
                    open_.model->insertions()[which].name,
                    open_.model->scenario().insertions[which].hole.value_or(""),
                    implant_,
                    std::nullopt};
  if (implant_) start.needle = implant_->needle_of(*open_.model);
  if (start.needle) {
    start.name = implant_->plan().needles[*start.needle].name;
    start.hole = implant_->plan().needles[*start.needle].hole;
  }
  keep_needle();
  reply.next = ToLive{std::move(start)};
  return reply;
}

Reply OpenCase::last_needle(const Request& request) {
  if (settings_.cases.empty()) return missing(request, "case", 0);
  if (!is_open()) return {ToOpen{number_, settings_.cases[number_].load}};
  return put(insertion_, {Stay{}, {scene()}});
}

/// Keeps the open model if it is that of a needle of the plan. Once its displacement field is complete, the models of
/// the other needles are compiled.
void OpenCase::keep_needle() {
  const auto needle = implant_ ? implant_->needle_of(*open_.model) : std::nullopt;
  if (!needle) return;
  implant_->models().keep(*needle, {open_.model, open_.field});
  if (!field_maker_) implant_->models().begin_after(*needle);
}

/// Logs the processor time [s] of a part of an open needle.
void OpenCase::log(const Model& model, const char* part, double seconds) const {
  if (!settings_.log) return;
  settings_.log(fmt::format("{} for {} in {} nodes: {:.2f} s of processor time", part, model.insertions().front().name,
                            model.mesh().node_count(), seconds));
}

bool OpenCase::take_field() {
  leaving_.forget_ended();
  if (!field_maker_ || !field_maker_->done()) return false;
  log(*open_.model, "the picture of the tissue's motion", field_maker_->seconds());
  open_.field = field_maker_->field();
  no_field_ = field_maker_->problem();
  field_maker_.reset();
  keep_needle();
  return true;
}

std::optional<Message> OpenCase::map_news(bool is_replaying) {
  std::optional<LiveMap> news = map_maker_ ? map_maker_->news() : std::nullopt;
  if (news) map_ = std::move(*news);
  if (!news && map_is_shown_ != is_replaying) return std::nullopt;
  map_is_shown_ = !is_replaying;
  return is_replaying ? LiveMap{} : map_;
}

CaseList OpenCase::list() const {
  CaseList list;
  for (const CaseSource& source : settings_.cases) list.titles.push_back(source.title);
  list.open = number_;
  list.dt_ms = 1e3 * settings_.runner.period_s;
  return list;
}

ImageSubject OpenCase::patient() const {
  return {std::shared_ptr<const TetMesh>(open_.model, &open_.model->mesh()), scenario_, open_.model->target_regions(),
          open_.field};
}

void OpenCase::describe(SessionStatus& status) const {
  status.interrupted.reset();
  if (!is_open()) return;
  if (const InterruptedImplant* implant = offer()) {
    status.interrupted = {implant->recording, implant->recorded_s, implant->seeds.size(), implant_->plan().seeds.size(),
                          implant_->plan().needles[implant->needle].name};
  }
  status.stage = field_maker_ ? kFieldStage : open_.field ? "" : kNoField + no_field_;
  status.fraction = field_maker_ ? field_maker_->fraction() : -1.0;
}

}  // namespace stylet::serve
