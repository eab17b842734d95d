// SPDX-License-Identifier: GPL-3.0-or-later
#include "tissue_response.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace stylet {

namespace {
/// Length of cut, in needle radii, over which the track takes over the tip's memory. Raised, the tip carries more
/// memory along; lowered, the tissue moves more abruptly where the first point of a track takes over.
constexpr double kHandOver = 2.5;

/// Displacement of a point by the present forces [mm] LPS. @param compliance A, or its wide part [mm/N]
Vec3 by_present(const MatX& compliance, int point, const ContactForces& contacts) {
  Vec3 u = Vec3::Zero();
  const auto columns = compliance.middleCols<3>(3 * point);  // or rows: compliances are symmetric
  u.noalias() += columns.topRows<3>().transpose() * contacts.tip;
  for (const ShaftContact& contact : contacts.shaft)
    u.noalias() += columns.middleRows<3>(3 * contact.point).transpose() * contact.force;
  return u;
}

}  // namespace

TissueResponse::TissueResponse(std::unique_ptr<ContactCompliance> compliance, const Creep& creep,
                               double needle_radius_mm, int points)
    : compliance_(std::move(compliance)),
      memory_(creep, points + 1),
      reach_mm_(kHandOver * needle_radius_mm),
      forces_(MatX::Zero(3, points + 1)),
      places_(static_cast<std::size_t>(points) + 1) {}

TipRelief TissueResponse::relief(const ContactForces& contacts) const {
  if (!compliance_->stiffens()) return {};
  const MatX& scale = compliance_->needle_scale();
  Vec3 of_others = Vec3::Zero();
  for (const ShaftContact& contact : contacts.shaft)
    of_others += Vec3(scale.middleRows<3>(3 * contact.point).transpose() * contact.force);
  if (hold_ != nullptr) of_others += hold_->of_others();
  return {*compliance_, contacts.tip, of_others};
}

Vec3 TissueResponse::lasting_displacement(int point, const ContactForces& contacts) const {
  if (!memory_.on()) return hold_ != nullptr ? past_displacement(point) : Vec3::Zero();
  return memory_.share() * by_present(compliance_->wide(), point, contacts) + past_displacement(point);
}

Vec3 TissueResponse::displacement(int point, const ContactForces& contacts) const {
  Vec3 u = by_present(compliance_->matrix(), point, contacts) + lasting_displacement(point, contacts);
  if (compliance_->stiffens()) u -= relief(contacts).of(point);
  if (hold_ != nullptr) {
    u -= hold_->reduction(point, ContactCompliance::kTip) * contacts.tip;
    for (const ShaftContact& contact : contacts.shaft) u -= hold_->reduction(point, contact.point) * contact.force;
  }
  return u;
}

void TissueResponse::gather(const ContactForces& contacts, Eigen::Ref<MatX> forces) const {
  forces.setZero();
  forces.col(ContactCompliance::kTip) = contacts.tip;
  for (const ShaftContact& contact : contacts.shaft) forces.col(contact.point) = contact.force;
  if (hold_ != nullptr) hold_->write_forces(forces);
}

Eigen::Ref<const MatX> TissueResponse::all_forces(const ContactForces& contacts) {
  auto forces = forces_.leftCols(compliance_->points());
  gather(contacts, forces);
  for (int point = 0; memory_.on() && point < compliance_->points(); ++point)
    forces.col(point) += memory_.share() * forces.col(point) + memory_.past(point);
  return forces;
}

MatX TissueResponse::present_forces(const ContactForces& contacts) const {
  MatX forces(3, compliance_->points());
  gather(contacts, forces);
  return forces;
}

MatX TissueResponse::lasting_forces(const ContactForces& contacts) const {
  MatX forces(3, compliance_->points());
  for (int point = 0; point < compliance_->points(); ++point) forces.col(point) = lasting_force(point, contacts);
  return forces;
}

Vec3 TissueResponse::present_force(int point, const ContactForces& contacts) const {
  if (point == ContactCompliance::kTip) return contacts.tip;
  for (const ShaftContact& contact : contacts.shaft) {
    if (contact.point == point) return contact.force;
  }
  return Vec3::Zero();
}

Vec3 TissueResponse::lasting_force(int point, const ContactForces& contacts) const {
  if (!memory_.on()) return Vec3::Zero();
  return memory_.share() * present_force(point, contacts) + memory_.past(point);
}

/// The energy of the spring that yields at once, and of the spring beside the damper, which has stored ½ pᵀ F p / (r −
/// 1) of its displacement F p.
double TissueResponse::energy(const ContactForces& contacts) const {
  double energy = compliance_->stiffens() ? relief(contacts).energy_Nmm() : 0.0;
  const auto crept = [&](int point) -> Vec3 {
    Vec3 u = Vec3::Zero();
    for (int d = 0; memory_.on() && d < compliance_->points(); ++d)
      u += compliance_->wide(point, d) * lasting_force(d, contacts);
    return u;
  };
  for (int point = 0; memory_.on() && point < compliance_->points(); ++point)
    energy += 0.5 * lasting_force(point, contacts).dot(crept(point)) / memory_.most();
  const auto at_once = [&](int point) -> Vec3 { return displacement(point, contacts) - crept(point); };
  energy += 0.5 * contacts.tip.dot(at_once(ContactCompliance::kTip));
  for (const ShaftContact& contact : contacts.shaft) energy += 0.5 * contact.force.dot(at_once(contact.point));
  return energy;
}

void TissueResponse::begin_tip(double xi) {
  memory_.forget(ContactCompliance::kTip);
  tip_xi_ = xi;
  relaxing_ = false;
}

/// The tip is another material point after each cut, but memory stays with the material: as the tip cuts on, the last
/// point of the track takes over its memory. This moves both points nearly alike, since only the wide part of the
/// compliance creeps. Before the track has a point, the memory stays at the tip.
void TissueResponse::end(const ContactForces& contacts, const Track& track) {
  if (!memory_.on()) return;
  auto forces = forces_.leftCols(compliance_->points());
  gather(contacts, forces);
  memory_.end(forces);
  const double cut = track.end_xi - tip_xi_;
  tip_xi_ = track.end_xi;
  if (cut > 0.0) leave_behind(track, 1.0 - std::exp(-cut / reach_mm_));
}

void TissueResponse::leave_behind(const Track& track, double part) {
  if (!memory_.on()) return;
  for (auto mark = track.marks.rbegin(); mark != track.marks.rend(); ++mark) {
    if (mark->point < 0) continue;
    memory_.hand_over(ContactCompliance::kTip, mark->point, part);
    return;
  }
}

void TissueResponse::let_go() {
  relaxing_ = memory_.on();
  if (!relaxing_) reset();
}

void TissueResponse::relax(const ContactForces& none) {
  if (!relaxing_) return;
  auto forces = forces_.leftCols(compliance_->points());
  gather(none, forces);
  memory_.end(forces);
  if (memory_.relaxed(*compliance_)) reset();
}

void TissueResponse::reset() {
  relaxing_ = false;
  memory_.reset();
  compliance_->reset();
}

}  // namespace stylet
