// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/contact_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stylet {

namespace {
/// [N s/mm] Smallest viscosity in a division, far below any with which a balance could be found. Raised, a contact
/// without viscosity slides less freely.
constexpr double kNoViscosity = 1e-12;
/// [N s/mm²] Least viscosity of friction; without any, the place of a sliding contact would be undetermined. At 100
/// mm/s this adds 1e-7 N/mm; raised, it adds more.
constexpr double kLeastViscosity = 1e-9;
/// Part of the viscosity that is kept above the speed where friction stops growing, which suffices to determine how far
/// a contact slides. Raised, fast contacts carry more friction than their law says.
constexpr double kFlat = 1e-3;
}  // namespace

ContactRows::ContactRows(const CouplingSettings& settings, int most)
    : frame(static_cast<std::size_t>(most), Mat3::Identity()),
      yield(static_cast<std::size_t>(most)),
      shift(VecX::Zero(3 * static_cast<Eigen::Index>(most))),
      now(shift),
      gap(shift),
      tip{.drift = shift},
      settings_(settings),
      needle_(static_cast<std::size_t>(most), Vec3::Zero()),
      past_(static_cast<std::size_t>(most), Vec3::Zero()) {
  loads_.reserve(static_cast<std::size_t>(most));
}

void ContactRows::take_places(const Contacts& contacts) {
  contacts.tissue.gather_past();
  for (int c = 0; c < contacts.count(); ++c) {
    const double s = contacts.arc(c);
    const double beyond = c == 0 ? 0.0 : contacts.of_shaft(c).s - s;
    const AxisPlace at = contacts.needle_of(c).place(s);
    const Vec3& t = at.tangent;
    needle_[static_cast<std::size_t>(c)] = at.point + beyond * t;
    // Any pair of normals is valid, because both lateral directions are treated alike.
    const Vec3 helper = std::abs(t.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
    const Vec3 n1 = t.cross(helper).normalized();
    Mat3& Q = frame[static_cast<std::size_t>(c)];
    Q.col(0) = n1;
    Q.col(1) = t.cross(n1);
    Q.col(2) = t;
    past_[static_cast<std::size_t>(c)] = contacts.tissue.past_displacement(contacts.point(c));
  }
}

void ContactRows::take_loads(const Contacts& contacts) {
  loads_.resize(static_cast<std::size_t>(contacts.count()));
  for (int c = 0; c < contacts.count(); ++c)
    loads_[static_cast<std::size_t>(c)] = {contacts.arc(c), -contacts.force(c)};
}

double ContactRows::largest_load() const {
  double largest = 1.0;
  for (const PointLoad& load : loads_) largest = std::max(largest, load.force.norm());
  return largest;
}

void ContactRows::soften(const Contacts& contacts, double h) {
  soften_tip(contacts, h);
  for (int c = 1; c < contacts.count(); ++c) soften_shaft(contacts.of_shaft(c), c, h);
}

void ContactRows::soften_tip(const Contacts& contacts, double h) {
  const TipContact& contact = contacts.tip;
  const Mat3& Q = frame.front();
  Yield& own = yield.front();
  Vec3 by_state = Vec3::Zero();
  own.along = Q.col(2);
  tip.cut_per_N = 0.0;
  own.lateral = contact.has_lateral_rows() ? contact.lateral_softness() : 0.0;
  own.axial = settings_.axial_compliance_mm_per_N;
  by_state.head<2>().noalias() = own.lateral * (Q.leftCols<2>().transpose() * contact.bevel_force());
  if (contact.state() == TipContact::State::cut) {
    const CuttingLaw law = contact.cutting_law(h);
    own.axial += law.slip_mm_per_N;
    by_state[2] = law.slip_mm_per_N * law.start_N + contact.cut.advance();
    if (contact.touches()) {
      tip.cut_per_N = law.slip_mm_per_N;
      tip.cut_due = law.way(Q.col(2).dot(contact.force)) - contact.cut.advance();
    }
  }
  shift.head<3>() = by_state;
}

void ContactRows::soften_shaft(ShaftContact& contact, int load, double h) {
  const bool open = contact.presses_only && contact.state == ShaftContact::State::backward;
  const double slow = std::max(open ? 0.0 : contact.law.viscous_Ns_per_mm2, kLeastViscosity);
  const double viscosity = contact.fast ? std::max(kFlat * slow, kLeastViscosity) : slow;
  contact.coulomb = open ? 0.0 : contact.law.coulomb_N_per_mm * contact.length;
  if (contact.fast) contact.coulomb += (slow - viscosity) * contact.law.viscous_to_mm_per_s * contact.length;
  contact.slip = h / std::max(viscosity * contact.length, kNoViscosity);
  contact.reach =
      slow > kLeastViscosity ? contact.law.viscous_to_mm_per_s * h : std::numeric_limits<double>::infinity();
  Yield& own = yield[static_cast<std::size_t>(load)];
  Vec3 by_state = Vec3::Zero();
  own.along = frame[static_cast<std::size_t>(load)].col(2);
  own.lateral = contact.softness;
  own.axial = contact.presses_only ? settings_.axial_compliance_mm_per_N : contact.softness;
  if (!contact.sticks()) {
    own.axial += contact.slip;
    by_state[2] = contact.slip * contact.sense() * contact.coulomb + contact.s_start - contact.s;
  }
  shift.segment<3>(3 * load) = by_state;
}

}  // namespace stylet
