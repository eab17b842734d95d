// SPDX-License-Identifier: GPL-3.0-or-later
#include "insertion_parts.hpp"

#include "../needle/cholesky.hpp"

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
constexpr double kTolerance_N = 1e-9;      ///< error of a row over its diagonal: a force
constexpr double kNeedleTolerance = 1e-8;  ///< [N mm]
constexpr double kTiny = 1e-12;
constexpr double kNoLength_mm = 1e-6;  ///< a contact with less than this carries no friction
}  // namespace

double Insertion::Parts::arc_of(int load) const {
  return load == 0 ? length() : std::clamp(grips[static_cast<std::size_t>(load - 1)].s, 0.0, length());
}

void Insertion::Parts::gather_forces() {
  forces.leftCols(compliance.points()).setZero();
  forces.col(TrackCompliance::kTip) = tip.force;
  for (const Grip& grip : grips) forces.col(grip.point) = grip.force;
}

Vec3 Insertion::Parts::tissue_displacement(int point) const {
  Vec3 u = Vec3::Zero();
  const auto row = compliance.matrix().middleRows<3>(3 * point);
  u.noalias() += row.middleCols<3>(0) * tip.force;
  for (const Grip& grip : grips) u.noalias() += row.middleCols<3>(3 * grip.point) * grip.force;
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
  }
}

void Insertion::Parts::fill_loads() {
  loads.resize(static_cast<std::size_t>(load_count()));
  for (int c = 0; c < load_count(); ++c) loads[static_cast<std::size_t>(c)] = {arc_of(c), -force_of(c)};
}

/// What each row adds to the diagonal, and to the right-hand side, in its present state.
void Insertion::Parts::soften_rows(double h) {
  softening.head(3 * load_count()).setZero();  // right-hand side parts
  for (int c = 0; c < load_count(); ++c) {
    double lateral = 0.0;
    double axial = 0.0;
    double shift = 0.0;
    if (c == 0) {
      lateral = std::isfinite(tip.lateral_softness) ? tip.lateral_softness : 0.0;
      axial = settings.axial_compliance_mm_per_N;
      if (tip.state == Tip::State::cut) {
        const double slip = h / std::max(settings.tip_viscosity_Ns_per_mm, kTiny);
        axial += slip;
        shift = slip * tip.cutting + tip.advance;
      }
    } else {
      const Grip& grip = grips[static_cast<std::size_t>(c - 1)];
      lateral = grip.softness;
      axial = grip.softness;
      if (grip.state == Grip::State::stick) {
        shift = 0.0;
      } else {
        const double slip = h / std::max(grip.law.viscous_Ns_per_mm2 * grip.length, kTiny);
        const double sign = grip.state == Grip::State::forward ? 1.0 : -1.0;
        axial += slip;
        shift = slip * sign * grip.law.coulomb_N_per_mm * grip.length + grip.s_start - grip.s;
      }
    }
    diagonal.segment<3>(3 * c) << lateral, lateral, axial;
    softening[3 * c + 2] = shift;
  }
}

/// Matrix and right-hand side of all rows that may be held, in local frames.
void Insertion::Parts::assemble() {
  const int count = load_count();
  gather_forces();
  for (int c = 0; c < count; ++c) {
    const Mat3& Qc = frames[static_cast<std::size_t>(c)];
    Vec3 gap = needle->point(arc_of(c)) + free.segment<3>(3 * c) - material_of(c);
    const double beyond = c == 0 ? 0.0 : grips[static_cast<std::size_t>(c - 1)].s - arc_of(c);
    gap += beyond * Qc.col(2);
    for (int d = 0; d < count; ++d) {
      const Mat3 Ncd = N.block<3, 3>(3 * c, 3 * d);
      gap.noalias() += Ncd * force_of(d);
      if (d > c) continue;
      M.block<3, 3>(3 * c, 3 * d).noalias() =
          Qc.transpose() * (compliance(point_of(c), point_of(d)) + Ncd) * frames[static_cast<std::size_t>(d)];
    }
    rhs.segment<3>(3 * c).noalias() = Qc.transpose() * gap;
  }
}

void Insertion::Parts::select_rows() {
  rows.clear();
  if (tip.touching && tip.state != Tip::State::open) {
    if (std::isfinite(tip.lateral_softness)) {
      rows.push_back(0);
      rows.push_back(1);
    }
    rows.push_back(2);
  }
  for (int r = 3; r < 3 * load_count(); ++r) rows.push_back(r);
}

/// By how much [N] the present solution contradicts the state of a contact; 0 = consistent, or frozen.
double Insertion::Parts::contradiction(int load) const {
  const double axial = lambda[3 * load + 2];
  if (load == 0) {
    if (!tip.touching || tip.toggles > kMaxToggles) return 0.0;
    switch (tip.state) {
      case Tip::State::open: {
        double penetration = rhs[2];
        for (const int r : rows) penetration -= M(r, 2) * lambda[r];  // r ≥ 3: the tip holds nothing while open
        return penetration / std::max(M(2, 2), kTiny);
      }
      case Tip::State::stick:
        return std::max(-axial, tip.blocked ? 0.0 : axial - tip.limit);
      case Tip::State::cut:
        return tip.advance > 0.0 ? 0.0 : tip.cutting - axial;
    }
  }
  const Grip& grip = grips[static_cast<std::size_t>(load - 1)];
  if (grip.toggles > kMaxToggles || grip.length < kNoLength_mm) return 0.0;
  if (grip.state == Grip::State::stick) return std::abs(axial) - grip.law.static_N_per_mm * grip.length;
  const double sign = grip.state == Grip::State::forward ? 1.0 : -1.0;
  return grip.law.coulomb_N_per_mm * grip.length - sign * axial;
}

void Insertion::Parts::change_state(int load, StepReport& report) {
  const double axial = lambda[3 * load + 2];
  ++report.pivots;
  if (load == 0) {
    if (++tip.toggles > kMaxToggles) report.flags |= StepReport::contact_cycling;
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
  if (++grip.toggles > kMaxToggles) report.flags |= StepReport::contact_cycling;
  if (grip.state == Grip::State::stick) {
    grip.state = axial > 0.0 ? Grip::State::forward : Grip::State::backward;
    return;
  }
  grip.state = Grip::State::stick;
  // Back to where it was held; the row's right-hand side must know at once.
  rhs[3 * load + 2] += grip.s_start - grip.s;
  grip.s = grip.s_start;
}

/// Solves the held rows, then lets every state that contradicts its own law change, until none does.
/// @return true when a state has changed
bool Insertion::Parts::pivot(double h, StepReport& report) {
  bool changed = false;
  const auto entry = [this](int i, int j) { return i >= j ? M(i, j) : M(j, i); };
  for (int round = 0; round < kMaxPivots; ++round) {
    soften_rows(h);
    select_rows();
    const auto size = static_cast<Eigen::Index>(rows.size());
    lambda.head(3 * load_count()).setZero();
    if (size > 0) {
      for (Eigen::Index j = 0; j < size; ++j) {
        const int rj = rows[static_cast<std::size_t>(j)];
        for (Eigen::Index i = j; i < size; ++i) reduced(i, j) = entry(rows[static_cast<std::size_t>(i)], rj);
        reduced(j, j) += diagonal[rj];
        solution[j] = rhs[rj] + softening[rj];
      }
      auto matrix = reduced.topLeftCorner(size, size);
      if (!beam::factorise(matrix)) {
        report.flags |= StepReport::not_converged;
        return changed;
      }
      beam::solve_lower(matrix, 0, solution.head(size));
      beam::solve_upper(matrix, solution.head(size));
      for (Eigen::Index i = 0; i < size; ++i) lambda[rows[static_cast<std::size_t>(i)]] = solution[i];
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
  for (const int r : rows) {
    const int c = r / 3;
    const int k = r % 3;
    const Mat3& Q = frames[static_cast<std::size_t>(c)];
    const Vec3& f = c == 0 ? tip.force : grips[static_cast<std::size_t>(c - 1)].force;
    const double beyond = c == 0 ? 0.0 : grips[static_cast<std::size_t>(c - 1)].s - arc_of(c);
    const Vec3 gap = material_of(c) + tissue_displacement(point_of(c)) - needle->point(arc_of(c)) - beyond * Q.col(2);
    const double value = Q.col(k).dot(gap) + diagonal[r] * Q.col(k).dot(f) - softening[r];
    error = std::max(error, std::abs(value) / (M(r, r) + diagonal[r]));
  }
  // A contact that is not held in a direction must carry nothing there.
  if (tip.touching && tip.state != Tip::State::open && !std::isfinite(tip.lateral_softness)) {
    error = std::max(error, (frames[0].leftCols<2>().transpose() * tip.force).norm());
  }
  return error;
}

/// Moves a sliding contact along the needle by what its friction law says.
void Insertion::Parts::slide(Grip& grip, const Mat3& frame, double axial, double h) {
  if (grip.state == Grip::State::stick) return;
  if (grip.length < kNoLength_mm) {  // no friction at all: it follows the tissue
    const Vec3 gap = grip.x + tissue_displacement(grip.point) - needle->point(std::clamp(grip.s, 0.0, length()));
    grip.s = std::clamp(grip.s, 0.0, length()) + frame.col(2).dot(gap);
    return;
  }
  const double sign = grip.state == Grip::State::forward ? 1.0 : -1.0;
  const double slip = h / std::max(grip.law.viscous_Ns_per_mm2 * grip.length, kTiny);
  grip.s = grip.s_start + slip * (sign * grip.law.coulomb_N_per_mm * grip.length - axial);
}

void Insertion::Parts::solve_equilibrium(double h, StepReport& report) {
  for (Grip& grip : grips) {
    grip.s_start = grip.s;
    grip.toggles = 0;
  }
  tip.toggles = 0;
  tip.blocked = false;
  tip.x_start = tip.x;
  tip.at_start = tip.at;
  tip.advance = 0.0;
  if (tip.touching) aim_tip();

  bool changed = true;
  for (int iteration = 0; iteration < kMaxNewton; ++iteration) {
    fill_loads();
    set_frames();
    if (iteration > 0) {
      soften_rows(h);
      if (!changed && equation_error() < kTolerance_N && needle->residual(loads) < kNeedleTolerance) return;
    }
    ++report.iterations;
    const auto count = static_cast<Eigen::Index>(3 * load_count());
    needle->linearise(loads, N.topLeftCorner(count, count), free.head(count));
    assemble();
    changed = pivot(h, report);

    for (int c = 0; c < load_count(); ++c)
      force_of(c).noalias() = frames[static_cast<std::size_t>(c)] * lambda.segment<3>(3 * c);
    fill_loads();
    needle->advance(loads);
    for (std::size_t k = 0; k < grips.size(); ++k)
      slide(grips[k], frames[k + 1], lambda[3 * static_cast<Eigen::Index>(k) + 5], h);
    if (tip.touching && tip.state == Tip::State::cut) {
      const double slip = h / std::max(settings.tip_viscosity_Ns_per_mm, kTiny);
      march(std::max(0.0, slip * (lambda[2] - tip.cutting)));
      if (tip.blocked) {
        tip.state = Tip::State::stick;
        changed = true;
      }
    }
  }
  fill_loads();
  set_frames();
  soften_rows(h);
  if (equation_error() > 1e3 * kTolerance_N || needle->residual(loads) > 1e3 * kNeedleTolerance) {
    report.flags |= StepReport::not_converged;
  }
}

}  // namespace stylet
