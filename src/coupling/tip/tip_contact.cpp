// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/tip/tip_contact.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace stylet {

namespace {
/// Largest slope of the cut back to the needle's axis. Raised, the track of a needle that is moved sideways returns to
/// the axis sooner, with sharper bends.
constexpr double kSteepest = 0.5;
/// Least det(I + ∇u) of the tissue around the tip, and the reciprocal of the most. Below this, its deformation is
/// beyond the linear model, and the cut ignores it.
constexpr double kLeastVolume = 0.2;
/// Softness of a lateral row that is not held, over the tissue's own compliance: the row carries its given force and
/// nothing else. Raised much further, its equation loses digits.
constexpr double kNotHeld = 1e6;
/// [N s/mm] Smallest viscosity in a division, far below any with which a balance could be found: a scenario gives at
/// least 1e-5. Raised, a tip without viscosity cuts less freely.
constexpr double kLeastViscosity = 1e-12;
}  // namespace

CuttingLaw TipContact::cutting_law(double h) const {
  return {.start_N = ahead.cutting(), .slip_mm_per_N = h / std::max(viscosity_, kLeastViscosity)};
}

void TipContact::ask_own_law() {
  if (!settings_.cutting || !touches_ || ahead.is_bone()) return;
  const double built_in_N = ahead.built_in_cutting();
  const auto usable = [](double value) { return std::isfinite(value) && value >= 0.0; };
  const CuttingModel::Law law = settings_.cutting->law({.region = ahead.region(),
                                                        .at_mm = cut.x(),
                                                        .cut_mm_per_s = cut_mm_per_s,
                                                        .cutting_N = built_in_N,
                                                        .viscosity_Ns_per_mm = settings_.tip_viscosity_Ns_per_mm});
  refuses_own_law_ = !usable(law.cutting_N) || !usable(law.viscosity_Ns_per_mm);
  ahead.set_cutting(refuses_own_law_ ? built_in_N : law.cutting_N);
  viscosity_ = refuses_own_law_ ? settings_.tip_viscosity_Ns_per_mm : law.viscosity_Ns_per_mm;
}

void TipContact::put(const Vec3& x, const MaterialPoint& at, bool touches, State state) {
  forget();
  touches_ = touches;
  state_ = state;
  cut.put(x, at);
}

void TipContact::forget() {
  cut.forget();
  ahead = {};
  force.setZero();
  history = {};
  toggles = 0;
  cut_mm_per_s = 0.0;
  viscosity_ = settings_.tip_viscosity_Ns_per_mm;
  refuses_own_law_ = false;
  state_ = State::open;
  touches_ = false;
  lateral_hold_ = 0.0;
}

void TipContact::exit() {
  touches_ = false;
  state_ = State::open;
  force.setZero();
}

void TipContact::begin(const ContactForces& forces) {
  if (waits()) cut.take_compliance();
  cut.begin();
  ask_own_law();
  if (touches_) aim(forces);
}

/// Chooses the direction of the cut in undeformed coordinates. A symmetric tip cuts along its own tangent t; with the
/// deformation gradient F = I + ∇u of the tissue, that is F⁻¹ t. Where the track's end has drifted off the axis,
/// because the base moved sideways while the tip did not cut, the cut leads back to the axis. A bevelled tip cuts
/// towards a line beside the axis instead.
void TipContact::aim(const ContactForces& forces) {
  const Vec3 t = tangent();
  const Mat3 F = Mat3::Identity() + tissue_.compliance().gradient_at_tip(tissue_.all_forces(forces));
  Vec3 along = t + lead_of_bevel(t);
  if (!std::isfinite(lateral_hold_)) {
    const Vec3 gap = cut.x() + tissue_.displacement(ContactCompliance::kTip, forces) - needle_.point(needle_.length());
    Vec3 back = -(gap - t * t.dot(gap)) / settings_.merge_mm;
    if (back.norm() > kSteepest) back *= kSteepest / back.norm();
    along += back;
  }
  const double volume = F.determinant();
  Vec3 d = volume > kLeastVolume && volume < 1.0 / kLeastVolume ? Vec3(F.inverse() * along) : along;
  // Strains beyond the linear model must not turn the cut around.
  if (d.dot(t) < 0.5 * d.norm()) d = along;
  cut.aim(d);
}

bool TipContact::breaks_surface() const {
  if (!holds()) return false;
  const Vec3 t = tangent();
  return ahead.gives(force.dot(t), t, settings_.grazing_cos);
}

void TipContact::take_back_cut() {
  if (!touches_) return;
  if ((cut.is_blocked() || cut.ends_leg()) && state_ == State::stick) state_ = State::cut;
  if (state_ == State::cut) cut.take_back();
}

void TipContact::hand_over(double share) {
  lateral_hold_ = share >= 1.0 ? std::numeric_limits<double>::infinity()
                               : tissue_.own_yield(ContactCompliance::kTip) * share / (1.0 - share);
}

// The two laws of a bevelled tip.
//
// offset: the tip's wedge cuts at the angle ψ to the axis, so after a cut of length d it is d tan ψ beside the axis.
// The cutting point belongs to the needle, so the cut cannot leave the shaft: the term that leads back to the axis
// holds it at g = 2R tan ψ. Shaft contacts then lie on that line, the tissue draws the shaft towards it, and the needle
// bends.
//
// force: the tissue pushes the tip towards its sharp side by a share of the tip's axial force; the opposite force acts
// on the tissue. Where shaft contacts have taken over the tip's lateral hold, its lateral rows stay in the system with
// the largest possible softness, and carry this force.

Vec3 Bevel::sharp_side(const Pose& base, const Vec3& tangent) {
  const Vec3 axis = base.rotation * Vec3::UnitZ();
  return Eigen::Quaterniond::FromTwoVectors(axis, tangent) * (base.rotation * Vec3::UnitX());
}

/// Term that a bevel of Law::offset adds to the direction of the cut, so that the cut leaves the axis at the angle ψ
/// and approaches the line at the distance g.
Vec3 TipContact::lead_of_bevel(const Vec3& tangent) const {
  const double slope = settings_.bevel.slope();
  if (slope == 0.0) return Vec3::Zero();
  const Vec3 side = Bevel::sharp_side(base_, tangent);
  if (!std::isfinite(lateral_hold_)) return slope * side;  // the term that leads back to the axis does the rest
  // While the tip is held sideways, the end of its track cannot leave it. The lateral force tells how far the end would
  // be away if the tip were released.
  const double own = tissue_.own_yield(ContactCompliance::kTip);
  const double beside = -(lateral_hold_ + own) * force.dot(side);
  return std::clamp(slope - beside / settings_.merge_mm, 0.0, slope) * side;
}

bool TipContact::has_lateral_rows() const { return std::isfinite(lateral_hold_) || settings_.bevel.pushes(); }

double TipContact::lateral_softness() const {
  if (std::isfinite(lateral_hold_)) return lateral_hold_;
  if (!settings_.bevel.pushes()) return 0.0;
  return kNotHeld * tissue_.compliance()(ContactCompliance::kTip, ContactCompliance::kTip).trace() / 3.0;
}

Vec3 TipContact::bevel_force() const {
  if (!settings_.bevel.pushes()) return Vec3::Zero();
  const Vec3 t = tangent();
  return -settings_.bevel.force_ratio * std::max(0.0, force.dot(t)) * Bevel::sharp_side(base_, t);
}

}  // namespace stylet
