// SPDX-License-Identifier: GPL-3.0-or-later
#include "tissue_response.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace stylet {

namespace {
/// Needle radii over which a tip's field falls to a half along the force. Raised, the track takes over more
/// slowly what the tip has left behind.
constexpr double kTipReach = 2.5;
/// The same in depths of the dent. Lowered, the tissue would start back past a tip that cuts.
constexpr double kDentReach = 4.0;
}  // namespace

TissueResponse::TissueResponse(std::unique_ptr<ContactCompliance> compliance, double relaxation_s,
                               double needle_radius_mm, int points)
    : compliance_(std::move(compliance)),
      memory_(relaxation_s, points + 1),
      needle_radius_mm_(needle_radius_mm),
      forces_(MatX::Zero(3, points + 1)),
      places_(static_cast<std::size_t>(points) + 1) {}

TipRelief TissueResponse::relief(const ContactForces& contacts) const {
  if (!compliance_->stiffens()) return {};
  const MatX& scale = compliance_->needle_scale();
  const auto by = [&](int point, const Vec3& force) -> Vec3 {
    return scale.middleRows<3>(3 * point).transpose() * force;
  };
  const double share = memory_.share();
  Vec3 of_others = Vec3::Zero();
  for (const ShaftContact& contact : contacts.shaft) of_others += by(contact.point, share * contact.force);
  for (int point = 1; memory_.on() && point < compliance_->points(); ++point)
    of_others += by(point, memory_.past(point));
  return {*compliance_, filtered_force(ContactCompliance::kTip, contacts), of_others};
}

Vec3 TissueResponse::displacement(int point, const ContactForces& contacts) const {
  Vec3 u = Vec3::Zero();
  const auto columns = compliance_->matrix().middleCols<3>(3 * point);  // or rows: A is symmetric
  u.noalias() += columns.topRows<3>().transpose() * contacts.tip;
  for (const ShaftContact& contact : contacts.shaft)
    u.noalias() += columns.middleRows<3>(3 * contact.point).transpose() * contact.force;
  if (memory_.on()) u = memory_.share() * u + past_displacement(point);
  if (compliance_->stiffens()) u -= relief(contacts).of(point);
  return u;
}

void TissueResponse::gather(const ContactForces& contacts, Eigen::Ref<MatX> forces) const {
  forces.setZero();
  forces.col(ContactCompliance::kTip) = contacts.tip;
  for (const ShaftContact& contact : contacts.shaft) forces.col(contact.point) = contact.force;
}

void TissueResponse::filter(Eigen::Ref<MatX> forces) const {
  if (!memory_.on()) return;
  for (int point = 0; point < compliance_->points(); ++point)
    forces.col(point) = memory_.share() * forces.col(point) + memory_.past(point);
}

Eigen::Ref<const MatX> TissueResponse::filtered_forces(const ContactForces& contacts) {
  auto forces = forces_.leftCols(compliance_->points());
  gather(contacts, forces);
  filter(forces);
  return forces;
}

MatX TissueResponse::present_forces(const ContactForces& contacts) const {
  MatX forces(3, compliance_->points());
  gather(contacts, forces);
  return forces;
}

MatX TissueResponse::filtered_forces_of_all(const ContactForces& contacts) const {
  MatX forces = present_forces(contacts);
  filter(forces);
  return forces;
}

Vec3 TissueResponse::filtered_force(int point, const ContactForces& contacts) const {
  Vec3 force = Vec3::Zero();
  if (point == ContactCompliance::kTip) {
    force = contacts.tip;
  } else {
    for (const ShaftContact& contact : contacts.shaft) {
      if (contact.point == point) force = contact.force;
    }
  }
  if (memory_.on()) force = memory_.share() * force + memory_.past(point);
  return force;
}

double TissueResponse::energy(const ContactForces& contacts) const {
  double energy = compliance_->stiffens() ? relief(contacts).energy_Nmm() : 0.0;
  if (memory_.on()) {
    for (int point = 0; point < compliance_->points(); ++point)
      energy += 0.5 * filtered_force(point, contacts).dot(displacement(point, contacts));
    return energy;
  }
  energy += 0.5 * contacts.tip.dot(displacement(ContactCompliance::kTip, contacts));
  for (const ShaftContact& contact : contacts.shaft)
    energy += 0.5 * contact.force.dot(displacement(contact.point, contacts));
  return energy;
}

bool TissueResponse::take_tip_compliance(const MaterialPoint& at, const Vec3& x) {
  const Vec3 there = past_displacement(ContactCompliance::kTip);
  if (!compliance_->move_tip(at, x)) return false;
  memory_.keep_displacement(*compliance_, ContactCompliance::kTip, there);
  return true;
}

void TissueResponse::begin_tip(double xi) {
  memory_.forget(ContactCompliance::kTip);
  tip_xi_ = xi;
  relaxing_ = false;
}

/// The tip is a new material point wherever it has cut to. What it left behind goes to the last point of the track, but
/// not at once: such a point stands for a piece of shaft and yields several times less than a tip, and the tissue would
/// start back. It goes as the tip's own field falls off with the way it has cut, and where the dent is deeper than that
/// field is wide, no faster than a tip can follow. Before there is such a point it stays.
void TissueResponse::end(const ContactForces& contacts, const Track& track) {
  if (!memory_.on()) return;
  auto forces = forces_.leftCols(compliance_->points());
  gather(contacts, forces);
  memory_.end(forces);
  const double cut = track.end_xi - tip_xi_;
  tip_xi_ = track.end_xi;
  if (cut <= 0.0) return;
  const double dent =
      ((*compliance_)(ContactCompliance::kTip, ContactCompliance::kTip) * memory_.past(ContactCompliance::kTip)).norm();
  const double reach = std::max(kTipReach * needle_radius_mm_, kDentReach * dent);
  leave_behind(track, 1.0 - std::exp(-cut / reach));
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
