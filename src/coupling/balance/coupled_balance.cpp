// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/coupled_balance.hpp"

#include "core/dense_kernels.hpp"
#include "core/largest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stylet {

namespace {
/// kMaxNewton: iterations before a balance is given up. Raised, balances that do not converge cost more.
constexpr int kMaxNewton = 30;
/// kMaxPivots: rounds of state changes before the states are taken as cycling. Raised, cycling costs more.
constexpr int kMaxPivots = 60;
/// kAllAtOnce: rounds in which all contradictions are resolved together; after them only the worst one is. Raised,
/// states may alternate for longer.
constexpr int kAllAtOnce = 4;
/// kManyIterations: refactorise before the next step if a balance took more iterations than this, and kSlow agrees.
/// Raised, matrices are kept longer.
constexpr int kManyIterations = 5;
/// kManySnapping: the same limit for a needle that snaps.
constexpr int kManySnapping = 3;
/// kSlow: refactorise only if the last iteration left more than this part of the error, because then the matrix is to
/// blame. Raised, matrices are kept longer.
constexpr double kSlow = 0.08;
/// kWorn: begin the next tangent if the last iteration left more than this part of the error. Raised, it is begun
/// later.
constexpr double kWorn = 0.01;
/// kMostSettling: Newton steps of needles at rest alone. Raised, needles that bend much are balanced more exactly.
constexpr int kMostSettling = 5;
/// kSettled [error over the largest load]: another Newton step follows where the error before the last one was larger.
/// Raised, needles at rest are balanced less exactly.
constexpr double kSettled = 3e-2;
/// kTimeLeft: a balance of at most this many iterations leaves time for a piece of the next tangent; for a tip that
/// cuts, one iteration less. Raised, the longest steps take longer.
constexpr int kTimeLeft = 4;
/// kTimeLeftSnapping: the same for a needle that snaps.
constexpr int kTimeLeftSnapping = 2;
/// kWorthATangent: keep the present tangent if this many more iterations would converge at the present rate; a new
/// tangent costs as much as some iterations. Raised, tangents are kept longer and more iterations are taken.
constexpr int kWorthATangent = 6;
/// kNear [error over the largest force]: if the first error is smaller than this, the rate of the first iteration is
/// judged as if the error had been this large. So near to the balance, a contact that changes its state or a cut that
/// goes a little further outweighs the initial error, whatever the matrix.
constexpr double kNear = 1e-4;
/// kFalls: where states have changed, keep a tangent that was made in this balance while each iteration leaves less
/// than this part of the error. Raised, fewer tangents are made in one balance.
constexpr double kFalls = 0.3;
/// kStatesMove: where states have just changed, the error of the first iteration may grow by this factor, because an
/// error of the states is not one of the tangent. Raised, fewer tangents are made at turns of the base.
constexpr double kStatesMove = 10.0;
/// kNeedleShare: tolerance of the needle's out-of-balance moment, over the largest force × the needle's length, as a
/// part of the tolerance. Raised, the needle's shape is less exact.
constexpr double kNeedleShare = 0.1;
/// kTiny [N]: contradictions below this are rounding. Also the least yield [mm/N] in a division.
constexpr double kTiny = 1e-12;
/// kPoor: when the iterations have ended, an error of up to this many times the tolerance is no failure. Raised, fewer
/// steps are flagged.
constexpr double kPoor = 1e3;
/// kMostGrowth: without a balance, an iterate whose largest force has grown by more than this factor is discarded.
/// Raised, forces may jump further in a flagged step.
constexpr double kMostGrowth = 2.0;
/// kMostMotion: the same for the motion of the tip, over the needle's length.
constexpr double kMostMotion = 0.1;
/// kLeastTurn_mm [mm]: the tip's direction is computed from the last contact that is further than this behind the tip.
/// Raised, it is computed from one further back.
constexpr double kLeastTurn_mm = 1.0;

/// kMostHalves: how often the step of an iteration that led away is halved. Raised, shorter steps are tried.
constexpr int kMostHalves = 8;
/// kShortCut_mm [mm]: compliance may jump between two elements, so that no place of the cut balances: in the first
/// element the cut would have to be longer, in the second shorter. If the cut enters an element that it has gone back
/// out of in this balance, by a step shorter than this, it ends there for this sub-step. Raised, a cut may be longer by
/// this.
constexpr double kShortCut_mm = 0.05;
}  // namespace

/// The state of a solve between its iterations.
struct CoupledBalance::Progress {
  double before = std::numeric_limits<double>::infinity();  ///< error over the tolerance, in the previous iteration
  /// The same in the iteration before that; infinite where a state has changed since.
  double earlier = std::numeric_limits<double>::infinity();
  /// The needle is damped, on bone or in a part of a sub-step, and may be far from its balance.
  bool snaps = false;
  bool changed = true;             ///< a state changed in the last iteration
  bool old_matrix = false;         ///< the last iteration used a tangent of an earlier shape
  bool old_matrix_failed = false;  ///< the last iteration used an old matrix and found no solution
  bool new_tangent = false;        ///< a tangent was made in this balance
  bool steady = true;              ///< result of solve()

  /// Whether a new tangent is worth its cost. @param error that of_tangent() @param iteration number of iterations so
  /// far
  [[nodiscard]] bool needs_tangent(double error, int iteration) const {
    if (error < 1.0) return false;
    // Contacts and needle take turns in being wrong, so that an iteration may leave nearly all of a small error of
    // which the next one leaves nothing. The mean over two iterations tells how fast they converge. A needle that snaps
    // has no iteration to lose.
    const double rate = iteration > 1 && !changed && !snaps ? std::sqrt(error / earlier) : error / before;
    const auto done_after = [&](int more) { return rate < 1.0 && error * std::pow(rate, more) < 1.0; };
    if (!changed) return iteration == 1 ? !(rate < 1.0) : !done_after(kWorthATangent);
    return new_tangent ? !(rate < kFalls || done_after(kWorthATangent))
                       : iteration > 1 || !(rate < (snaps ? 1.0 : kStatesMove));
  }
};

CoupledBalance::CoupledBalance(const BalanceParts& parts)
    : parts_(parts),
      rows_(parts.settings, parts.most_contacts + 1),
      system_(rows_, parts.most_contacts + 1, parts.contacts.first_own() - 1),
      states_(parts_.contacts),
      tissue_(system_, parts.most_contacts + 1),
      tangent_(parts_.contacts.needle, system_, rows_, parts.most_contacts + 1),
      kept_(parts_.contacts.needle.state().size(), parts.most_contacts) {}

/// Gathers the terms of the linear equations: the tissue's compliance among the contacts, the forces of the contacts,
/// and the gaps between tissue and needle.
void CoupledBalance::gather() {
  const int count = parts_.contacts.count();
  const auto size = static_cast<Eigen::Index>(3 * count);
  const int same = tissue_.renew(parts_.contacts);
  if (same < std::min(tissue_.before(), count)) {
    tangent_.outdate();
    system_.outdate_all();
  } else if (count < tissue_.before()) {  // the last contacts slid off the tip
    system_.keep_first(count);
  }
  tissue_.gather(parts_.contacts, same);
  for (int c = same; c < count; ++c) tangent_.append(c);

  auto now = rows_.now.head(size);
  auto gap = rows_.gap.head(size);
  for (int c = 0; c < count; ++c) now.segment<3>(3 * c) = parts_.contacts.force(c);
  for (int c = 0; c < count; ++c) gap.segment<3>(3 * c) = rows_.needle_at(c) - rows_.unloaded(parts_.contacts, c);
  dense::subtract_symmetric_product(gap, system_.A.topLeftCorner(size, size), now);
  gap = -gap;
  const TipRelief relief = parts_.contacts.tissue.relief(parts_.contacts.forces());
  if (relief.is_any()) {
    for (int c = 0; c < count; ++c) gap.segment<3>(3 * c) -= relief.of(parts_.contacts.point(c));
    tissue_.stiffen(relief);
  }
  rows_.tip.behind = 0;
  if (!parts_.contacts.tip.touches()) return;
  tissue_.gather_drift(parts_.contacts, relief, rows_);
  for (int c = count - 1; c >= parts_.contacts.first_own() && rows_.tip.behind == 0; --c) {
    rows_.tip.behind_mm = rows_.loads().front().s - rows_.loads()[static_cast<std::size_t>(c)].s;
    if (rows_.tip.behind_mm > kLeastTurn_mm) rows_.tip.behind = c;
  }
}

/// Evaluates all terms at the present iterate. @return the largest error of needle, tissue and laws, over the tolerance
double CoupledBalance::look(double h) {
  rows_.take_loads(parts_.contacts);
  rows_.take_places(parts_.contacts);
  rows_.soften(parts_.contacts, h);
  gather();
  const double of_rest =
      larger_or_nan(error_of(1, parts_.contacts.count()), parts_.contacts.needle.residual(rows_.loads()) / moment());
  error_of_rest_ = of_rest / rows_.allowed();
  return larger_or_nan(error_of_tip() / rows_.allowed(), error_of_rest_);
}

/// [mm] The needle's out-of-balance moment over this length counts as a force.
double CoupledBalance::moment() const { return kNeedleShare * parts_.contacts.needle.length(); }

/// Whether needles at rest have the largest error at the present iterate.
bool CoupledBalance::resting_needles_lag() const {
  NeedleBundle* const bundle = parts_.contacts.bundle;
  if (bundle == nullptr) return false;
  const int first_own = parts_.contacts.first_own();
  const double own = larger_or_nan(larger_or_nan(error_of_tip(), error_of(first_own, parts_.contacts.count())),
                                   bundle->residual_of_moving(rows_.loads()) / moment());
  return larger_or_nan(error_of(1, first_own), bundle->residual_of_resting(rows_.loads()) / moment()) > own;
}

ContactSystem::TipRows CoupledBalance::tip_rows() const {
  if (!parts_.contacts.tip.holds()) return ContactSystem::TipRows::none;
  return parts_.contacts.tip.has_lateral_rows() ? ContactSystem::TipRows::all : ContactSystem::TipRows::axial;
}

/// The largest error of the rows of the shaft contacts first … end − 1 at the present shape, as a force [N]: the error
/// divided by the row's own yield.
double CoupledBalance::error_of(int first, int end) const {
  double error = 0.0;
  for (int c = first; c < end; ++c) {
    const Vec3 off = rows_.error(c).cwiseAbs().cwiseQuotient(system_.own_yield(c));
    for (int k = 0; k < 3; ++k) error = larger_or_nan(error, off[k]);
  }
  return error;
}

/// The same for the tip.
double CoupledBalance::error_of_tip() const {
  const auto held = tip_rows();
  const int from = held == ContactSystem::TipRows::all ? 0 : held == ContactSystem::TipRows::axial ? 2 : 3;
  const Vec3 off = rows_.error(0).cwiseAbs().cwiseQuotient(system_.own_yield(0));
  double error = 0.0;
  for (int k = from; k < 3; ++k) error = larger_or_nan(error, off[k]);
  // In a direction in which the tip is not held, its force must be zero.
  if (held == ContactSystem::TipRows::axial)
    error = larger_or_nan(error, (rows_.frame[0].leftCols<2>().transpose() * parts_.contacts.tip.force).norm());
  return error;
}

/// Force and motion of a contact in the present solution.
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

/// Changes the state of a contact. A contact that sticks again returns to its place at the start of the sub-step, and
/// the right-hand side has to follow at once.
void CoupledBalance::change_and_tell(int load, Step& step) {
  const double s = load == 0 ? 0.0 : parts_.contacts.of_shaft(load).s;
  states_.change(load, trial(load), step);
  if (load == 0) return;
  rows_.gap.segment<3>(3 * load) -=
      (parts_.contacts.of_shaft(load).s - s) * rows_.frame[static_cast<std::size_t>(load)].col(2);
}

/// Solves the held rows, and changes the states that contradict their laws, until no state does.
/// @param effort ended where the solution was broken off
/// @param changed set to whether a state has changed
/// @return false when the matrix is singular
bool CoupledBalance::pivot(double h, Effort& effort, Step& step, bool& changed) {
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
    rows_.soften(parts_.contacts, h);
    // The error of an old matrix may make states alternate.
    if (round == kAllAtOnce && !system_.factorise()) return false;
    if (!system_.solve(tip_rows())) return false;

    // Find the worst contradiction. In the first rounds change all states that contradict their laws.
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

/// Moves a sliding contact along the needle to its place in the present solution.
void CoupledBalance::slide(int load) {
  ShaftContact& contact = parts_.contacts.of_shaft(load);
  if (contact.sticks()) return;
  if (!ContactStates::is_frictionless(contact)) {
    contact.s = contact.s_start - contact.sense() * trial(load).slides;
    return;
  }
  const double s = parts_.contacts.arc(load);
  const Vec3 gap = contact.x + parts_.contacts.displacement(contact.point) - parts_.contacts.needle_of(load).point(s);
  contact.s = s + rows_.frame[static_cast<std::size_t>(load)].col(2).dot(gap);
}

/// Takes over the forces, the shape and the slides of the present solution.
void CoupledBalance::take_solution() {
  for (int c = 0; c < parts_.contacts.count(); ++c) {
    rows_.loads()[static_cast<std::size_t>(c)].force = -system_.push.segment<3>(3 * c);
    parts_.contacts.force(c).noalias() = rows_.frame[static_cast<std::size_t>(c)] * system_.lambda.segment<3>(3 * c);
  }
  parts_.contacts.needle.advance(rows_.loads());
  for (int c = 1; c < parts_.contacts.count(); ++c) slide(c);
}

/// Moves the cut to its place in the present solution. @return whether the cut ended at a surface, between two elements
/// or with its leg, where the tip is now held
bool CoupledBalance::cut_on(double h) {
  TipContact& tip = parts_.contacts.tip;
  if (!tip.cuts()) return false;
  const double proposed = std::max(0.0, tip.cutting_law(h).way(system_.lambda[2]));
  const double before = tip.cut.advance();
  const Index tet = tip.cut.at().tet;
  tip.cut.march_in_leg(search_.next(before, proposed));
  const double way = tip.cut.advance() - before;
  const Index now = tip.cut.at().tet;
  const bool ends = now != tet && now == search_.left_tet && way > 0.0 && way < kShortCut_mm;
  if (now != tet && way < 0.0) search_.left_tet = tet;
  if (!ends && !tip.cut.is_blocked() && !tip.cut.ends_leg()) return false;
  if (ends) tip.toggles = kMostToggles + 1;  // the tip keeps this state for the sub-step
  tip.set_state(TipContact::State::stick);
  return true;
}

/// Whether an iterate without a balance is so far from the start of the sub-step that it is not kept.
bool CoupledBalance::is_astray() const {
  const Needle& needle = parts_.contacts.needle;
  return !(parts_.contacts.largest_force() < kMostGrowth * largest_at_start_ &&
           (needle.point(needle.length()) - parts_.predictor.tip_start()).norm() < kMostMotion * needle.length());
}

/// Restores needle and tissue to the start of the sub-step.
void CoupledBalance::give_way() {
  parts_.predictor.go_back(parts_.contacts.needle, parts_.contacts.tip, parts_.contacts.grips());
}

/// The part of an error that the needle's tangent is to blame for, over the tolerance. While the tip cuts, the tip's
/// error is that of the length of cut, which CutSearch finds with any tangent.
double CoupledBalance::of_tangent(double error) const { return parts_.contacts.tip.cuts() ? error_of_rest_ : error; }

/// Halves the step of an iteration that led away, until it leads nearer to the balance.
/// @param error of the present iterate @param before error of the iterate before, both over the tolerance
/// @return the error, over the tolerance
double CoupledBalance::shorten(double h, double error, double before) {
  const auto led_away = [&] { return of_tangent(error) > 1.0 && !(of_tangent(error) < before); };
  if (!led_away()) return error;
  for (int halves = 0; halves < kMostHalves && led_away(); ++halves) {
    kept_.halve_step(parts_.contacts);
    error = look(h);
  }
  search_.forget();
  return error;
}

/// A balance is found: judges the tangent by its last iteration, and goes on with the next tangent if there is time.
void CoupledBalance::watch_tangent(const Progress& progress, int iteration) {
  const double before = progress.before;
  const int many = progress.snaps ? kManySnapping : kManyIterations;
  if (iteration > many && error_of_rest_ > kSlow * before) tangent_.outdate();
  if (iteration > 1 && error_of_rest_ > kWorn * before) tangent_.wear_out();
  const int most = progress.snaps ? kTimeLeftSnapping : kTimeLeft;
  if (iteration <= (parts_.contacts.tip.cuts() ? most - 1 : most)) tangent_.prepare(parts_.contacts);
}

bool CoupledBalance::settle_rest(double h) {
  Contacts& contacts = parts_.contacts;
  for (int iteration = 0; iteration < kMostSettling; ++iteration) {
    look(h);
    const double error = larger_or_nan(error_of(1, contacts.first_own()),
                                       contacts.bundle->residual_of_resting(rows_.loads()) / moment());
    const bool fit = tangent_.relax_resting(contacts);
    rows_.tip.cut_per_N = 0.0;
    if (!system_.settle_rest()) return false;
    for (int c = 1; c < contacts.first_own(); ++c) {
      rows_.loads()[static_cast<std::size_t>(c)].force = -system_.push.segment<3>(3 * c);
      contacts.force(c).noalias() = rows_.frame[static_cast<std::size_t>(c)] * system_.lambda.segment<3>(3 * c);
    }
    contacts.bundle->advance_resting(rows_.loads());
    for (int c = 1; c < contacts.first_own(); ++c) slide(c);
    if (fit && error < kSettled * rows_.largest_load()) break;
  }
  return true;
}

bool CoupledBalance::solve(double h, Effort& effort, Step& step) {
  TipContact& tip = parts_.contacts.tip;
  Predictor& predictor = parts_.predictor;
  states_.begin(kMostToggles);
  tip.begin(parts_.contacts.forces());
  if (const auto points = tangent_.take_prepared(parts_.contacts); !points.empty()) tissue_.take_points(points);
  search_.begin();
  bool from_start = !predictor.expects_forces();
  predictor.go_on(parts_.contacts.needle, tip, parts_.contacts.grips());

  Progress progress;
  progress.snaps = tangent_.is_damped();
  Index border_tet = -1;  // element of the tip when it was last added to the matrix
  int earlier = 0;        // iterations up to the balance in which a surface broke, or a leg of the cut ended
  for (int all = 0; all < earlier + kMaxNewton; ++all) {
    int iteration = all - earlier;
    double error = look(h);
    const bool found = iteration > 0 && !progress.changed && error < 1.0;
    if (found && tip.breaks_surface()) {
      const double hand_N =
          parts_.hand.when_tip_reached(tip.ahead.limit(), tip.history.start, parts_.contacts.own_forces());
      parts_.path.break_surface(hand_N, step);
      tip.aim(parts_.contacts.forces());
      earlier = all;
      search_.forget();
      iteration = 0;  // the search for the next balance starts here
      error = look(h);
    } else if (found && tip.cut.ends_leg()) {
      if (parts_.path.end_leg(h, parts_.contacts.forces())) {
        earlier = all;
        search_.forget();
        effort.renew();
        iteration = 0;
      }
      progress.changed = true;
      progress.steady = false;
      error = look(h);
    } else if (found) {
      watch_tangent(progress, iteration);
      // On bone, a balance that took long belongs to a snap and does not predict the next one. Elsewhere the matrix was
      // old; without the predictor the next sub-step would take as long again.
      return progress.steady && (iteration <= kManyIterations || !tip.is_on_bone());
    }
    if (iteration > 0 && !progress.changed && !progress.old_matrix) error = shorten(h, error, progress.before);
    bool exact = progress.old_matrix_failed;
    progress.old_matrix_failed = false;
    if (iteration > 0 && !exact) {
      exact = progress.needs_tangent(of_tangent(error), iteration);
      // The old tangent led away: restore the iterate before, and use a new tangent from there.
      if (exact && progress.old_matrix && !progress.changed && !(of_tangent(error) < progress.before)) {
        kept_.restore(parts_.contacts);
        error = look(h);
      }
    }
    system_.solve_all_at_rest(iteration > 1 && !(error < kFalls * progress.before));
    if (all > 0 && !effort.allows(effort.iteration() + (exact ? effort.tangent() : 0.0))) break;
    effort.spend(effort.iteration());
    progress.earlier = iteration == 0 || progress.changed ? std::numeric_limits<double>::infinity() : progress.before;
    progress.before = iteration == 0 ? std::max(error, kNear / parts_.settings.tolerance) : error;
    ++step.iterations;
    progress.old_matrix = !exact && tangent_.relax();
    kept_.keep(parts_.contacts);
    if (!progress.old_matrix) {
      tangent_.linearise(parts_.contacts, progress.new_tangent && resting_needles_lag(), predictor.last_way() > 0.0,
                         effort);
      progress.new_tangent = true;
    }
    if (!system_.fits()) {
      effort.spend(effort.matrix());
      system_.factorise();
    }
    if (system_.fits() && (iteration == 0 || !progress.old_matrix || border_tet != tip.cut.at().tet)) {
      border_tet = tip.cut.at().tet;
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
    if (effort.ended()) break;  // the states do not belong to the solution
    progress.steady = progress.steady && tip.toggles == 0;

    take_solution();
    if (progress.changed) search_.forget();
    if (cut_on(h)) {
      progress.changed = true;
      progress.steady = false;
    }
  }
  // The last iteration may have led away from an iterate that was good enough.
  if (!progress.changed && progress.before < kPoor && !(look(h) < kPoor)) kept_.restore(parts_.contacts);
  if (progress.changed || !(look(h) < kPoor)) {
    step.flags |= Step::not_converged;
    if (is_astray()) {
      give_way();
    } else {
      tip.take_back_cut();
    }
  }
  return false;
}

}  // namespace stylet
