// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/paper/staggered_balance.hpp"

#include <algorithm>
#include <cmath>

/// One iteration of the simulator of Goksel et al. 2005 (their figure 3): needle and tissue in turn.
///
///      base of the needle moves
///                │
///   ┌──► shape of the needle ──► displacements of the tissue it holds          impose_needle_on_tissue
///   │            │
///   │    x = K_W y: forces of the tissue                                        solve_tissue
///   │            │
///   │    forces to the nearest nodes of the needle                              load_needle
///   │            │
///   │    stick or slip: switch boundary conditions                              switch_contacts
///   │            │
///   │    tip cuts                                                               cut
///   │            │
///   │    in balance? ── yes ──► tip in a new element? remesh: TipPath::commit, Marks
///   │            │ no
///   └── bend the needle, damped                                                 bend_needle
///
/// Three things differ from the paper: rows with a softness (young contacts), viscous friction, and the damping of the
/// needle. The paper multiplies the needle's motion by a factor. This fails once the forces on the needle exceed its
/// buckling load (about 1 N for 200 mm), because the needle then has no stable shape under them. Springs replace the
/// factor: each holds a point of the needle at its present place, as stiffly as the tissue would if all other points
/// stood still, so the iteration is a block Jacobi iteration. At the end the springs carry no force.
/// docs/theory/paper.md has the derivation.
namespace stylet::paper {

namespace {
/// Iterations before a balance is given up. Raised, balances that do not converge cost more.
constexpr int kMaxIterations = 500;
/// A contact that changes its state more often than this in a sub-step keeps it. Raised, cycling costs more.
constexpr int kMostToggles = 100;
/// The balance is found when imbalance() is below this. Raised, forces are less exact.
constexpr double kTolerance = 1e-10;
/// Contacts may change their state only while imbalance() is below this, not on a passing shape. Raised, states
/// alternate more often.
constexpr double kNearly = 1e-8;
/// [N] Least contradiction that changes a contact's state; smaller ones are uncertain. Raised, states change later.
constexpr double kClear_N = 1e-7;
/// Weight in imbalance() of the last change of friction and cutting forces. Raised, they converge further.
constexpr double kSettled = 1e-2;
/// Smallest divisor.
constexpr double kSmallest = 1e-12;
}  // namespace

double loaded_arc(const CouplingSettings& settings, double length, double s) {
  const double spacing = settings.needle_node_mm;
  return spacing > 0.0 ? std::min(length, std::round(s / spacing) * spacing) : s;
}

StaggeredBalance::StaggeredBalance(const BalanceParts& parts)
    : parts_(parts),
      rows_(parts.settings, parts.settings.capacity + 1),
      states_(parts_.contacts),
      tissue_(parts.settings.capacity + 1),
      bent_(parts_.contacts.needle.state().size(), parts.settings.capacity + 1),
      force_(tissue_.controlled()) {}

/// Turns the frames with the needle, and prescribes the value of each row by its contact's state.
void StaggeredBalance::impose_needle_on_tissue(double h) {
  CondensedSystem& condensed = tissue_.system();
  const TipContact& tip = parts_.contacts.tip;
  rows_.soften(parts_.contacts, h);
  for (int c = 0; c < parts_.contacts.count(); ++c) {
    const Mat3& Q = rows_.frame[static_cast<std::size_t>(c)];
    tissue_.turn(c, Q);
    const int row = tissue_.row(c);
    const ShaftContact* contact = c == 0 ? nullptr : &parts_.contacts.of_shaft(c);
    const bool held = contact != nullptr || tip.holds();
    const bool lateral = held && (contact != nullptr || std::isfinite(tip.lateral_hold()));
    const bool axial = contact != nullptr ? contact->sticks() : held && tip.state() == TipContact::State::stick;
    const double softness = contact != nullptr ? contact->softness : lateral ? tip.lateral_hold() : 0.0;
    const double along = contact != nullptr ? contact->softness : parts_.settings.axial_compliance_mm_per_N;
    condensed.set_softness(row, softness);
    condensed.set_softness(row + 1, softness);
    condensed.set_softness(row + 2, along);
    condensed.control_displacement(row, lateral);
    condensed.control_displacement(row + 1, lateral);
    condensed.control_displacement(row + 2, axial);

    const Vec3 gap = Q.transpose() * (rows_.needle_at(c) - rows_.unloaded(parts_.contacts, c));
    auto y = tissue_.controlled().segment<3>(row);
    y = Vec3::Zero();
    if (lateral) y.head<2>() = gap.head<2>() + rows_.shift.segment<2>(3 * c);
    if (c == 0 && held && !lateral) y.head<2>() = Q.leftCols<2>().transpose() * tip.bevel_force();
    if (axial) y[2] = gap[2];
    if (!axial && held) y[2] = force_[3 * c + 2];  // friction or cutting force of the last iteration
  }
}

/// Computes x = K_W y; then friction and cutting forces follow their laws at the resulting displacements, by
/// Gauss–Seidel iteration over the sliding rows, because viscous forces depend on how far the needle slides.
void StaggeredBalance::solve_tissue(double h) {
  const CondensedSystem& condensed = tissue_.system();
  const TipContact& tip = parts_.contacts.tip;
  const Eigen::Index size = 3 * static_cast<Eigen::Index>(condensed.points());
  VecX& y = tissue_.controlled();
  auto x = tissue_.other().head(size);
  x.noalias() = condensed.matrix().lazyProduct(y.head(size));
  change_ = 0.0;
  for (int c = 0; c < parts_.contacts.count(); ++c) {
    const int row = tissue_.row(c) + 2;
    if (condensed.is_displacement(row)) continue;
    const Vec3 t = rows_.frame[static_cast<std::size_t>(c)].col(2);
    const double way = t.dot(rows_.needle_at(c) - rows_.unloaded(parts_.contacts, c));
    const double own = tissue_.own(row);
    double force = 0.0;
    if (c == 0) {
      if (!tip.cuts()) continue;
      // The tip cuts as far as the needle is beyond the tissue; below the law's initial force the needle is going back.
      const CuttingLaw law = tip.cutting_law(h);
      advance_ = tip.cut.advance() + (way - x[row]) / (t.dot(tip.cut.direction()) + own / law.slip_mm_per_N);
      force = law.force(advance_);
      change_ = std::max(change_, std::abs(force - y[row]));
    } else {
      ShaftContact& contact = parts_.contacts.of_shaft(c);
      const double ahead = x[row] - way;
      change_ = std::max(change_, std::abs(ahead) / own);
      if (ContactStates::is_frictionless(contact)) {
        contact.s += ahead;
      } else {
        contact.s += ahead / (1.0 + own / contact.slip);
        force = contact.sense() * contact.coulomb - (contact.s - contact.s_start) / contact.slip;
      }
    }
    const double change = force - y[row];
    y[row] = force;
    x += change * condensed.matrix().col(row);
  }
  for (int c = 0; c < parts_.contacts.count(); ++c) {
    const int row = tissue_.row(c);
    for (int i = 0; i < 3; ++i) force_[3 * c + i] = condensed.is_displacement(row + i) ? x[row + i] : y[row + i];
    parts_.contacts.force(c).noalias() = rows_.frame[static_cast<std::size_t>(c)] * force_.segment<3>(3 * c);
  }
}

/// Switches contacts from stick to slip where friction exceeds its limit, and from slip to stick where the motion
/// reverses; the tip likewise.
/// @return whether a boundary condition was switched
bool StaggeredBalance::switch_contacts(Step& step) {
  const int tip_row = tissue_.row(0) + 2;
  const double opening =
      rows_.frame[0].col(2).dot(rows_.needle_at(0) - rows_.unloaded(parts_.contacts, 0)) - tissue_.other()[tip_row];
  bool changed = false;
  for (int c = parts_.contacts.count() - 1; c >= 0; --c) {
    const double axial = force_[3 * c + 2];
    const ContactStates::Trial trial{.axial = axial,
                                     .slides = c > 0 ? ContactStates::way(parts_.contacts.of_shaft(c), axial) : 0.0,
                                     .opening = opening / std::max(tissue_.own(tip_row), kSmallest)};
    if (states_.contradiction(c, trial) <= kClear_N) continue;
    states_.change(c, trial, step);
    changed = true;
  }
  return changed;
}

/// Applies the contact forces to the needle, at the contact or, as in the paper, at the needle's nearest node.
void StaggeredBalance::load_needle() {
  rows_.take_loads(parts_.contacts);
  for (PointLoad& load : rows_.loads()) load.s = loaded_arc(parts_.settings, parts_.contacts.needle.length(), load.s);
}

/// Takes one Newton step of the needle under the tissue's forces, damped by springs as stiff as the tissue around each
/// contact while all other contacts stand still.
void StaggeredBalance::bend_needle() {
  const CondensedSystem& condensed = tissue_.system();
  const int count = parts_.contacts.count();
  for (int c = 0; c < count; ++c) {
    const int row = tissue_.row(c);
    Vec3 stiffness = Vec3::Zero();
    for (int i = 0; i < 3; ++i)
      if (condensed.is_displacement(row + i)) stiffness[i] = tissue_.own(row + i);
    const Mat3& Q = rows_.frame[static_cast<std::size_t>(c)];
    bent_.spring(c) = parts_.settings.damping * Q * stiffness.asDiagonal() * Q.transpose();
  }
  bent_.bend(parts_.contacts.needle, rows_.loads());
}

/// Distance from balance, over the largest force or 1 N: the out-of-balance moment of the needle over its length, and
/// the last change of friction and cutting forces.
double StaggeredBalance::imbalance() const {
  Needle& needle = parts_.contacts.needle;
  return std::max(needle.residual(rows_.loads()) / needle.length(), kSettled * change_) / rows_.largest_load();
}

/// Moves the end of the track by the length of cut.
/// @param nearly whether the balance is near enough to trust that a surface or the end of a leg has been met; the tip
/// then sticks there @return false when it does
bool StaggeredBalance::cut(bool nearly) {
  TipContact& tip = parts_.contacts.tip;
  if (!tip.cuts()) return true;
  const double advance = std::max(0.0, advance_);
  if (!nearly) {
    tip.cut.march(advance);
    return true;
  }
  tip.cut.march_in_leg(advance);
  if (!tip.cut.is_blocked() && !tip.cut.ends_leg()) return true;
  tip.set_state(TipContact::State::stick);
  return false;
}

bool StaggeredBalance::solve(double h, Effort& /*effort*/, Step& step) {
  TipContact& tip = parts_.contacts.tip;
  states_.begin(kMostToggles);
  tip.begin(parts_.contacts.forces());
  rows_.take_places(parts_.contacts);
  for (int c = 0; c < parts_.contacts.count(); ++c)
    force_.segment<3>(3 * c) = rows_.frame[static_cast<std::size_t>(c)].transpose() * parts_.contacts.force(c);
  advance_ = 0.0;
  bent_.restart();

  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    ++step.iterations;
    rows_.take_places(parts_.contacts);
    tissue_.take(parts_.contacts, rows_.frame);
    impose_needle_on_tissue(h);
    solve_tissue(h);
    load_needle();
    const double error = imbalance();
    if (error < kNearly && switch_contacts(step)) {
      bent_.restart();
      continue;
    }
    if (cut(error < kNearly) && error < kTolerance) {
      if (tip.cut.ends_leg()) {
        parts_.path.end_leg(h, parts_.contacts.forces());
        bent_.restart();
        continue;
      }
      if (!tip.breaks_surface()) return false;
      parts_.path.break_surface(
          parts_.hand.when_tip_reached(tip.ahead.limit(), tip.history.start, parts_.contacts.forces()), step);
      tip.aim(parts_.contacts.forces());
      bent_.restart();
      continue;
    }
    bend_needle();
  }
  step.flags |= Step::not_converged;
  return false;
}

}  // namespace stylet::paper
