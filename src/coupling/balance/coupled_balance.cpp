// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/coupled_balance.hpp"

#include "core/dense_kernels.hpp"
#include "core/largest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stylet {

namespace {
/// Iterations before a balance is given up. Raised, hopeless balances cost more.
constexpr int kMaxNewton = 30;
/// Rounds of changing states before a balance is taken as cycling. Raised, cycling costs more.
constexpr int kMaxPivots = 60;
/// Rounds in which all contradictions are lifted together; then they are lifted one by one. Raised, states may go to
/// and fro for longer.
constexpr int kAllAtOnce = 4;
/// Changes of state in a sub-step, then a contact keeps its state. Raised, cycling costs more.
constexpr int kMaxToggles = 6;
/// An old matrix is made anew before the next step after more iterations than this. Raised, matrices are kept longer.
constexpr int kManyIterations = 5;
/// The same where no state changed.
constexpr int kManyQuiet = 3;
/// Both ask for that only if the last iteration left more than this part of the error, which is the matrix's fault.
/// Raised, matrices are kept longer.
constexpr double kSlow = 0.08;
/// The same where many iterations were taken and no state changed.
constexpr double kSlowish = 0.02;
/// Where iterations leave more than this part of the error the next tangent is begun. Raised, it is begun later.
constexpr double kWorn = 0.01;
/// Most iterations of a balance that leaves time for a piece of the next tangent; a cut takes the time of one. Raised,
/// the longest steps grow longer.
constexpr int kTimeLeft = 2;
/// Further iterations that are waited for before a new tangent is made, which costs as much as some of them. Raised,
/// tangents are kept longer and more iterations taken.
constexpr int kWorthATangent = 6;
/// [of the largest force] From nearer than this to the balance, the first iteration's success says nothing about the
/// matrix: a contact that changes its state or a cut that goes a little further may outweigh all the error there was.
constexpr double kNear = 1e-4;
/// Where states have changed, a tangent of this balance serves on while no more than this part of the error is left
/// each time. Raised, fewer tangents are made in a balance.
constexpr double kFalls = 0.3;
/// Part of the tolerance that the needle is held to, as out-of-balance moment over the largest force × the length.
/// Raised, the needle's shape is less exact.
constexpr double kNeedleShare = 0.1;
/// [N] Smaller contradictions are rounding, and a smaller yield counts as this in a division.
constexpr double kTiny = 1e-12;
/// Error over the tolerance that is still no failure when iterations have ended. Raised, fewer steps are flagged.
constexpr double kPoor = 1e3;
/// Growth of the largest force, without a balance, that comes from iterations that went astray. Raised, forces may jump
/// further in a flagged step.
constexpr double kMostGrowth = 2.0;
/// The same of the tip's way over the needle's length.
constexpr double kMostMotion = 0.1;
/// [mm] From a contact nearer than this to the tip its direction is not told. Raised, it is told by one further back.
constexpr double kLeastTurn_mm = 1.0;

/// Where compliance changes fast with the cut (next to held tissue) the cut would jump to and fro: it is followed the
/// more slowly the longer that lasts.
constexpr int kSmoothCut = 6;
/// [mm] Where compliance jumps, between two elements, there may be no cut at all that balances: in front of the border
/// it would have to be shorter, behind it longer. A step of it that is no longer than this and comes into the element
/// that it went back out of before ends it for this sub-step. Raised, a cut may be longer by that much.
constexpr double kShortCut_mm = 0.05;
double damping_of_cut(int iteration) { return iteration < kSmoothCut ? 1.0 : iteration < 2 * kSmoothCut ? 0.5 : 0.25; }
}  // namespace

/// State of a solve between its iterations.
struct CoupledBalance::Progress {
  double before = std::numeric_limits<double>::infinity();  ///< error over the tolerance in the iteration before
  bool changed = true;                                      ///< a state changed in the last iteration
  bool quiet = true;                                        ///< none has changed so far
  bool old_matrix = false;         ///< the last iteration was with a matrix of an earlier shape
  bool old_matrix_failed = false;  ///< the last iteration was so, and found no solution
  bool new_tangent = false;        ///< a tangent was made in this balance
  bool steady = true;              ///< what solve() returns

  /// Whether an iteration with an error [over the tolerance] after `iteration` others needs a new tangent.
  [[nodiscard]] bool needs_tangent(double error, int iteration) const {
    const double rate = error / before;
    const auto done_after = [&](int more) { return rate < 1.0 && error * std::pow(rate, more) < 1.0; };
    if (!changed) return iteration == 1 ? !(rate < 1.0) : !done_after(kWorthATangent);
    return new_tangent ? !(rate < kFalls || done_after(kWorthATangent)) : iteration > 1 || !(rate < 1.0);
  }
};

CoupledBalance::CoupledBalance(const BalanceParts& parts)
    : parts_(parts),
      rows_(parts.settings, parts.settings.capacity + 1),
      system_(rows_, parts.settings.capacity + 1),
      states_(parts_.contacts),
      tissue_(system_, parts.settings.capacity + 1),
      tangent_(parts_.contacts.needle, system_, rows_, parts.settings.capacity + 1, parts.phases),
      kept_(parts_.contacts.needle.state().size(), parts.settings.capacity) {}

void CoupledBalance::march(double advance) {
  const InPhase in_phase(parts_.phases, StepPhase::tip);
  parts_.contacts.tip.cut.march(advance);
}

/// Gathers the numbers of the linear equations: the tissue's compliance among the contacts, the contacts' forces, and
/// the gaps between tissue and needle.
void CoupledBalance::gather() {
  const InPhase in_phase(parts_.phases, StepPhase::gather);
  const int count = parts_.contacts.count();
  const auto size = static_cast<Eigen::Index>(3 * count);
  const int same = tissue_.renew(parts_.contacts);
  if (same < std::min(tissue_.before(), count)) {
    tangent_.outdate();
    system_.outdate();
  } else if (count < tissue_.before()) {  // the last ones slid off the tip
    system_.keep_first(count);
  }
  tissue_.gather(parts_.contacts, same);
  for (int c = same; c < count; ++c) tangent_.append(c);

  auto now = rows_.now.head(size);
  auto gap = rows_.gap.head(size);
  for (int c = 0; c < count; ++c) now.segment<3>(3 * c) = parts_.contacts.force(c);
  for (int c = 0; c < count; ++c) gap.segment<3>(3 * c) = rows_.needle_at(c) - rows_.unloaded(parts_.contacts, c);
  dense::subtract_product(gap, system_.A.topLeftCorner(size, size), now);
  gap = -gap;
  const TipRelief relief = parts_.contacts.tissue.relief(parts_.contacts.forces());
  if (relief.is_any()) {
    for (int c = 0; c < count; ++c) gap.segment<3>(3 * c) -= relief.of(parts_.contacts.point(c));
    tissue_.stiffen(relief);
  }
  rows_.tip.behind = 0;
  if (!parts_.contacts.tip.touches()) return;
  tissue_.gather_drift(parts_.contacts, relief, rows_);
  for (int c = count - 1; c > 0 && rows_.tip.behind == 0; --c) {
    rows_.tip.behind_mm = rows_.loads().front().s - rows_.loads()[static_cast<std::size_t>(c)].s;
    if (rows_.tip.behind_mm > kLeastTurn_mm) rows_.tip.behind = c;
  }
}

/// Takes everything as it is now. @return how far needle, tissue and laws are from balance: 1 is the tolerance
double CoupledBalance::look(double h) {
  rows_.take_loads(parts_.contacts);
  {
    const InPhase in_phase(parts_.phases, StepPhase::gather);
    rows_.take_places(parts_.contacts);
    rows_.soften(parts_.contacts, h, foresees_cut_);
  }
  gather();
  const InPhase in_phase(parts_.phases, StepPhase::balance);
  const double allowed = parts_.settings.tolerance * rows_.largest_load();
  Needle& needle = parts_.contacts.needle;
  return larger_or_nan(equation_error(), needle.residual(rows_.loads()) / (kNeedleShare * needle.length())) / allowed;
}

ContactSystem::TipRows CoupledBalance::tip_rows() const {
  if (!parts_.contacts.tip.holds()) return ContactSystem::TipRows::none;
  return parts_.contacts.tip.has_lateral_rows() ? ContactSystem::TipRows::all : ContactSystem::TipRows::axial;
}

/// Largest error of a held row at the present shape, as a force: error over what the row yields.
double CoupledBalance::equation_error() const {
  double error = 0.0;
  const auto held = tip_rows();
  const int tip_from = held == ContactSystem::TipRows::all ? 0 : held == ContactSystem::TipRows::axial ? 2 : 3;
  for (int c = 0; c < parts_.contacts.count(); ++c) {
    const Vec3 off = rows_.error(c).cwiseAbs().cwiseQuotient(system_.own_yield(c));
    for (int k = c == 0 ? tip_from : 0; k < 3; ++k) error = larger_or_nan(error, off[k]);
  }
  // A contact that is not held in a direction must carry nothing there.
  if (held == ContactSystem::TipRows::axial)
    error = larger_or_nan(error, (rows_.frame[0].leftCols<2>().transpose() * parts_.contacts.tip.force).norm());
  return error;
}

/// Force and motion of a contact in the present solution of the system.
ContactStates::Trial CoupledBalance::trial(int load) const {
  ContactStates::Trial result{.axial = system_.lambda[3 * load + 2]};
  if (load > 0) {
    const ShaftContact& contact = parts_.contacts.of_shaft(load);
    const double sign = contact.state == ShaftContact::State::backward ? -1.0 : 1.0;
    result.slides = ContactStates::way(contact, result.axial) + sign * system_.axial_excess(load);
  } else if (parts_.contacts.tip.state() == TipContact::State::open) {
    result.opening = system_.opening() / std::max(system_.own_yield(0)[2], kTiny);
  }
  return result;
}

/// A contact that is held again went back along the shaft; the right-hand side must know at once.
void CoupledBalance::change_and_tell(int load, Step& step) {
  const double s = load == 0 ? 0.0 : parts_.contacts.of_shaft(load).s;
  states_.change(load, trial(load), step);
  if (load == 0) return;
  rows_.gap.segment<3>(3 * load) -=
      (parts_.contacts.of_shaft(load).s - s) * rows_.frame[static_cast<std::size_t>(load)].col(2);
}

/// Solves the held rows, then lets every state that contradicts its own law change, until none does.
/// @param changed whether a state has
/// @param effort has ended where it was broken off
/// @return false when the matrix is singular
bool CoupledBalance::pivot(double h, Effort& effort, Step& step, bool& changed) {
  const InPhase in_phase(parts_.phases, StepPhase::solve);
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
    {
      const InPhase gathering(parts_.phases, StepPhase::gather);
      rows_.soften(parts_.contacts, h, foresees_cut_);
    }
    // The error of an old matrix may make states go to and fro.
    if (round == kAllAtOnce && !system_.factorise()) return false;
    if (!system_.solve(tip_rows())) return false;

    // Find the worst contradiction; while there are many, change all of them at once.
    double worst = kTiny;
    int worst_load = -1;
    for (int c = 0; c < parts_.contacts.count(); ++c) {
      const double size_of_it = states_.contradiction(c, trial(c));
      if (size_of_it > worst) {
        worst = size_of_it;
        worst_load = c;
      }
    }
    if (worst_load < 0) return true;

    changed = true;
    if (round >= kAllAtOnce) {
      change_and_tell(worst_load, step);
      continue;
    }
    const bool tip_too = states_.contradiction(0, trial(0)) > kTiny;
    for (int c = 1; c < parts_.contacts.count(); ++c) {
      if (states_.contradiction(c, trial(c)) > kTiny) change_and_tell(c, step);
    }
    if (tip_too) change_and_tell(0, step);
  }
  step.flags |= Step::contact_cycling;
  return true;
}

/// Moves a sliding contact along the needle by what the present solution says.
void CoupledBalance::slide(int load) {
  ShaftContact& contact = parts_.contacts.of_shaft(load);
  if (contact.sticks()) return;
  if (!ContactStates::is_frictionless(contact)) {
    contact.s = contact.s_start - contact.sense() * trial(load).slides;
    return;
  }
  const double s = parts_.contacts.arc(load);
  const Vec3 gap = contact.x + parts_.contacts.displacement(contact.point) - parts_.contacts.needle.point(s);
  contact.s = s + rows_.frame[static_cast<std::size_t>(load)].col(2).dot(gap);
}

/// Forces, shape and slides of the present solution.
void CoupledBalance::take_solution() {
  for (int c = 0; c < parts_.contacts.count(); ++c) {
    rows_.loads()[static_cast<std::size_t>(c)].force = -system_.push.segment<3>(3 * c);
    parts_.contacts.force(c).noalias() = rows_.frame[static_cast<std::size_t>(c)] * system_.lambda.segment<3>(3 * c);
  }
  {
    const InPhase in_phase(parts_.phases, StepPhase::needle_advance);
    parts_.contacts.needle.advance(rows_.loads());
  }
  for (int c = 1; c < parts_.contacts.count(); ++c) slide(c);
}

/// The cut goes on as the present solution says. @return whether it ended at a surface or between two elements: the tip
/// is held there
bool CoupledBalance::cut_on(double h, int iteration) {
  TipContact& tip = parts_.contacts.tip;
  if (!tip.cuts()) return false;
  const double proposed = std::max(0.0, tip.cutting_law(h).way(system_.lambda[2]));
  const double before = tip.cut.advance();
  const Index tet = tip.cut.at().tet;
  march(before + damping_of_cut(iteration) * (proposed - before));
  const double way = tip.cut.advance() - before;
  const Index now = tip.cut.at().tet;
  const bool ends = now != tet && now == left_tet_ && way > 0.0 && way < kShortCut_mm;
  if (now != tet && way < 0.0) left_tet_ = tet;
  if (!ends && !tip.cut.is_blocked()) return false;
  if (ends) tip.toggles = kMaxToggles + 1;  // it keeps its state
  tip.set_state(TipContact::State::stick);
  return true;
}

/// Whether an iterate is so far from where the sub-step began that it is no guide to the balance that was not found.
bool CoupledBalance::is_astray(double largest_at_start) const {
  const Needle& needle = parts_.contacts.needle;
  return !(parts_.contacts.largest_force() < kMostGrowth * largest_at_start &&
           (needle.point(needle.length()) - parts_.predictor.tip_start()).norm() < kMostMotion * needle.length());
}

/// Needle and tissue have no balance nearby: they stay as they were.
void CoupledBalance::give_way() {
  const InPhase in_phase(parts_.phases, StepPhase::tip);
  parts_.predictor.go_back(parts_.contacts.needle, parts_.contacts.tip, parts_.contacts.shaft.all());
}

bool CoupledBalance::solve(double h, Effort& effort, Step& step) {
  TipContact& tip = parts_.contacts.tip;
  Predictor& predictor = parts_.predictor;
  states_.begin(kMaxToggles);
  {
    const InPhase in_phase(parts_.phases, StepPhase::tip);
    tip.begin(parts_.contacts.forces());
  }
  if (const auto points = tangent_.take_prepared(parts_.contacts); !points.empty()) tissue_.take_points(points);
  const double largest_at_start = parts_.contacts.largest_force();
  left_tet_ = -1;
  bool from_start = !predictor.expects_forces();
  predictor.go_on(parts_.contacts.needle, tip, parts_.contacts.shaft.all());

  Progress progress;
  Index border_tet = -1;  // where the tip was when it was added to the matrix
  int before_break = 0;   // iterations that went into the balance in which a surface broke
  for (int all = 0; all < kMaxNewton; ++all) {
    int iteration = all - before_break;
    foresees_cut_ = iteration < kSmoothCut;
    double error = look(h);
    const bool found = iteration > 0 && !progress.changed && error < 1.0;
    if (found && tip.breaks_surface()) {
      const InPhase in_phase(parts_.phases, StepPhase::tip);
      const double hand_N =
          parts_.hand.when_tip_reached(tip.ahead.limit(), tip.history.start, parts_.contacts.forces());
      parts_.path.break_surface(hand_N, step);
      before_break = all;
      iteration = 0;  // another balance is looked for from here
      foresees_cut_ = true;
      error = look(h);
    } else if (found) {
      const double before = progress.before;
      const bool slow = error > (progress.quiet && iteration > kManyIterations ? kSlowish : kSlow) * before;
      if (slow && iteration > (progress.quiet ? kManyQuiet : kManyIterations)) tangent_.outdate();
      if (iteration > 1 && error > kWorn * before) tangent_.wear_out();
      if (iteration <= (tip.state() == TipContact::State::cut ? kTimeLeft - 1 : kTimeLeft))
        tangent_.prepare(parts_.contacts);
      // On bone a balance that took long is one of a snap and says little about the next. Elsewhere the matrix was old:
      // a sub-step that began where the last one ended, and not where this one will end, would take as long again.
      return progress.steady && (iteration <= kManyIterations || !tip.is_on_bone());
    }
    bool exact = progress.old_matrix_failed;
    progress.old_matrix_failed = false;
    if (iteration > 0 && !exact) {
      exact = progress.needs_tangent(error, iteration);
      // It led away: from where it began, with a new one.
      if (exact && progress.old_matrix && !progress.changed && !(error < progress.before)) {
        kept_.restore(parts_.contacts);
        error = look(h);
      }
    }
    if (all > 0 && !effort.allows(effort.iteration() + (exact ? effort.tangent() : 0.0))) break;
    effort.spend(effort.iteration());
    progress.before = iteration == 0 ? std::max(error, kNear / parts_.settings.tolerance) : error;
    ++step.iterations;
    progress.old_matrix = !exact && tangent_.relax();
    if (progress.old_matrix) {
      kept_.keep(parts_.contacts);
    } else {
      tangent_.linearise(parts_.contacts, predictor.last_way() > 0.0, effort);
      progress.new_tangent = true;
    }
    if (!system_.fits()) {
      const InPhase in_phase(parts_.phases, StepPhase::factorise);
      effort.spend(effort.matrix());
      system_.factorise();
    }
    if (system_.fits() && (iteration == 0 || !progress.old_matrix || border_tet != tip.cut.at().tet)) {
      border_tet = tip.cut.at().tet;
      const InPhase in_phase(parts_.phases, StepPhase::solve);
      system_.add_tip();
    }
    if (!system_.fits() || !pivot(h, effort, step, progress.changed)) {
      if (!progress.old_matrix) {
        progress.steady = false;
        give_way();
        if (from_start) {
          step.flags |= Step::not_converged;
          return false;
        }
        from_start = true;
      }
      progress.old_matrix_failed = true;
      continue;
    }
    if (effort.ended()) break;  // the states are not those of the solution
    progress.quiet = progress.quiet && !progress.changed;
    progress.steady = progress.steady && tip.toggles == 0;

    take_solution();
    if (cut_on(h, iteration)) {
      progress.changed = true;
      progress.steady = false;
    }
  }
  if (progress.changed || !(look(h) < kPoor)) {
    step.flags |= Step::not_converged;
    if (is_astray(largest_at_start)) {
      give_way();
    } else {
      const InPhase in_phase(parts_.phases, StepPhase::tip);
      tip.take_back_cut();
    }
  }
  return false;
}

}  // namespace stylet
