// SPDX-License-Identifier: GPL-3.0-or-later
#include "insertion_parts.hpp"

#include <algorithm>
#include <cmath>

/// One sub-step's balance. Unknown are the contact forces f (on the tissue; the needle gets −f). With the tissue's
/// compliance A and the needle's tangent compliance N every held direction d of contact c gives one row
///   d·(X_c + A f − r(s_c) + softness f) = 0,    r(s_c) = r + free − N (f − f_old),
/// so the matrix of the held rows is dᵀ(A + N)d + diag(softness): symmetric positive definite. Sliding and cutting stay
/// in the system as soft rows (viscous friction is a compliance h/(bℓ)), so a change of state changes one diagonal
/// entry. Newton's iteration goes over the needle's geometry, the frames, and the place of the cut.
namespace stylet {

namespace {
constexpr int kMaxNewton = 30;
constexpr int kMaxPivots = 60;
constexpr int kMaxToggles = 6;
constexpr double kNeedleShare = 0.1;  ///< of the tolerance: out-of-balance moment over the largest force × the length
constexpr double kTiny = 1e-12;
constexpr double kNoLength_mm = 1e-6;  ///< a contact with less than this carries no friction
constexpr double kStill_mm = 1e-9;     ///< less is not sliding
/// On either side of the speed where friction stops growing its two laws agree; so little says nothing about the side.
constexpr double kSameSpeed_mm = 1e-6;
/// [N s/mm²] Friction without viscosity would leave a sliding contact's place undetermined: at 100 mm/s this adds 1e-7
/// N/mm.
constexpr double kLeastViscosity = 1e-9;
/// What is left of friction's growth with speed beyond the speed where it ends: enough to tell how far a contact
/// slides.
constexpr double kFlat = 1e-3;

/// Newton's iteration takes the tissue's compliance at the tip as it is, not as it changes with the cut. Where it
/// changes fast (next to held tissue) the cut would jump to and fro: it is followed the more slowly the longer that
/// lasts.
double damping_of_cut(int iteration) {
  constexpr int patience = 6;
  return iteration < patience ? 1.0 : iteration < 2 * patience ? 0.5 : 0.25;
}
}  // namespace

double Insertion::Parts::arc_of(int load) const {
  return load == 0 ? length() : std::clamp(grips[static_cast<std::size_t>(load - 1)].s, 0.0, length());
}

Vec3 Insertion::Parts::shaft_point(int load) const {
  const double s = arc_of(load);
  const double beyond = load == 0 ? 0.0 : grips[static_cast<std::size_t>(load - 1)].s - s;
  return needle->point(s) + beyond * frames[static_cast<std::size_t>(load)].col(2);
}

void Insertion::Parts::gather_forces() {
  forces.leftCols(compliance.points()).setZero();
  forces.col(ContactCompliance::kTip) = tip.force;
  for (const Grip& grip : grips) forces.col(grip.point) = grip.force;
}

Vec3 Insertion::Parts::tissue_displacement(int point) const {
  Vec3 u = Vec3::Zero();
  const auto row = compliance.matrix().middleRows<3>(3 * point);
  u.noalias() += row.middleCols<3>(0) * tip.force;
  for (const Grip& grip : grips) u.noalias() += row.middleCols<3>(3 * grip.point) * grip.force;
  if (memory.on()) u = memory.share() * u + memory.displacement(compliance, point);
  return u;
}

void Insertion::Parts::set_frames() {
  for (int c = 0; c < load_count(); ++c) {
    const Vec3 t = needle->tangent(arc_of(c));
    // Any pair of normals will do: both lateral directions are treated alike.
    const Vec3 helper = std::abs(t.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
    const Vec3 n1 = t.cross(helper).normalized();
    Mat3& frame = frames[static_cast<std::size_t>(c)];
    frame.col(0) = n1;
    frame.col(1) = t.cross(n1);
    frame.col(2) = t;
    past[static_cast<std::size_t>(c)] = memory.displacement(compliance, point_of(c));
  }
}

void Insertion::Parts::fill_loads() {
  loads.resize(static_cast<std::size_t>(load_count()));
  for (int c = 0; c < load_count(); ++c) loads[static_cast<std::size_t>(c)] = {arc_of(c), -force_of(c)};
}

/// What each row adds to the diagonal, and to the right-hand side, in its present state.
void Insertion::Parts::soften_rows(double h) {
  system.shift.head(3 * load_count()).setZero();
  for (int c = 0; c < load_count(); ++c) {
    double lateral = 0.0;
    double axial = 0.0;
    double shift = 0.0;
    if (c == 0) {
      lateral = tip_lateral_softness();
      system.shift.head<2>().noalias() = lateral * (frames[0].leftCols<2>().transpose() * bevel_force());
      axial = settings.axial_compliance_mm_per_N;
      if (tip.state == Tip::State::cut) {
        const double slip = h / std::max(settings.tip_viscosity_Ns_per_mm, kTiny);
        axial += slip;
        shift = slip * tip.cutting + tip.advance;
      }
    } else {
      Grip& grip = grips[static_cast<std::size_t>(c - 1)];
      const double slow = std::max(grip.law.viscous_Ns_per_mm2, kLeastViscosity);
      const double viscosity = grip.fast ? std::max(kFlat * slow, kLeastViscosity) : slow;
      grip.coulomb = grip.law.coulomb_N_per_mm * grip.length;
      if (grip.fast) grip.coulomb += (slow - viscosity) * grip.law.viscous_to_mm_per_s * grip.length;
      grip.slip = h / std::max(viscosity * grip.length, kTiny);
      grip.reach = slow > kLeastViscosity ? grip.law.viscous_to_mm_per_s * h : std::numeric_limits<double>::infinity();
      lateral = grip.softness;
      axial = grip.softness;
      if (grip.state == Grip::State::stick) {
        shift = 0.0;
      } else {
        const double sign = grip.state == Grip::State::forward ? 1.0 : -1.0;
        axial += grip.slip;
        shift = grip.slip * sign * grip.coulomb + grip.s_start - grip.s;
      }
    }
    system.D.segment<3>(3 * c) << lateral, lateral, axial;
    system.shift[3 * c + 2] = shift;
  }
}

/// The needle's tangent at its present shape and everything else of the linear equations that no change of state
/// changes.
void Insertion::Parts::linearise() {
  const int count = load_count();
  const auto size = static_cast<Eigen::Index>(3 * count);
  auto compliance_of_needle = N.topLeftCorner(size, size);
  auto motion = free.head(size);
  system.spring.head(size).setZero();
  system.supported = !needle->linearise(loads, compliance_of_needle, motion);
  if (system.supported) {  // pressed harder than it can bear on its own: lend it the tissue's stiffness at each contact
    lend_springs();
    needle->linearise(loads, compliance_of_needle, motion, {springs.data(), static_cast<std::size_t>(count)});
  }
  for (int c = 0; c < count; ++c) {
    const Mat3& Qc = frames[static_cast<std::size_t>(c)];
    const Vec3 freely = free.segment<3>(3 * c);
    const Vec3 gap = shaft_point(c) + freely - unloaded(c);
    system.gap.segment<3>(3 * c).noalias() = Qc.transpose() * gap;
    system.free.segment<3>(3 * c).noalias() = Qc.transpose() * freely;
    system.now.segment<3>(3 * c).noalias() = Qc.transpose() * force_of(c);
    for (int d = 0; d < count; ++d) {
      const Mat3& Qd = frames[static_cast<std::size_t>(d)];
      system.N.block<3, 3>(3 * c, 3 * d).noalias() = Qc.transpose() * N.block<3, 3>(3 * c, 3 * d) * Qd;
      if (d <= c)
        system.A.block<3, 3>(3 * c, 3 * d).noalias() =
            memory.share() * Qc.transpose() * compliance(point_of(c), point_of(d)) * Qd;
    }
  }
  system.begin(size);
}

/// Lateral springs as stiff as the tissue is at each contact by itself: stiffer together than the tissue as a whole, so
/// the needle on them does not buckle where needle and tissue together do not.
void Insertion::Parts::lend_springs() {
  constexpr double hardest_mm_per_N = 1e-3;
  for (int c = 0; c < load_count(); ++c) {
    double own = memory.share() * compliance(point_of(c), point_of(c)).trace() / 3.0;
    bool lend = true;
    if (c == 0) {
      lend = grips.empty() && tip.touching && tip.state != Tip::State::open;
    } else {
      own += grips[static_cast<std::size_t>(c - 1)].softness;
    }
    const double stiffness = lend ? 1.0 / std::max(own, hardest_mm_per_N) : 0.0;
    const Mat3& Q = frames[static_cast<std::size_t>(c)];
    springs[static_cast<std::size_t>(c)] = stiffness * Q.leftCols<2>() * Q.leftCols<2>().transpose();
    system.spring.segment<2>(3 * c).setConstant(stiffness);
  }
}

void Insertion::Parts::select_rows() {
  std::vector<int>& rows = system.rows;
  rows.clear();
  if (tip.touching && tip.state != Tip::State::open) {
    if (tip_lateral_rows()) {
      rows.push_back(0);
      rows.push_back(1);
    }
    rows.push_back(2);
  }
  for (int r = 3; r < 3 * load_count(); ++r) rows.push_back(r);
}

/// By how much [N] a solution contradicts the state of a contact; 0 = consistent, or frozen.
double Insertion::Parts::contradiction(int load, double axial, double opening) const {
  if (load == 0) {
    if (!tip.touching || tip.toggles > toggle_limit) return 0.0;
    switch (tip.state) {
      case Tip::State::open:
        return opening;
      case Tip::State::stick:
        return std::max(-axial, tip.blocked || tip.held ? 0.0 : axial - tip.limit);
      case Tip::State::cut:
        return tip.advance > 0.0 ? 0.0 : tip.cutting - axial;
    }
  }
  const Grip& grip = grips[static_cast<std::size_t>(load - 1)];
  if (grip.toggles > toggle_limit || grip.length < kNoLength_mm) return 0.0;
  if (grip.state == Grip::State::stick) return std::abs(axial) - grip.law.static_N_per_mm * grip.length;
  // Sliding the other way than its state says, or faster or slower. A length is what tells, since forces hardly differ
  // where friction does not depend on speed; it counts as the force that pushes the tissue so far.
  const double slides = way(grip, axial);
  const double wrong =
      grip.fast ? grip.reach - slides - kSameSpeed_mm : std::max(-slides, slides - grip.reach - kSameSpeed_mm);
  return wrong > kStill_mm ? 3.0 * wrong / (memory.share() * compliance(grip.point, grip.point).trace()) : 0.0;
}

/// By how much [mm] a sliding contact slides in this sub-step, in the sense of its state, under an axial force.
double Insertion::Parts::way(const Grip& grip, double axial) {
  const double sign = grip.state == Grip::State::forward ? 1.0 : -1.0;
  return grip.slip * (sign * axial - grip.coulomb);
}

void Insertion::Parts::change_state(int load, double axial, StepReport& report) {
  ++report.pivots;
  if (load == 0) {
    if (++tip.toggles > toggle_limit) report.flags |= StepReport::contact_cycling;
    if (tip.state != Tip::State::stick) {
      tip.state = Tip::State::stick;
    } else if (axial < 0.0) {
      tip.state = Tip::State::open;
    } else {
      start_cut(report);
    }
    return;
  }
  Grip& grip = grips[static_cast<std::size_t>(load - 1)];
  if (++grip.toggles > toggle_limit) report.flags |= StepReport::contact_cycling;
  if (grip.state == Grip::State::stick) {
    grip.state = axial > 0.0 ? Grip::State::forward : Grip::State::backward;
    grip.fast = false;
    return;
  }
  if (grip.fast || way(grip, axial) > grip.reach) {
    grip.fast = !grip.fast;
    return;
  }
  grip.state = Grip::State::stick;
  grip.s = grip.s_start;  // back to where it was held
}

/// The same on the present solution of the coupled system.
double Insertion::Parts::contradiction(int load) const {
  const bool open = load == 0 && tip.state == Tip::State::open;
  return contradiction(load, system.lambda[3 * load + 2],
                       open ? system.opening(2) / std::max(system.yield(2), kTiny) : 0.0);
}

void Insertion::Parts::change_state(int load, StepReport& report) {
  const double s = load == 0 ? 0.0 : grips[static_cast<std::size_t>(load - 1)].s;
  change_state(load, system.lambda[3 * load + 2], report);
  // A contact that is held again went back along the shaft; the row's right-hand side must know at once.
  if (load > 0) system.move_row(3 * load + 2, grips[static_cast<std::size_t>(load - 1)].s - s);
}

/// Solves the held rows, then lets every state that contradicts its own law change, until none does.
/// @return true when a state has changed
bool Insertion::Parts::pivot(double h, StepReport& report) {
  bool changed = false;
  for (int round = 0; round < kMaxPivots; ++round) {
    soften_rows(h);
    select_rows();
    if (!system.solve()) {
      report.flags |= StepReport::not_converged;
      return changed;
    }

    // Find the worst contradiction; while there are many, change all of them at once.
    const bool all_at_once = round < 4;
    double worst = kTiny;
    int worst_load = -1;
    for (int c = 0; c < load_count(); ++c) {
      const double size_of_it = contradiction(c);
      if (size_of_it > worst) {
        worst = size_of_it;
        worst_load = c;
      }
    }
    if (worst_load < 0) return changed;

    changed = true;
    if (!all_at_once) {
      change_state(worst_load, report);
      continue;
    }
    const bool tip_too = contradiction(0) > kTiny;
    for (int c = 1; c < load_count(); ++c) {
      if (contradiction(c) > kTiny) change_state(c, report);
    }
    if (tip_too) change_state(0, report);
  }
  report.flags |= StepReport::contact_cycling;
  return changed;
}

/// Largest error of a held row at the present shape, as a force: error over the row's diagonal.
double Insertion::Parts::equation_error() const {
  double error = 0.0;
  for (const int r : system.rows) {
    const int c = r / 3;
    const int k = r % 3;
    const Mat3& Q = frames[static_cast<std::size_t>(c)];
    const Vec3& f = c == 0 ? tip.force : grips[static_cast<std::size_t>(c - 1)].force;
    const Vec3 gap = material_of(c) + tissue_displacement(point_of(c)) - shaft_point(c);
    const double value = Q.col(k).dot(gap) + system.D[r] * Q.col(k).dot(f) - system.shift[r];
    error = std::max(error, std::abs(value) / system.yield(r));
  }
  // A contact that is not held in a direction must carry nothing there.
  if (tip.touching && tip.state != Tip::State::open && !tip_lateral_rows()) {
    error = std::max(error, (frames[0].leftCols<2>().transpose() * tip.force).norm());
  }
  return error;
}

/// True when needle, tissue and laws are in balance to `slack` times the tolerance.
bool Insertion::Parts::balanced(double slack) const {
  double largest = 1.0;
  for (const PointLoad& load : loads) largest = std::max(largest, load.force.norm());
  const double allowed = slack * settings.tolerance * largest;
  return equation_error() < allowed && needle->residual(loads) < kNeedleShare * allowed * length();
}

/// Moves a sliding contact along the needle by what its friction law says.
void Insertion::Parts::slide(Grip& grip, const Mat3& frame, double axial) {
  if (grip.state == Grip::State::stick) return;
  if (grip.length < kNoLength_mm) {  // no friction at all: it follows the tissue
    const Vec3 gap = grip.x + tissue_displacement(grip.point) - needle->point(std::clamp(grip.s, 0.0, length()));
    grip.s = std::clamp(grip.s, 0.0, length()) + frame.col(2).dot(gap);
    return;
  }
  const double sign = grip.state == Grip::State::forward ? 1.0 : -1.0;
  grip.s = grip.s_start - sign * way(grip, axial);
}

/// Remembers where the tip was, and aims the cut.
void Insertion::Parts::begin_balance(int most_toggles) {
  toggle_limit = most_toggles;
  for (Grip& grip : grips) grip.toggles = 0;
  tip.toggles = 0;
  tip.blocked = tip.held = false;
  tip.x_start = tip.x;
  tip.at_start = tip.at;
  tip.advance = 0.0;
  if (tip.touching) aim_tip();
}

void Insertion::Parts::solve_equilibrium(double h, StepReport& report) {
  begin_balance(kMaxToggles);

  bool changed = true;
  for (int iteration = 0; iteration < kMaxNewton; ++iteration) {
    fill_loads();
    set_frames();
    if (iteration > 0) {
      soften_rows(h);
      if (!changed && balanced(1.0)) return;
    }
    ++report.iterations;
    linearise();
    changed = pivot(h, report);

    for (int c = 0; c < load_count(); ++c) {
      const Mat3& Q = frames[static_cast<std::size_t>(c)];
      loads[static_cast<std::size_t>(c)].force.noalias() = -(Q * system.p.segment<3>(3 * c));
      force_of(c).noalias() = Q * system.lambda.segment<3>(3 * c);
    }
    needle->advance(loads);
    for (std::size_t k = 0; k < grips.size(); ++k)
      slide(grips[k], frames[k + 1], system.lambda[3 * static_cast<Eigen::Index>(k) + 5]);
    if (tip.touching && tip.state == Tip::State::cut) {
      const double slip = h / std::max(settings.tip_viscosity_Ns_per_mm, kTiny);
      const double proposed = std::max(0.0, slip * (system.lambda[2] - tip.cutting));
      march(tip.advance + damping_of_cut(iteration) * (proposed - tip.advance));
      if (tip.blocked || tip.held) {
        tip.state = Tip::State::stick;
        changed = true;
      }
    }
  }
  fill_loads();
  set_frames();
  soften_rows(h);
  if (changed || !balanced(1e3)) report.flags |= StepReport::not_converged;
}

}  // namespace stylet
