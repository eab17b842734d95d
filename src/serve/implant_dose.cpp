// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant_dose.hpp"

#include "stylet/core/survive.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace stylet::serve {

namespace {

constexpr double kGridSpacing_mm = 1.5;
constexpr double kAroundTarget_mm = 12.0;
constexpr double kMostGridPoints = 200'000.0;

bool is_same(const PlacedSource& a, const PlacedSource& b) {
  return a.at_mm == b.at_mm && a.axis == b.axis && a.weight == b.weight;
}

/// The target has the region "prostate".
bool is_target(const DoseStructure& structure) { return structure.region == "prostate"; }

bool has_goal(const DoseStructure& structure, const std::vector<DoseGoal>& goals) {
  return std::any_of(goals.begin(), goals.end(), [&](const DoseGoal& goal) {
    return goal.structure == structure.region || goal.structure == structure.name;
  });
}

/// Every so many samples of a structure, each for as much more volume.
StructureSamples thinned(const StructureSamples& all, std::size_t most) {
  const std::size_t stride = (all.points.size() + most - 1) / most;
  if (stride <= 1) return all;
  StructureSamples some;
  double volume = 0.0;
  for (std::size_t k = stride / 2; k < all.points.size(); k += stride) {
    some.points.push_back(all.points[k]);
    some.volume_mm3.push_back(all.volume_mm3[k]);
    volume += all.volume_mm3[k];
  }
  const double scale = 1000.0 * all.volume_cc() / volume;
  for (double& v : some.volume_mm3) v *= scale;
  return some;
}

}  // namespace

class ImplantDose::Field {
 public:
  /// @param factor from a dose rate [cGy/h] at the implantation to a dose [Gy]
  Field(const std::vector<Vec3>& points, const Swelling& swelling, std::span<const SwollenTime> times, double factor)
      : swelling_(swelling), dose_(points.size(), 0.0) {
    for (const SwollenTime& time : times) {
      Part& part = parts_.emplace_back(Part{time, factor * time.share, points});
      for (Vec3& x : part.points) x = swelling_.moved(x, time.factors);
    }
  }

  /// Brings the dose to that of these seeds: takes away those that have gone, and adds the new ones.
  void bring_to(const RateTable& table, const std::vector<PlacedSource>& seeds) {
    const std::vector<PlacedSource> before = std::exchange(added_, {});  // stays empty if an exception ends this
    std::size_t kept = 0;
    while (kept < std::min(seeds.size(), before.size()) && is_same(seeds[kept], before[kept])) ++kept;
    if (kept == 0) {
      std::fill(dose_.begin(), dose_.end(), 0.0);
    } else {
      for (std::size_t k = kept; k < before.size(); ++k) add(table, before[k], -1.0);
    }
    for (std::size_t k = kept; k < seeds.size(); ++k) add(table, seeds[k], 1.0);
    added_ = seeds;
  }
  [[nodiscard]] const std::vector<double>& dose_Gy() const { return dose_; }

 private:
  struct Part {
    SwollenTime time;
    double factor = 1.0;  ///< from the rate [cGy/h] to the dose [Gy] of this part of the time
    std::vector<Vec3> points;
  };
  void add(const RateTable& table, PlacedSource seed, double sign) {
    for (const Part& part : parts_) {
      PlacedSource then = seed;
      then.at_mm = swelling_.moved(seed.at_mm, part.time.factors);
      then.axis = part.time.factors.cwiseProduct(seed.axis).normalized();
      then.weight = sign * seed.weight * part.factor;
      table.add(then, part.points, dose_);
    }
  }

  Swelling swelling_;
  std::vector<Part> parts_;
  std::vector<double> dose_;
  std::vector<PlacedSource> added_;
};

struct ImplantDose::Structure {
  std::string name, region;
  std::vector<Vec3> points;
  std::vector<double> volume_mm3;
  Field field;
};

Result<std::unique_ptr<ImplantDose>> ImplantDose::open(std::shared_ptr<const ImplantCase> implant) {
  Result<Tg43> tg43 = Tg43::create(implant->source, implant->options.formalism);
  if (!tg43) return tg43.error();
  const auto& structures = implant->structures;
  if (std::none_of(structures.begin(), structures.end(), is_target)) {
    return input_error(implant->plan.file, "the patient has no target, so there is no D90",
                       "Name the gland with patient.regions, for example \"1\" = \"prostate\"");
  }
  return std::unique_ptr<ImplantDose>(new ImplantDose(std::move(implant), *std::move(tg43)));
}

ImplantDose::ImplantDose(std::shared_ptr<const ImplantCase> implant, Tg43 tg43)
    : implant_(std::move(implant)),
      table_(std::move(tg43)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

ImplantDose::~ImplantDose() = default;

std::uint64_t ImplantDose::set(std::vector<PlacedSource> seeds) {
  std::uint64_t version = 0;
  {
    const std::scoped_lock lock(mutex_);
    wanted_ = {std::move(seeds), std::chrono::steady_clock::now(), wanted_.version + 1};
    version = wanted_.version;
  }
  woken_.notify_all();
  return version;
}

ImplantDose::News ImplantDose::news() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(news_, {});
}

bool ImplantDose::is_newest(const Wanted& wanted) {
  const std::scoped_lock lock(mutex_);
  return wanted.version == wanted_.version;
}

ImplantScore ImplantDose::score(const Structure& target, std::size_t seeds) const {
  const DoseVolume dvh(target.field.dose_Gy(), target.volume_mm3);
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  const double prescription_Gy = implant_->prescription_Gy();
  ImplantScore score;
  score.seeds = static_cast<std::int64_t>(seeds);
  score.d90_Gy = dvh.dose_of_percent(90.0);
  score.d90_percent = prescription_Gy > 0.0 ? 100.0 * score.d90_Gy / prescription_Gy : nothing;
  score.v100_percent = prescription_Gy > 0.0 ? dvh.percent_above(prescription_Gy) : nothing;
  return score;
}

std::vector<JudgedGoal> ImplantDose::judge(const std::vector<Structure>& structures) const {
  const double prescription_Gy = implant_->prescription_Gy();
  std::vector<JudgedGoal> judged;
  for (const DoseGoal& goal : implant_->options.goals) {
    JudgedGoal row{goal, std::nullopt, false};
    const auto metric = parse_metric(goal.metric, "goal for " + goal.structure);
    const auto of = std::find_if(structures.begin(), structures.end(), [&](const Structure& s) {
      return s.region == goal.structure || s.name == goal.structure;
    });
    if (metric && of != structures.end())
      row.value = figure_of(*metric, DoseVolume(of->field.dose_Gy(), of->volume_mm3), prescription_Gy);
    row.met = row.value && meets(goal, *row.value);
    judged.push_back(std::move(row));
  }
  return judged;
}

/// The dose of the plan, which is computed once, without swelling.
void ImplantDose::compute_planned() {
  const WeightedSources plan = weighted_sources(implant_->plan, implant_->source, implant_->options);
  const SwollenTime always{};
  std::vector<Structure> planned;
  for (const Structure& s : structures_) {
    Structure& of = planned.emplace_back(
        Structure{s.name, s.region, {}, s.volume_mm3, Field(s.points, {}, std::span(&always, 1), plan.factor)});
    of.field.bring_to(table_, plan.sources);
  }
  ImplantScore of_plan = score(planned.front(), plan.sources.size());
  of_plan.goals = judge(planned);
  const std::scoped_lock lock(mutex_);
  news_.planned = std::move(of_plan);
}

void ImplantDose::compute(const Wanted& wanted) {
  structures_.front().field.bring_to(table_, wanted.seeds);
  ImplantScore now = score(structures_.front(), wanted.seeds.size());
  now.took_ms = 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - wanted.since).count();
  {
    const std::scoped_lock lock(mutex_);
    news_.now = now;
    news_.version = wanted.version;
  }
  for (std::size_t k = 1; k < structures_.size() && is_newest(wanted); ++k)
    structures_[k].field.bring_to(table_, wanted.seeds);
  if (!is_newest(wanted)) return;
  now.goals = judge(structures_);
  std::shared_ptr<LiveDose> grid;
  if (const double prescription_Gy = implant_->prescription_Gy(); prescription_Gy > 0.0) {
    grid_->bring_to(table_, wanted.seeds);
    grid = std::make_shared<LiveDose>(empty_grid_);
    grid->values.reserve(grid_->dose_Gy().size());
    constexpr double most = std::numeric_limits<std::uint16_t>::max();
    for (const double dose : grid_->dose_Gy()) {
      const double value = 100.0 * dose / prescription_Gy / grid->unit_percent;
      grid->values.push_back(static_cast<std::uint16_t>(std::clamp(std::round(value), 0.0, most)));
    }
  }
  const std::scoped_lock lock(mutex_);
  news_.now = std::move(now);
  news_.version = wanted.version;
  news_.grid = std::move(grid);
}

/// Chooses the structures, their samples and the grid.
void ImplantDose::prepare() {
  structures_.clear();
  const DoseOptions& options = implant_->options;
  const double factor = weighted_sources(implant_->plan, implant_->source, options).factor;
  const std::vector<SwollenTime> times =
      options.swelling.is_any()
          ? swollen_times(options.swelling, implant_->source.half_life_days, std::numeric_limits<double>::infinity())
          : std::vector<SwollenTime>{SwollenTime{}};
  for (const bool target : {true, false}) {
    for (const DoseStructure& structure : implant_->structures) {
      if (is_target(structure) != target || (!target && !has_goal(structure, options.goals))) continue;
      if (target && !structures_.empty()) continue;
      StructureSamples samples = thinned(structure.samples, kMostSamples);
      Field field(samples.points, options.swelling, times, factor);
      structures_.push_back({structure.name, structure.region, std::move(samples.points), std::move(samples.volume_mm3),
                             std::move(field)});
    }
  }
  Eigen::AlignedBox3d box;
  for (const Vec3& x : structures_.front().points) box.extend(x);
  const Vec3 low = box.min().array() - kAroundTarget_mm, high = box.max().array() + kAroundTarget_mm;
  empty_grid_.origin_mm = low;
  empty_grid_.spacing_mm = std::max(kGridSpacing_mm, std::cbrt((high - low).prod() / kMostGridPoints));
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    empty_grid_.size[static_cast<std::size_t>(axis)] =
        static_cast<std::uint32_t>(std::ceil((high - low)[axis] / empty_grid_.spacing_mm)) + 1;
  }
  std::vector<Vec3> points;
  for (std::uint32_t k = 0; k < empty_grid_.size[2]; ++k) {
    for (std::uint32_t j = 0; j < empty_grid_.size[1]; ++j) {
      for (std::uint32_t i = 0; i < empty_grid_.size[0]; ++i)
        points.emplace_back(low + empty_grid_.spacing_mm * Vec3(i, j, k));
    }
  }
  grid_ = std::make_unique<Field>(points, options.swelling, times, factor);
  compute_planned();
}

void ImplantDose::fail(const Error& why) {
  const std::scoped_lock lock(mutex_);
  news_.problem = why;
}

void ImplantDose::run(const std::stop_token& stop) {
  const auto fails = [this](const Error& why) { fail(why); };
  bool is_prepared = survive(
      "the dose of the plan", [this] { prepare(); }, fails);
  std::uint64_t done = 0;
  const auto compute_next = [&] {
    Wanted wanted;
    {
      std::unique_lock lock(mutex_);
      if (!woken_.wait(lock, stop, [&] { return wanted_.version != done; })) return;
      done = wanted_.version;
      wanted = wanted_;
    }
    if (!is_prepared) prepare();
    is_prepared = true;
    compute(wanted);
  };
  while (!stop.stop_requested()) survive("the dose of the seeds", compute_next, fails);
}

}  // namespace stylet::serve
