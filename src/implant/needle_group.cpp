// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle_group.hpp"

#include "core/clock.hpp"
#include "dwell_positions.hpp"
#include "needle_motion.hpp"
#include "needle_recorder.hpp"
#include "seed_watch.hpp"
#include "sim/base_steps.hpp"
#include "stylet/core/flush_denormals.hpp"
#include "stylet/sim/far_gland.hpp"
#include "stylet/sim/harms.hpp"
#include "stylet/sim/target_motion.hpp"
#include "stylet/sim/unbroken_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>

namespace stylet {

namespace {

constexpr int kGlandEvery = 8;  ///< steps between two looks at the gland

/// One needle on its way through its procedure, which may rest in between.
class NeedleOnItsWay {
 public:
  NeedleOnItsWay(const PlannedNeedle& planned, const Scenario& scenario, const Model& model, double seed_length_mm)
      : load_(*planned.load),
        entry_(planned.plan.entry_mm->data()),
        motion_(plan_needle_motion(load_, entry_, scenario, seed_length_mm)),
        steps_(planned_steps(model, motion_.insertion)),
        first_wait_s_(1e-3 * scenario.run.dt_ms),
        seed_length_mm_(seed_length_mm),
        seeds_(load_, motion_, scenario, seed_length_mm),
        dwells_(seeds_.result()),
        recorder_(steps_.count) {
    out_.needle.name = load_.name;
    out_.needle.entry_mm = entry_;
    out_.needle.direction = load_.direction;
    out_.needle.depth_mm = motion_.insertion.depth_mm;
  }
  NeedleOnItsWay(const NeedleOnItsWay&) = delete;  // its parts refer to each other
  NeedleOnItsWay& operator=(const NeedleOnItsWay&) = delete;

  /// Puts the needle in, to its full depth. @param gland null without a gland
  void go_in(Simulation& simulation, TargetMotion* gland) {
    simulation.place(motion_.insertion);
    go_on(simulation, gland, motion_.in_s);
    recorder_.keep_shape(simulation, simulation.insertion().held(), "full depth");
  }
  /// Keeps its shape while it is at rest, with all needles of the group in the tissue. @param number in the simulation
  void keep_shape_in_place(const Simulation& simulation, int number) {
    recorder_.keep_shape(simulation, number, kAllInPlace);
  }
  /// Carries out the rest: the seeds are dropped, and the needle comes out.
  void finish(Simulation& simulation, TargetMotion* gland) {
    go_on(simulation, gland, std::numeric_limits<double>::infinity());
  }
  /// Waits with the base at rest, in steps that grow (waiting_steps_s()).
  void wait(Simulation& simulation, TargetMotion* gland, double seconds);
  /// Looks where the dwell positions are now, of this needle at rest or in the hand.
  /// @param number of this needle in the simulation
  void see_dwells(Simulation& simulation, int number, DwellLook look) {
    see_dwell_positions(load_, simulation, number, look, seed_length_mm_, dwells_);
  }
  NeedleOutcome outcome(bool has_gland);

 private:
  void go_on(Simulation& simulation, TargetMotion* gland, double until_s);
  void take_step(Simulation& simulation, TargetMotion* gland, const Pose& base, double dt);

  const NeedleLoad& load_;
  Vec3 entry_;
  NeedleMotion motion_;
  BaseSteps steps_;
  double first_wait_s_;    ///< [s] the first of the steps that grow
  double seed_length_mm_;  ///< of a seed, or of the source of a temporary implant
  SeedWatch seeds_;
  std::vector<SeedHistory> dwells_;  ///< of a catheter
  NeedleRecorder recorder_;
  UnbrokenSurface unbroken_;
  FarGland far_gland_;
  NeedleOutcome out_;
  long taken_ = 0;       ///< number of steps so far
  double time_s_ = 0.0;  ///< [s] of the needle's own motion
  long without_balance_ = 0;
};

void NeedleOnItsWay::go_on(Simulation& simulation, TargetMotion* gland, double until_s) {
  while (taken_ < steps_.count && time_s_ < until_s) {
    const long next = taken_ + 1;
    take_step(simulation, gland, steps_.base(next), steps_.dt_s(next));
  }
}

void NeedleOnItsWay::wait(Simulation& simulation, TargetMotion* gland, double seconds) {
  const Pose base = simulation.last_step().base;
  for (const double dt : waiting_steps_s(seconds, first_wait_s_)) take_step(simulation, gland, base, dt);
}

void NeedleOnItsWay::take_step(Simulation& simulation, TargetMotion* gland, const Pose& base, double dt) {
  NeedleHistory& needle = out_.needle;
  ++taken_;
  simulation.prepare();
  const std::int64_t before = thread_cpu_ns();
  const Step& step = simulation.step(base, dt);
  const double seconds = 1e-9 * static_cast<double>(thread_cpu_ns() - before);
  needle.seconds += seconds;
  time_s_ += dt;
  ++needle.steps;
  if ((step.flags & Step::kDistrusted) != 0) ++without_balance_;
  needle.peak_force_N = std::max(needle.peak_force_N, std::abs(step.force_axial_N));
  if (step.tip_state != TipState::air) {
    const Vec3 off = step.tip_mm - entry_;
    needle.deflection_mm = std::max(needle.deflection_mm, (off - load_.direction * load_.direction.dot(off)).norm());
  }
  seeds_.add(simulation, time_s_);
  recorder_.add(simulation, seeds_, seconds);
  unbroken_.add(simulation);
  for (const Event& event : simulation.new_events()) needle.events.push_back(event);
  if (gland != nullptr && taken_ % kGlandEvery == 0) {
    const VolumeMotion motion = gland->now(simulation.insertion()).motion;
    far_gland_.add(step, motion);
    const Vec3 shift = motion.shift_mm;
    if (shift.norm() > needle.gland_shift_mm.norm()) needle.gland_shift_mm = shift;
  }
}

NeedleOutcome NeedleOnItsWay::outcome(bool has_gland) {
  NeedleOutcome out = out_;
  out.needle.record = recorder_.take();
  NeedleHistory& needle = out.needle;
  if (!has_gland) needle.gland_shift_mm.setConstant(std::numeric_limits<double>::quiet_NaN());
  const bool catheter = load_.implant == Implant::temporary;
  out.seeds = catheter ? dwells_ : seeds_.result();
  const auto warn = [&](const std::string& text) {
    out.warnings.push_back(fmt::format("{} {}: {}", catheter ? "Catheter" : "Needle", load_.name, text));
  };
  for (const std::string& harm : harms(needle.events)) warn(harm);
  for (const std::string& warning : unbroken_.warnings()) warn(warning);
  if (auto warning = far_gland_.warning()) warn(*warning);
  if (without_balance_ > 0) {
    warn(fmt::format("In {} of {} steps no balance of needle and tissue was found; a smaller run.dt_ms helps.",
                     without_balance_, needle.steps));
  }
  const auto astray =
      std::count_if(out.seeds.begin(), out.seeds.end(), [](const SeedHistory& s) { return !s.in_tissue; });
  if (astray > 0) {
    const std::string number = fmt::format("{} of its {} ", astray, out.seeds.size());
    warn(number + (catheter ? "dwell positions are not in tissue whose displacement is known; they count as if the "
                              "tissue there had not moved."
                            : "seeds were not dropped in tissue whose displacement is known; they stay where they were "
                              "dropped."));
  }
  if (load_.beside_line_mm > 1.0) {
    warn(fmt::format("Its planned {} lie up to {:.1f} mm beside a straight line; the {} is straight.",
                     catheter ? "dwell positions" : "seeds", load_.beside_line_mm, catheter ? "catheter" : "needle"));
  }
  return out;
}

/// Catheters at rest in tissue that creeps lose force; they cannot gain this much.
constexpr double kMostGrowth = 1.25;

/// [N] The root of the sum of the squared forces of all needles on the tissue.
double all_forces_N(const Insertion& insertion) {
  double squares = 0.0;
  for (int needle = 0; needle < insertion.needles(); ++needle) {
    for (const ContactState& contact : insertion.contacts_of(needle)) squares += contact.force.squaredNorm();
  }
  return std::sqrt(squares);
}

Error grown_forces(const std::string& where, double before_N, double after_N) {
  return failure(
      where,
      fmt::format("while all catheters were at rest, their forces on the tissue grew from {:.3g} to {:.3g} N, "
                  "which no tissue does; the creep of tissue between close catheters is not computed well "
                  "enough",
                  before_N, after_N),
      "Set coupling.method = \"embedded\", whose creep fits together, or tissue.creep = 1, which leaves creep out");
}

}  // namespace

Result<GroupOutcome> simulate_group(const std::vector<PlannedNeedle>& staying,
                                    const std::vector<PlannedNeedle>& needles, Scenario scenario, const TetMesh& mesh,
                                    double seed_length_mm, KnownTargets& targets, const std::string& where) {
  std::vector<PlannedNeedle> all = staying;
  all.insert(all.end(), needles.begin(), needles.end());
  scenario.insertions.clear();
  for (const PlannedNeedle& needle : all) scenario.insertions.push_back(needle.plan);
  scenario.procedure.stabilising.clear();  // they are among the insertions
  GroupOutcome out;
  const std::int64_t start = monotonic_ns();
  auto compiled = Model::compile(
      scenario, mesh,
      fmt::format("{}, {} {}", where, needles.front().load->implant == Implant::temporary ? "catheter" : "needle",
                  needles.front().load->name));
  if (!compiled) return compiled.error();
  const std::shared_ptr<const Model> model = *std::move(compiled);
  std::optional<TargetMotion> gland;
  if (!model->target_regions().empty()) {
    auto response = targets.of(model, {});
    if (!response) return response.error();
    gland.emplace(*std::move(response));
  }
  out.compile_s = 1e-9 * static_cast<double>(monotonic_ns() - start);

  const FlushDenormals flush;  // as in run(), so that the results are equal
  TargetMotion* const gland_now = gland ? &*gland : nullptr;
  Simulation simulation(model, static_cast<int>(all.size()));
  std::deque<NeedleOnItsWay> on_their_way;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (Result<> taken = simulation.take_up(static_cast<int>(k)); !taken) return taken.error();
    on_their_way.emplace_back(all[k], scenario, *model, seed_length_mm).go_in(simulation, gland_now);
  }
  for (std::size_t k = 0; k < all.size() && all.size() > 1; ++k)
    on_their_way[k].keep_shape_in_place(simulation, static_cast<int>(k));
  const bool catheters = needles.front().load->implant == Implant::temporary;
  if (catheters) {
    // The hand keeps the last catheter, at rest as the lock of the template keeps the others.
    const double loaded_N = all_forces_N(simulation.insertion());
    const auto look = [&](DwellLook at, double after_s, std::optional<Vec3>& gland_mm) -> Result<> {
      on_their_way.back().wait(simulation, gland_now, after_s);
      const double now_N = all_forces_N(simulation.insertion());
      if (!(now_N <= kMostGrowth * loaded_N)) return grown_forces(where, loaded_N, now_N);
      for (std::size_t k = staying.size(); k < all.size(); ++k)
        on_their_way[k].see_dwells(simulation, static_cast<int>(k), at);
      if (gland_now != nullptr) gland_mm = gland_now->now(simulation.insertion()).motion.shift_mm;
      return Ok{};
    };
    const Scenario::Procedure& procedure = scenario.procedure;
    if (auto seen = look(DwellLook::planning, procedure.pause_s, out.gland_at_planning_mm); !seen) return seen.error();
    if (auto seen = look(DwellLook::delivery, procedure.planning_to_delivery_s, out.gland_at_delivery_mm); !seen)
      return seen.error();
  }
  for (std::size_t k = staying.size(); k < all.size() && !catheters; ++k) {
    if (Result<> taken = simulation.take_up(static_cast<int>(k)); !taken) return taken.error();
    on_their_way[k].finish(simulation, gland_now);
  }
  for (std::size_t k = 0; k < all.size(); ++k) {
    NeedleOutcome outcome = on_their_way[k].outcome(gland.has_value());
    if (k < staying.size()) {
      out.warnings.insert(out.warnings.end(), outcome.warnings.begin(), outcome.warnings.end());
      out.staying.push_back(std::move(outcome.needle));
    } else {
      out.needles.push_back(std::move(outcome));
    }
  }
  return out;
}

}  // namespace stylet
