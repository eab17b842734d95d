// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/paper/staggered.hpp"

#include "coupling/insertion_parts.hpp"

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
///   │    in balance? ── yes ──► tip in a new element? remesh: cutting.cpp, contacts.cpp
///   │            │ no
///   └── bend the needle, damped                                                 bend_needle
///
/// What is ours: rows with a softness (young contacts), viscous friction, and how the needle is damped. A factor on the
/// needle's motion, as in the paper, fails once the forces on the needle exceed what it bears on its own (about 1 N for
/// 200 mm): it has no stable shape under them. Springs do what the factor was to do: each holds a point of the needle
/// where it is now, as hard as the tissue would if all other points stood still, so the iteration is Jacobi's with
/// blocks. At the end the springs carry nothing. docs/theory/paper.md has the derivation.
namespace stylet {

namespace {
constexpr int kMaxIterations = 500;
constexpr int kMaxToggles = 100;
constexpr long kSwitchesToRebuild = 20000;
constexpr double kTolerance = 1e-10;  ///< of imbalance()
constexpr double kNearly = 1e-8;      ///< … below which contacts may change their state: not on a passing shape
constexpr double kClear_N = 1e-7;     ///< a contact contradicts its state by more than what is still uncertain
constexpr double kSettled = 1e-2;     ///< weight of friction and cutting forces that still change
constexpr double kTiny = 1e-12;
constexpr double kNoLength_mm = 1e-6;  ///< a contact with less than this carries no friction
}  // namespace

using paper::Staggered;

/// K_W for the contacts there are: anew when the mesh or the set of contacts has changed, else only the tip moves on.
void Insertion::Parts::condense_tissue() {
  Staggered& s = *staggered;
  const int count = load_count();
  const bool same = s.version == compliance.version() && s.share == memory.share() && s.system.points() == count &&
                    std::equal(grips.begin(), grips.end(), s.points.begin() + 1, s.points.begin() + count,
                               [](const Grip& grip, int point) { return grip.point == point; });
  const auto enter = [&](int c) {
    const Mat3& Qc = frames[static_cast<std::size_t>(c)];
    for (int k = 0; k < s.system.points(); ++k) {
      const int d = s.load_of[static_cast<std::size_t>(k)];
      s.across.block<3, 3>(3 * k, 0).noalias() =
          s.share * s.frames[static_cast<std::size_t>(d)].transpose() * compliance(point_of(d), point_of(c)) * Qc;
    }
    const int k = s.system.add(s.across.topRows(3 * s.system.points()),
                               s.share * Qc.transpose() * compliance(point_of(c), point_of(c)) * Qc);
    s.slot_of[static_cast<std::size_t>(c)] = k;
    s.load_of[static_cast<std::size_t>(k)] = c;
    s.points[static_cast<std::size_t>(c)] = point_of(c);
    s.frames[static_cast<std::size_t>(c)] = Qc;
  };
  if (!same || s.system.switches() > kSwitchesToRebuild) {
    s.system.clear();
    s.version = compliance.version();
    s.share = memory.share();
    for (int c = 0; c < count; ++c) enter(c);
  } else if (s.tip != tip.x) {
    const int k = s.slot_of[0];
    s.system.remove(k);
    const int moved = s.load_of[static_cast<std::size_t>(s.system.points())];  // the last one took the tip's number
    s.slot_of[static_cast<std::size_t>(moved)] = k;
    s.load_of[static_cast<std::size_t>(k)] = moved;
    enter(0);
  }
  s.tip = tip.x;
}

/// Frames turn with the needle; then each row is given what its contact's state asks for.
void Insertion::Parts::impose_needle_on_tissue(double h) {
  Staggered& s = *staggered;
  soften_rows(h);
  for (int c = 0; c < load_count(); ++c) {
    const int k = s.slot_of[static_cast<std::size_t>(c)];
    Mat3& frame = s.frames[static_cast<std::size_t>(c)];
    const Mat3& now = frames[static_cast<std::size_t>(c)];
    if (frame != now) s.system.rotate(k, now.transpose() * frame);
    frame = now;

    const bool tip_row = c == 0;
    const Grip* grip = tip_row ? nullptr : &grips[static_cast<std::size_t>(c - 1)];
    const bool held = !tip_row || (tip.touching && tip.state != Tip::State::open);
    const bool lateral = held && (!tip_row || std::isfinite(tip.lateral_softness));
    const bool axial = tip_row ? held && tip.state == Tip::State::stick : grip->state == Grip::State::stick;
    const double softness = tip_row ? (lateral ? tip.lateral_softness : 0.0) : grip->softness;
    const double along = tip_row ? settings.axial_compliance_mm_per_N : grip->softness;
    s.system.set_softness(3 * k, softness);
    s.system.set_softness(3 * k + 1, softness);
    s.system.set_softness(3 * k + 2, along);
    s.system.control_displacement(3 * k, lateral);
    s.system.control_displacement(3 * k + 1, lateral);
    s.system.control_displacement(3 * k + 2, axial);

    const Vec3 gap = now.transpose() * (shaft_point(c) - unloaded(c));
    auto y = s.y.segment<3>(3 * k);
    y = Vec3::Zero();
    if (lateral) y.head<2>() = gap.head<2>() + system.shift.segment<2>(3 * c);
    if (tip_row && held && !lateral) y.head<2>() = now.leftCols<2>().transpose() * bevel_force();
    if (axial) y[2] = gap[2];
    if (!axial && held) y[2] = system.lambda[3 * c + 2];  // friction or cutting force, from the last iteration
  }
}

/// x = K_W y, then friction and cutting forces follow their laws at the displacements that come out (Gauss–Seidel over
/// the sliding rows: viscous forces depend on how far the needle slides).
void Insertion::Parts::solve_tissue(double h) {
  Staggered& s = *staggered;
  const Eigen::Index size = 3 * s.system.points();
  auto x = s.x.head(size);
  x.noalias() = s.system.matrix().lazyProduct(s.y.head(size));
  s.change = 0.0;
  for (int c = 0; c < load_count(); ++c) {
    const int row = 3 * s.slot_of[static_cast<std::size_t>(c)] + 2;
    if (s.system.is_displacement(row)) continue;
    const Mat3& Q = frames[static_cast<std::size_t>(c)];
    const double own = s.system(row, row);
    double force = 0.0;
    if (c == 0) {
      if (!tip.touching || tip.state != Tip::State::cut) continue;
      // The tip cuts as far as the needle is beyond the tissue: force = cutting force + viscosity × speed.
      const double slip = h / std::max(settings.tip_viscosity_Ns_per_mm, kTiny);
      const double beyond = Q.col(2).dot(shaft_point(0) - unloaded(0)) - x[row];
      s.advance = tip.advance + beyond / (Q.col(2).dot(tip.direction) + own / slip);
      force = tip.cutting + s.advance / slip;  // less than the cutting force: the needle goes back, see switch_contacts
      s.change = std::max(s.change, std::abs(force - s.y[row]));
    } else {
      Grip& grip = grips[static_cast<std::size_t>(c - 1)];
      const double ahead = x[row] - Q.col(2).dot(shaft_point(c) - unloaded(c));
      s.change = std::max(s.change, std::abs(ahead) / own);
      if (grip.length < kNoLength_mm) {  // no friction at all: it follows the tissue
        grip.s += ahead;
      } else {
        const double sign = grip.state == Grip::State::forward ? 1.0 : -1.0;
        grip.s += ahead / (1.0 + own / grip.slip);
        force = sign * grip.coulomb - (grip.s - grip.s_start) / grip.slip;
      }
    }
    const double change = force - s.y[row];
    s.y[row] = force;
    x += change * s.system.matrix().col(row);
  }
  for (int c = 0; c < load_count(); ++c) {
    const int k = s.slot_of[static_cast<std::size_t>(c)];
    for (int i = 0; i < 3; ++i)
      system.lambda[3 * c + i] = s.system.is_displacement(3 * k + i) ? x[3 * k + i] : s.y[3 * k + i];
    force_of(c).noalias() = frames[static_cast<std::size_t>(c)] * system.lambda.segment<3>(3 * c);
  }
}

/// Stick to slip where friction exceeds its limit, slip to stick where the motion turns round; the tip likewise.
/// @return true when a boundary condition was switched
bool Insertion::Parts::switch_contacts(StepReport& report) {
  const Staggered& s = *staggered;
  const int tip_row = 3 * s.slot_of[0] + 2;
  const double opening = frames[0].col(2).dot(shaft_point(0) - unloaded(0)) - s.x[tip_row];
  bool changed = false;
  for (int c = load_count() - 1; c >= 0; --c) {
    const double axial = system.lambda[3 * c + 2];
    const Trial trial{.axial = axial,
                      .slides = c > 0 ? way(grips[static_cast<std::size_t>(c - 1)], axial) : 0.0,
                      .opening = opening / std::max(s.system(tip_row, tip_row), kTiny)};
    if (contradiction(c, trial) <= kClear_N) continue;
    change_state(c, trial, report);
    changed = true;
  }
  return changed;
}

/// Contact forces go to the needle where they act, or to its nearest node as in the paper.
void Insertion::Parts::load_needle() {
  fill_loads();
  for (PointLoad& load : loads) load.s = loaded_arc(load.s);
}

double Insertion::Parts::loaded_arc(double s) const {
  const double spacing = settings.needle_node_mm;
  return spacing > 0.0 ? std::min(length(), std::round(s / spacing) * spacing) : s;
}

/// One Newton step of the needle under the tissue's forces, damped by springs as hard as the tissue around each contact
/// while all other contacts stand still.
void Insertion::Parts::bend_needle() {
  Staggered& s = *staggered;
  const int count = load_count();
  for (int c = 0; c < count; ++c) {
    const int k = s.slot_of[static_cast<std::size_t>(c)];
    Vec3 stiffness = Vec3::Zero();
    for (int i = 0; i < 3; ++i)
      if (s.system.is_displacement(3 * k + i)) stiffness[i] = s.system(3 * k + i, 3 * k + i);
    const Mat3& Q = frames[static_cast<std::size_t>(c)];
    springs[static_cast<std::size_t>(c)] = settings.damping * Q * stiffness.asDiagonal() * Q.transpose();
  }
  const auto size = static_cast<Eigen::Index>(3 * count);
  auto compliance_of_needle = system.N.topLeftCorner(size, size);
  auto motion = system.free.head(size);
  needle->linearise(loads, compliance_of_needle, motion, {springs.data(), static_cast<std::size_t>(count)});
  s.shape_before = needle->state();
  needle->advance(loads);
  s.shape_after = needle->state();
  s.acceleration.accelerate(s.shape_before, s.shape_after);
  needle->set_state(s.shape_after);
}

/// How far needle and tissue are from balance, over the largest force or 1 N: out-of-balance moment of the needle over
/// its length, and what friction and cutting forces still change by.
double Insertion::Parts::imbalance() const {
  double largest = 1.0;
  for (const PointLoad& load : loads) largest = std::max(largest, load.force.norm());
  return std::max(needle->residual(loads) / length(), kSettled * staggered->change) / largest;
}

/// Moves the end of the track to where the cut has come to.
/// @param nearly the balance is near enough to believe that a surface is in the way; the tip sticks there then
/// @return false when it does
bool Insertion::Parts::cut(bool nearly) {
  if (!tip.touching || tip.state != Tip::State::cut) return true;
  march(std::max(0.0, staggered->advance));
  if (!nearly || !tip.blocked) return true;
  tip.state = Tip::State::stick;
  return false;
}

void Insertion::Parts::solve_staggered(double h, StepReport& report) {
  begin_balance(kMaxToggles);
  set_frames();
  for (int c = 0; c < load_count(); ++c)
    system.lambda.segment<3>(3 * c) = frames[static_cast<std::size_t>(c)].transpose() * force_of(c);
  staggered->advance = 0.0;
  staggered->acceleration.restart();

  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    ++report.iterations;
    set_frames();
    condense_tissue();
    impose_needle_on_tissue(h);
    solve_tissue(h);
    load_needle();
    const double error = imbalance();
    if (error < kNearly && switch_contacts(report)) {
      staggered->acceleration.restart();
      continue;
    }
    if (cut(error < kNearly) && error < kTolerance) {
      if (!membrane_gives()) return;
      break_membrane(report);
      staggered->acceleration.restart();
      continue;
    }
    bend_needle();
  }
  report.flags |= StepReport::not_converged;
}

}  // namespace stylet
