// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant_desk.hpp"

#include "scene.hpp"
#include "stylet/implant/needle_insertion.hpp"
#include "stylet/implant/seed_fate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace stylet::serve {

namespace {

constexpr double kSameHole_mm = 1.5;  // a needle whose line passes a hole's middle this near is put through this hole

/// The hole of the template on a needle's line, where the line passes the template; empty if there is none.
std::string hole_on(const InsertionPlan& plan, const Model& model) {
  const TemplateGrid& grid = model.scenario().grid;
  const std::array<double, 2> centre = template_centre(model.mesh(), model.target_regions(), grid);
  const Vec3 entry(plan.entry_mm->data()), direction(plan.direction->data());
  const Vec3 at = entry - grid.distance_mm * direction;
  std::string nearest;
  double least = kSameHole_mm;
  for (const std::string& column : grid.columns) {
    for (const std::string& row : grid.rows) {
      const auto offset = grid.offset_mm(column + row);
      if (!offset) continue;
      const double off = std::hypot(at.x() - centre[0] - (*offset)[0], at.y() - centre[1] + (*offset)[1]);
      if (off >= least) continue;
      least = off;
      nearest = column + row;
    }
  }
  return nearest;
}

}  // namespace

Result<std::unique_ptr<ImplantDesk>> ImplantDesk::open(std::shared_ptr<const ImplantCase> implant,
                                                       const std::shared_ptr<const Model>& model,
                                                       const std::string& where) {
  std::unique_ptr<ImplantDesk> desk(new ImplantDesk());
  desk->implant_ = implant;
  desk->fate_ = model->scenario().seed;
  desk->plan_.technique = model->scenario().procedure.technique;
  RecordedPlan& plan = desk->plan_.plan;
  plan.seed_length_mm = implant->source.outer_length_mm;
  plan.seed_diameter_mm = implant->source.outer_diameter_mm;
  plan.prescription_Gy = implant->prescription_Gy();
  plan.source = implant->source.name;
  std::vector<std::string> names;
  for (const NeedleLoad& load : implant->needles) {
    Result<InsertionPlan> insertion = needle_insertion(load, model->scenario(), model->locator(), where);
    if (!insertion) return insertion.error();
    plan.needles.push_back({load.name, hole_on(*insertion, *model), Vec3(insertion->entry_mm->data()), load.direction,
                            insertion->depth_mm});
    for (const LoadedSeed& seed : load.seeds) {
      plan.seeds.push_back({seed.number, plan.needles.size() - 1, seed.planned_mm, seed.axis,
                            drop_depth_mm(insertion->depth_mm, seed, plan.seed_length_mm)});
    }
    desk->state_.planned_seeds += load.seeds.size();
    desk->insertions_.push_back(*std::move(insertion));
    names.push_back(fmt::format("{}, needle {}", where, load.name));
  }
  auto dose = ImplantDose::open(std::move(implant));
  if (!dose) return dose.error();
  desk->dose_ = *std::move(dose);
  desk->models_ = std::make_unique<NeedleModels>(model, desk->insertions_, std::move(names));
  desk->seeds_have_changed();
  return desk;
}

std::optional<std::size_t> ImplantDesk::needle_through(const std::string& hole) const {
  const auto& needles = plan().needles;
  const auto found = std::ranges::find(needles, hole, &RecordedPlan::Needle::hole);
  if (hole.empty() || found == needles.end()) return std::nullopt;
  return static_cast<std::size_t>(found - needles.begin());
}

std::optional<std::size_t> ImplantDesk::needle_of(const Model& model) const {
  const auto& insertions = model.scenario().insertions;
  if (insertions.size() != 1) return std::nullopt;
  const auto found = std::find(insertions_.begin(), insertions_.end(), insertions.front());
  if (found == insertions_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - insertions_.begin());
}

void ImplantDesk::set_current(std::optional<std::size_t> needle) {
  plan_.plan.current = needle ? static_cast<int>(*needle) : -1;
  plan_changed_ = true;
}

void ImplantDesk::begin_recording(const std::string& name) {
  if (plan_.plan.implant.empty()) plan_.plan.implant = name;
  plan_.plan.before = state_.tally;
  present_tally_ = {};
}

void ImplantDesk::count(const Event& event) {
  const ImplantTally before = state_.tally;
  present_tally_.add(event, state_.tally);
  state_changed_ = state_changed_ || state_.tally != before;
}

void ImplantDesk::set_train(std::optional<double> from_mm) {
  state_changed_ = state_changed_ || from_mm != state_.train_from_mm;
  state_.train_from_mm = from_mm;
}

std::vector<double> ImplantDesk::train_mm() const {
  std::vector<double> behind;
  if (plan().current < 0) return behind;
  const std::vector<LoadedSeed>& seeds = present().seeds;
  for (std::size_t k = seeds_of_current().size(); k < seeds.size(); ++k) behind.push_back(seeds[k].behind_tip_mm);
  return behind;
}

std::vector<std::size_t> ImplantDesk::seeds_of_current() const {
  std::vector<std::size_t> own;
  for (std::size_t k = 0; k < state_.seeds.size(); ++k) {
    if (static_cast<int>(state_.seeds[k].needle) == plan().current) own.push_back(k);
  }
  return own;
}

Result<LoadedSeed> ImplantDesk::next_seed() const {
  if (plan().current < 0) {
    return input_error("the needle", "the plan has no seeds for this hole, so there is none to drop",
                       "Choose a needle of the plan");
  }
  const NeedleLoad& needle = present();
  const std::size_t dropped = seeds_of_current().size();
  if (dropped >= needle.seeds.size()) {
    return input_error("needle " + needle.name, fmt::format("all its {} seeds have been dropped", needle.seeds.size()),
                       "Choose the next needle of the plan, or take the last seed back");
  }
  return needle.seeds[dropped];
}

Result<SeedHistory> ImplantDesk::add(const ProbedDrop& drop) {
  const Result<LoadedSeed> seed = next_seed();
  if (!seed) return seed.error();
  if (!drop.tip_in_tissue) {
    return input_error("needle " + present().name, "its tip is not in the tissue, so no seed was dropped",
                       "Push the needle in first");
  }
  SeedHistory h;
  h.number = seed->number;
  h.needle = static_cast<std::size_t>(plan().current);
  h.planned_mm = seed->planned_mm;
  h.dropped_mm = vec3(drop.place);
  h.rest_mm = vec3(drop.rest);
  h.axis = vec3(drop.axis);
  h.dropped_s = drop.time_s;
  h.in_tissue = drop.found;
  h.explain(vec3(drop.straight) - h.planned_mm, vec3(drop.lasting));
  dropped_.push_back(h);
  seeds_have_changed();
  return state_.seeds.back();
}

Result<> ImplantDesk::take_back() {
  if (dropped_.empty()) return input_error("the last seed", "no seed has been dropped yet", "Drop one first");
  const std::size_t needle = dropped_.back().needle;
  dropped_.pop_back();
  while (is_preloaded() && !dropped_.empty() && dropped_.back().needle == needle) dropped_.pop_back();
  seeds_have_changed();
  return Ok{};
}

void ImplantDesk::clear() {
  dropped_.clear();
  state_.tally = {};
  plan_.plan.implant.clear();
  seeds_have_changed();
}

Result<> ImplantDesk::go_on_with(const InterruptedImplant& implant) {
  std::vector<std::size_t> dropped(plan().needles.size(), 0);  // seeds of each needle
  for (const SeedHistory& seed : implant.seeds) {
    const bool is_next = seed.needle < dropped.size() &&
                         dropped[seed.needle] < implant_->needles[seed.needle].seeds.size() &&
                         implant_->needles[seed.needle].seeds[dropped[seed.needle]].number == seed.number &&
                         seed.rest_mm.allFinite() && seed.dropped_mm.allFinite() && seed.axis.allFinite();
    if (!is_next) {
      return input_error(implant.recording, fmt::format("its seed {} is not one of this plan", seed.number + 1),
                         "Begin the implant anew");
    }
    ++dropped[seed.needle];
  }
  dropped_.clear();
  for (const SeedHistory& seed : implant.seeds) dropped_.push_back(as_dropped(seed));
  state_.tally = implant.tally;
  plan_.plan.implant = implant.name;
  seeds_have_changed();
  return Ok{};
}

/// Lets the seeds of each needle settle. A needle's seeds have been dropped from its tip on, and each of them draws the
/// same random numbers however many follow, so that only a strand moves seeds that were there before.
void ImplantDesk::settle() {
  state_.seeds = dropped_;
  for (std::size_t needle = 0; needle < plan().needles.size(); ++needle) {
    std::vector<SeedHistory> own;
    for (const SeedHistory& seed : dropped_) {
      if (seed.needle == needle) own.push_back(seed);
    }
    if (own.empty()) continue;
    settle_seeds(own, fate_, needle);
    auto settled = own.begin();
    for (SeedHistory& seed : state_.seeds) {
      if (seed.needle == needle) seed = *settled++;
    }
  }
}

void ImplantDesk::seeds_have_changed() {
  settle();
  std::vector<PlacedSource> placed;
  for (const SeedHistory& seed : state_.seeds) {
    if (!seed.lost) placed.push_back({seed.rest_mm, seed.axis, implant_->plan.sources[seed.number].strength_U});
  }
  dose_version_ = dose_->set(std::move(placed));
  state_.is_computing = true;
  state_changed_ = true;
}

std::vector<Vec3> ImplantDesk::rest_mm() const {
  std::vector<Vec3> places;
  for (const SeedHistory& seed : state_.seeds) places.push_back(seed.rest_mm);
  return places;
}

void ImplantDesk::show_again() { plan_changed_ = state_changed_ = grid_changed_ = true; }

ImplantDesk::Changes ImplantDesk::take_changes() {
  if (const auto ready = models_->news()) {
    plan_.ready = *ready;
    plan_changed_ = true;
  }
  ImplantDose::News news = dose_->news();
  state_changed_ = state_changed_ || news.is_any();
  if (news.planned) state_.planned = std::move(news.planned);
  if (news.now) {
    state_.is_computing = news.version != dose_version_ || news.now->goals.empty();
    state_.now = std::move(news.now);
    score_version_ = news.version;
  }
  if (news.grid) {
    grid_ = std::move(news.grid);
    grid_changed_ = true;
  }
  if (news.problem) {
    state_.is_computing = false;
    state_changed_ = true;
  }
  return {std::exchange(plan_changed_, false), std::exchange(state_changed_, false),
          std::exchange(grid_changed_, false) ? grid_ : nullptr, std::move(news.problem)};
}

}  // namespace stylet::serve
