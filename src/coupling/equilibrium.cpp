// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/largest.hpp"
#include "insertion_parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

/// One sub-step's balance: Newton's iteration over the needle's shape, the frames and the place of the cut, with the
/// linear equations of ContactSystem. Their matrix is dear and changes little from step to step, so it is kept, and
/// errors are taken as they are: an iteration with an old matrix converges to the same balance, linearly. Sliding and
/// cutting stay in the system as soft rows (viscous friction is a compliance h/(bℓ)), so a change of state changes D
/// alone.
namespace stylet {

namespace {
constexpr int kMaxNewton = 30;
constexpr int kMaxPivots = 60;
constexpr int kAllAtOnce = 4;  ///< rounds in which all contradictions are lifted together, then one by one
constexpr int kMaxToggles = 6;
/// An old matrix is made anew before the next step when it took more iterations than this, …
constexpr int kManyIterations = 5;
constexpr int kManyQuiet = 3;   ///< … or than this where no state changed, …
constexpr double kSlow = 0.08;  ///< … and the last one left more than this part of the error, which is its fault, …
constexpr double kSlowish = 0.02;  ///< … or than this where many were taken and no state changed
/// Where they leave more than this part of the error the next ones are begun, beside them, …
constexpr double kWorn = 0.01;
/// … after balances of no more iterations than this; a cut takes the time of one.
constexpr int kTimeLeft = 2;
/// A tangent costs as much as some iterations with an old one, so many more are waited for.
constexpr int kWorthATangent = 6;
/// [of the largest force] From nearer than this to the balance, the first iteration's success says nothing about the
/// matrix: a contact that changes its state or a cut that goes a little further may outweigh all the error there was.
constexpr double kNear = 1e-4;
/// Where states have changed, one of this balance serves on while no more than this part of the error is left each
/// time.
constexpr double kFalls = 0.3;
constexpr double kNeedleShare = 0.1;  ///< of the tolerance: out-of-balance moment over the largest force × the length
constexpr double kTiny = 1e-12;
constexpr double kNoLength_mm = 1e-6;  ///< a contact with less than this carries no friction
constexpr double kStill_mm = 1e-9;     ///< less is not sliding
/// On either side of the speed where friction stops growing its two laws agree; so little says nothing about the side.
constexpr double kSameSpeed_mm = 1e-6;

/// So much more or less damping, over all that is elastic, asks for another tangent.
constexpr double kOtherDamping = 0.25;

constexpr double kDampedShare = 0.1;  ///< of the time the tip has been on bone: the needle follows it all the same
/// What a balance not found changes the damping by, what one that is, over that on bone: when it ends, the most.
constexpr double kMoreDamping = 4.0;
constexpr double kWearsOff = 0.8;
constexpr double kNoDamping = 0.05;
constexpr double kMostDamping = 1e3;

/// Forces that have grown to so many times what they were, without a balance, come from iterations that went astray.
constexpr double kMostGrowth = 2.0;
/// So has a needle whose tip has moved by this part of its length.
constexpr double kMostMotion = 0.1;

/// Where compliance changes fast with the cut (next to held tissue) the cut would jump to and fro: it is followed the
/// more slowly the longer that lasts.
constexpr int kSmoothCut = 6;
double damping_of_cut(int iteration) { return iteration < kSmoothCut ? 1.0 : iteration < 2 * kSmoothCut ? 0.5 : 0.25; }
}  // namespace

/// The needle's tangent at its present shape, and the matrix made of it.
void Insertion::Parts::linearise(Effort& effort) {
  const InPhase in_phase(phases, StepPhase::needle_tangent);
  const int count = load_count();
  const auto size = static_cast<Eigen::Index>(3 * count);
  auto compliance_of_needle = system.N.topLeftCorner(size, size);
  auto motion = system.free.head(size);
  // What needed springs will need them again while it is pushed on; now and then it is tried without.
  const bool expected = system.supported && last_way > 0.0 && ++supported_for < kTryWithout;
  if (!expected) effort.spend(effort.needle());
  system.supported = expected || !needle->linearise(loads, compliance_of_needle, motion, {}, Indefinite::give_up);
  if (!expected) supported_for = 0;
  if (system.supported) {  // pressed harder than it can bear on its own: lend it the tissue's stiffness
    // At a few contacts that is enough as a rule, and cheaper; at all of them always.
    const std::span<const Mat3> lent(springs.data(), static_cast<std::size_t>(count));
    lend_springs(kFewSprings, system.spring);
    effort.spend(effort.needle());
    const bool more = count > kFewSprings + 1;
    if (!needle->linearise(loads, compliance_of_needle, motion, lent, more ? Indefinite::give_up : Indefinite::shift) &&
        more) {
      lend_springs(count, system.spring);
      effort.spend(effort.needle() + effort.matrix_on_all_springs() - effort.matrix());
      needle->linearise(loads, compliance_of_needle, motion, lent);
    }
  }
  tangent_fits = true;
  matrix_fits = false;
  forget_preparation();
  preparation.worn_mm = 0.0;
}

/// The needle's damping in a sub-step, as a time constant. Between hand and bone a needle bows until it finds another
/// shape all at once, or snaps off: on the way there is no balance. Damping makes that a motion, each step of which has
/// one. When the tip strikes bone there is none yet, or the force would overshoot. Where a balance was not found all
/// the same it grows, until the needle hardly changes its shape and there is one, and wears off again.
double Insertion::Parts::damping_s(double h) {
  on_bone_for = on_bone() ? on_bone_for + h : 0.0;
  const double most = settings.bone_damping_s;
  rescue_s = balanced ? kWearsOff * rescue_s : std::max(kMoreDamping * rescue_s, most);
  if (rescue_s < kNoDamping * most) rescue_s = 0.0;
  rescue_s = std::min(rescue_s, kMostDamping * most);
  return std::max(rescue_s, std::min(most, kDampedShare * on_bone_for));
}

void Insertion::Parts::damp_needle(double ratio) {
  if (settings.solver != CouplingSettings::Solver::coupled || (ratio == 0.0 && damping_ratio == 0.0)) return;
  damping_ratio = ratio;
  needle->damp(ratio);
  // A tangent of another damping converges, the more slowly the more it is another one.
  if (std::abs(ratio - tangent_damping) <= kOtherDamping * (1.0 + tangent_damping)) return;
  tangent_damping = ratio;
  tangent_fits = false;
  forget_preparation();
}

/// The needle's step with the tangent of before. False where that is another needle's.
bool Insertion::Parts::relax_needle() {
  const InPhase in_phase(phases, StepPhase::needle_relax);
  return tangent_fits && needle->relax(loads, system.free.head(static_cast<Eigen::Index>(3 * load_count())));
}

/// Lateral springs as stiff as the tissue is at each contact by itself: stiffer together than the tissue as a whole, so
/// the needle on them does not buckle where needle and tissue together do not. A few stand for all, each for so many
/// and as stiff as those together. The tip has one, too, as much stiffer, where it is held: the shaft's contacts alone
/// do not keep a needle that has bowed out between hand and bone.
/// @param most of them, evenly spread, the last contact's among them @param lent written, at each contact
void Insertion::Parts::lend_springs(int most, std::vector<LentSpring>& lent) {
  constexpr double hardest_mm_per_N = 1e-3;
  const int count = load_count();
  const int every = (std::max(count - 1, 1) + most - 1) / most;
  for (int c = 0; c < count; ++c) {
    double own = system.A.block<3, 3>(3 * c, 3 * c).trace() / 3.0;
    bool lend = true;
    if (c == 0) {
      lend = tip.touching && tip.state != Tip::State::open;
    } else {
      own += grips[static_cast<std::size_t>(c - 1)].softness;
      lend = (count - 1 - c) % every == 0;
    }
    LentSpring& spring = lent[static_cast<std::size_t>(c)];
    spring.along = c == 0 ? Vec3::Zero() : Vec3(frames[static_cast<std::size_t>(c)].col(2));
    spring.stiffness = lend ? every / std::max(own, hardest_mm_per_N) : 0.0;
    springs[static_cast<std::size_t>(c)] = spring.matrix();
  }
}

ContactSystem::TipRows Insertion::Parts::tip_rows() const {
  if (!tip.touching || tip.state == Tip::State::open) return ContactSystem::TipRows::none;
  return tip_lateral_rows() ? ContactSystem::TipRows::all : ContactSystem::TipRows::axial;
}

/// By how much [N] a solution contradicts the state of a contact; 0 = consistent, or frozen.
double Insertion::Parts::contradiction(int load, const Trial& trial) const {
  const double axial = trial.axial;
  if (load == 0) {
    if (!tip.touching || tip.toggles > toggle_limit) return 0.0;
    switch (tip.state) {
      case Tip::State::open:
        return trial.opening;
      case Tip::State::stick:
        return std::max(-axial, tip.blocked || tip.at_membrane ? 0.0 : axial - tip.limit);  // membrane_gives()
      case Tip::State::cut:
        return tip.advance > 0.0 ? 0.0 : tip.cutting - axial;
    }
  }
  const Grip& grip = grips[static_cast<std::size_t>(load - 1)];
  if (grip.toggles > toggle_limit || grip.length < kNoLength_mm) return 0.0;
  if (grip.state == Grip::State::stick) return std::abs(axial) - grip.law.static_N_per_mm * grip.length;
  // Sliding the other way than its state says, or faster or slower. A length is what tells, since forces hardly differ
  // where friction does not depend on speed; it counts as the force that pushes the tissue so far.
  const double slides = trial.slides;
  const double wrong =
      grip.fast ? grip.reach - slides - kSameSpeed_mm : std::max(-slides, slides - grip.reach - kSameSpeed_mm);
  return wrong > kStill_mm ? 3.0 * wrong / (memory.share() * compliance(grip.point, grip.point).trace()) : 0.0;
}

/// By how much [mm] a sliding contact slides in this sub-step, in the sense of its state, under an axial force.
double Insertion::Parts::way(const Grip& grip, double axial) {
  const double sign = grip.state == Grip::State::forward ? 1.0 : -1.0;
  return grip.slip * (sign * axial - grip.coulomb);
}

void Insertion::Parts::change_state(int load, const Trial& trial, StepReport& report) {
  ++report.pivots;
  if (load == 0) {
    if (++tip.toggles > toggle_limit) report.flags |= StepReport::contact_cycling;
    if (tip.state != Tip::State::stick) {
      tip.state = Tip::State::stick;
    } else if (trial.axial < 0.0) {
      tip.state = Tip::State::open;
    } else {
      tip.state = Tip::State::cut;
    }
    return;
  }
  Grip& grip = grips[static_cast<std::size_t>(load - 1)];
  if (++grip.toggles > toggle_limit) report.flags |= StepReport::contact_cycling;
  if (grip.state == Grip::State::stick) {
    grip.state = trial.axial > 0.0 ? Grip::State::forward : Grip::State::backward;
    grip.fast = false;
    return;
  }
  if (grip.fast || trial.slides > grip.reach) {
    grip.fast = !grip.fast;
    return;
  }
  grip.state = Grip::State::stick;
  grip.s = grip.s_start;  // back to where it was held
}

/// What the present solution of the coupled system says of a contact.
Insertion::Parts::Trial Insertion::Parts::trial(int load) const {
  Trial result{.axial = system.lambda[3 * load + 2]};
  if (load > 0) {
    const Grip& grip = grips[static_cast<std::size_t>(load - 1)];
    const double sign = grip.state == Grip::State::backward ? -1.0 : 1.0;
    result.slides = way(grip, result.axial) + sign * system.axial_excess(load);
  } else if (tip.state == Tip::State::open) {
    result.opening = system.opening() / std::max(system.own_yield(0)[2], kTiny);
  }
  return result;
}

/// A contact that is held again went back along the shaft; the right-hand side must know at once.
void Insertion::Parts::change_and_tell(int load, StepReport& report) {
  const double s = load == 0 ? 0.0 : grips[static_cast<std::size_t>(load - 1)].s;
  change_state(load, trial(load), report);
  if (load == 0) return;
  system.gap.segment<3>(3 * load) -=
      (grips[static_cast<std::size_t>(load - 1)].s - s) * frames[static_cast<std::size_t>(load)].col(2);
}

/// Solves the held rows, then lets every state that contradicts its own law change, until none does.
/// @param changed whether a state has
/// @param effort has ended where it was broken off
/// @return false when the matrix is singular
bool Insertion::Parts::pivot(double h, Effort& effort, StepReport& report, bool& changed) {
  const InPhase in_phase(phases, StepPhase::solve);
  changed = false;
  for (int round = 0; round < kMaxPivots; ++round) {
    if (round > 0) {
      const double anew = round == kAllAtOnce ? effort.matrix() : 0.0;
      if (!effort.allows(anew + effort.solution())) {
        effort.end();
        return true;
      }
      effort.spend(anew + effort.solution());
    }
    soften_rows(h);
    if (round == kAllAtOnce) {  // what an old matrix is off by may make states go to and fro
      matrix_fits = system.factorise();
      if (!matrix_fits) return false;
    }
    matrix_fits = system.solve(tip_rows());
    if (!matrix_fits) return false;

    // Find the worst contradiction; while there are many, change all of them at once.
    const bool all_at_once = round < kAllAtOnce;
    double worst = kTiny;
    int worst_load = -1;
    for (int c = 0; c < load_count(); ++c) {
      const double size_of_it = contradiction(c, trial(c));
      if (size_of_it > worst) {
        worst = size_of_it;
        worst_load = c;
      }
    }
    if (worst_load < 0) return true;

    changed = true;
    if (!all_at_once) {
      change_and_tell(worst_load, report);
      continue;
    }
    const bool tip_too = contradiction(0, trial(0)) > kTiny;
    for (int c = 1; c < load_count(); ++c) {
      if (contradiction(c, trial(c)) > kTiny) change_and_tell(c, report);
    }
    if (tip_too) change_and_tell(0, report);
  }
  report.flags |= StepReport::contact_cycling;
  return true;
}

/// Largest error of a held row at the present shape, as a force: error over what the row yields.
double Insertion::Parts::equation_error() const {
  double error = 0.0;
  const auto held = tip_rows();
  const int tip_from = held == ContactSystem::TipRows::all ? 0 : held == ContactSystem::TipRows::axial ? 2 : 3;
  for (int c = 0; c < load_count(); ++c) {
    const Vec3 off = system.error(c).cwiseAbs().cwiseQuotient(system.own_yield(c));
    for (int k = c == 0 ? tip_from : 0; k < 3; ++k) error = larger_or_nan(error, off[k]);
  }
  // A contact that is not held in a direction must carry nothing there.
  if (held == ContactSystem::TipRows::axial)
    error = larger_or_nan(error, (frames[0].leftCols<2>().transpose() * tip.force).norm());
  return error;
}

/// [N] of tip and grips, at least 1; not a number where one is none.
double Insertion::Parts::largest_force() const {
  double largest = larger_or_nan(1.0, tip.force.norm());
  for (const Grip& grip : grips) largest = larger_or_nan(largest, grip.force.norm());
  return largest;
}

/// How far needle, tissue and laws are from balance: 1 is the tolerance.
double Insertion::Parts::imbalance_over_tolerance() const {
  const InPhase in_phase(phases, StepPhase::balance);
  double largest = 1.0;
  for (const PointLoad& load : loads) largest = std::max(largest, load.force.norm());
  const double allowed = settings.tolerance * largest;
  return larger_or_nan(equation_error(), needle->residual(loads) / (kNeedleShare * length())) / allowed;
}

/// Moves a sliding contact along the needle by what the present solution says.
void Insertion::Parts::slide(int load) {
  Grip& grip = grips[static_cast<std::size_t>(load - 1)];
  if (grip.state == Grip::State::stick) return;
  if (grip.length < kNoLength_mm) {  // no friction at all: it follows the tissue
    const Vec3 gap = grip.x + tissue_displacement(grip.point) - needle->point(std::clamp(grip.s, 0.0, length()));
    grip.s = std::clamp(grip.s, 0.0, length()) + frames[static_cast<std::size_t>(load)].col(2).dot(gap);
    return;
  }
  const double sign = grip.state == Grip::State::forward ? 1.0 : -1.0;
  grip.s = grip.s_start - sign * trial(load).slides;
}

void Insertion::Parts::keep_iterate() {
  kept.needle = needle->state();
  kept.advance = tip.advance;
  kept.tip_force = tip.force;
  for (std::size_t k = 0; k < grips.size(); ++k) kept.grips[k] = {grips[k].force, grips[k].s};
}

/// To the iterate that was kept; no state has changed since.
void Insertion::Parts::go_back() {
  needle->set_state(kept.needle);
  tip.force = kept.tip_force;
  for (std::size_t k = 0; k < grips.size(); ++k) {
    grips[k].force = kept.grips[k].force;
    grips[k].s = kept.grips[k].s;
  }
  if (tip.touching && tip.state == Tip::State::cut) march(kept.advance);
}

/// Remembers where the tip was, and aims the cut.
void Insertion::Parts::begin_balance(int most_toggles) {
  toggle_limit = most_toggles;
  for (Grip& grip : grips) grip.toggles = 0;
  tip.toggles = 0;
  tip.blocked = false;
  if (tip.touching && tip.stale) take_compliance();
  tip.x_start = tip.x;
  tip.at_start = tip.at;
  tip.advance = 0.0;
  if (tip.touching) aim_tip();
}

/// Whether an iterate is so far from where the sub-step began that it is no guide to the balance that was not found.
bool Insertion::Parts::went_astray(double largest_at_start) const {
  return !(largest_force() < kMostGrowth * largest_at_start &&
           (needle->point(length()) - tip_start).norm() < kMostMotion * length());
}

void Insertion::Parts::solve_equilibrium(double h, Effort& effort, StepReport& report) {
  begin_balance(kMaxToggles);
  take_prepared_tangent();
  const double largest_at_start = largest_force();
  bool from_start = !going_on || force_share == 0.0;
  if (going_on) go_on();

  bool changed = true;
  bool old_matrix = false;
  double before = std::numeric_limits<double>::infinity();
  const auto look = [&] {
    fill_loads();
    set_frames();
    soften_rows(h);
    gather_system();
    return imbalance_over_tolerance();
  };
  bool old_matrix_failed = false;
  bool new_tangent = false;
  bool quiet = true;      // no state has changed
  Index border_tet = -1;  // where the tip was when it was added to the matrix
  int before_break = 0;   // iterations that went into the balance in which a membrane broke
  for (int all = 0; all < kMaxNewton; ++all) {
    int iteration = all - before_break;
    foresees_cut = iteration < kSmoothCut;
    double error = look();
    const bool found = iteration > 0 && !changed && error < 1.0;
    if (found && membrane_gives()) {
      break_membrane(report);
      before_break = all;
      iteration = 0;  // another balance is looked for from here
      foresees_cut = true;
      error = look();
    } else if (found) {
      const bool slow = error > (quiet && iteration > kManyIterations ? kSlowish : kSlow) * before;
      if (slow && iteration > (quiet ? kManyQuiet : kManyIterations)) tangent_fits = false;
      if (iteration > kManyIterations) steady = false;  // what took long to find says little about what comes next
      if (iteration > 1 && error > kWorn * before) preparation.worn_mm = std::numeric_limits<double>::infinity();
      if (iteration <= (tip.state == Tip::State::cut ? kTimeLeft - 1 : kTimeLeft)) prepare_tangent();
      return;
    }
    bool exact = old_matrix_failed;
    old_matrix_failed = false;
    if (iteration > 0 && !exact) {
      const double rate = error / before;
      const auto done_after = [&](int more) { return rate < 1.0 && error * std::pow(rate, more) < 1.0; };
      if (changed) {
        exact = new_tangent ? !(rate < kFalls || done_after(kWorthATangent)) : iteration > 1 || !(rate < 1.0);
      } else {
        exact = iteration == 1 ? !(rate < 1.0) : !done_after(kWorthATangent);
      }
      if (exact && old_matrix && !changed && !(error < before)) {  // it led away: from where it began, with a new one
        go_back();
        error = look();
      }
    }
    if (all > 0 && !effort.allows(effort.iteration() + (exact ? effort.tangent() : 0.0))) break;
    effort.spend(effort.iteration());
    before = iteration == 0 ? std::max(error, kNear / settings.tolerance) : error;
    ++report.iterations;
    old_matrix = !exact && relax_needle();
    if (old_matrix) {
      keep_iterate();
    } else {
      linearise(effort);
      new_tangent = true;
    }
    if (!matrix_fits) {
      const InPhase in_phase(phases, StepPhase::factorise);
      effort.spend(effort.matrix());
      matrix_fits = system.factorise();
    }
    if (matrix_fits && (iteration == 0 || !old_matrix || border_tet != tip.at.tet)) {
      border_tet = tip.at.tet;
      const InPhase in_phase(phases, StepPhase::solve);
      system.add_tip();
    }
    if (!matrix_fits || !pivot(h, effort, report, changed)) {
      if (!old_matrix) {  // needle and tissue have no balance nearby: they stay as they were
        steady = false;
        stay();
        if (from_start) {
          report.flags |= StepReport::not_converged;
          return;
        }
        from_start = true;
      }
      old_matrix_failed = true;
      continue;
    }
    if (effort.ended()) break;  // the states are not those of the solution
    quiet = quiet && !changed;
    steady = steady && tip.toggles == 0;

    for (int c = 0; c < load_count(); ++c) {
      loads[static_cast<std::size_t>(c)].force = -system.push.segment<3>(3 * c);
      force_of(c).noalias() = frames[static_cast<std::size_t>(c)] * system.lambda.segment<3>(3 * c);
    }
    {
      const InPhase in_phase(phases, StepPhase::needle_advance);
      needle->advance(loads);
    }
    for (int c = 1; c < load_count(); ++c) slide(c);
    if (tip.touching && tip.state == Tip::State::cut) {
      const double proposed = std::max(0.0, slip_of_cut(h) * (system.lambda[2] - tip.cutting));
      march(tip.advance + damping_of_cut(iteration) * (proposed - tip.advance));
      if (tip.blocked) {
        tip.state = Tip::State::stick;
        changed = true;
        steady = false;
      }
    }
  }
  steady = false;
  if (changed || !(look() < 1e3)) {
    report.flags |= StepReport::not_converged;
    if (went_astray(largest_at_start)) {
      stay();
    } else {
      take_back_cut();
    }
  }
}

}  // namespace stylet
