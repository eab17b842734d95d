// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/contacts/shaft_contacts.hpp"

#include <algorithm>

namespace stylet {

namespace {
/// Distance behind the tip, in needle radii, over which a young contact hardens. Raised, the tip holds the needle
/// sideways for longer, and a bevel deflects it later.
constexpr double kHandOver = 6.0;
/// Smallest age ρ, and the tolerance within which ρ counts as 1. Raised, a contact begins with a force that is not
/// zero.
constexpr double kYoungest = 1e-6;
}  // namespace

ShaftContacts::ShaftContacts(const InsertionTissue& mesh, const CouplingSettings& settings, const Needle& needle,
                             const TissueResponse& tissue)
    : mesh_(mesh), settings_(settings), needle_(needle), tissue_(tissue) {
  contacts_.reserve(static_cast<std::size_t>(most_shaft_contacts(settings)));
}

void ShaftContacts::wake_and_drop(Track& track, Marks& marks, const Vec3& tip_force, Step& step) {
  const double length = needle_.length();
  while (!empty() && contacts_.back().s >= length) contacts_.pop_back();

  const Vec3 tip = needle_.point(length);
  const Vec3 t = needle_.tangent(length);
  while (own().size() < track.marks.size()) {
    const std::size_t next = own().size();
    if (track.marks[next].point < 0) {
      if (t.dot(track.marks[next].x - tip) > settings_.spacing_mm) break;
      const Marks::Outcome outcome = marks.represent(track, next, t, step);
      if (outcome == Marks::Outcome::dropped) continue;
      if (outcome == Marks::Outcome::refused) break;
    }
    const Track::Mark& mark = track.marks[next];
    const double ahead = t.dot(mark.x + tissue_.displacement(mark.point, {tip_force, contacts_}) - tip);
    if (ahead >= 0.0) break;
    ShaftContact contact;
    contact.needle = &needle_;
    contact.point = mark.point;
    contact.xi = mark.xi;
    contact.x = mark.x;
    contact.s = length + ahead;
    contact.law = mesh_.laws[static_cast<std::size_t>(mark.region)].friction;
    contact.state = ShaftContact::State::forward;
    contacts_.push_back(contact);
  }
}

void ShaftContacts::take_over(ShaftContacts& before) {
  contacts_.assign(before.contacts_.begin(), before.contacts_.end());
  before.contacts_.clear();
  before.others_ = 0;
  const auto first_own = std::stable_partition(contacts_.begin(), contacts_.end(),
                                               [&](const ShaftContact& contact) { return contact.needle != &needle_; });
  others_ = static_cast<std::size_t>(first_own - contacts_.begin());
}

/// Distance of the tip beyond a contact [mm]: along the shaft, or along the track where that is less. Tissue that the
/// tip has just passed springs back along the shaft at once, while the track grows with the cut only.
double ShaftContacts::passed_by(const ShaftContact& contact, const Track& track) const {
  const double along_shaft = needle_.length() - contact.s;
  if (track.open) return std::max(0.0, along_shaft);
  return std::max(0.0, std::min(along_shaft, track.end_xi - contact.xi));
}

double ShaftContacts::share_length(const Track& track) {
  const double hand_over = kHandOver * settings_.needle_radius_mm;
  const auto age = [&](const ShaftContact& contact) { return std::min(1.0, passed_by(contact, track) / hand_over); };
  const std::span<ShaftContact> contacts = own();
  for (ShaftContact& contact : contacts) {
    contact.softness = tissue_.own_yield(contact.point) * (1.0 / std::max(age(contact), kYoungest) - 1.0);
    contact.length = 0.0;
  }
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    ShaftContact& contact = contacts[k];
    const double rho = age(contact);
    const double before = k == 0 ? contact.xi : contact.xi - contacts[k - 1].xi;
    if (k == 0) {
      contact.length += before * rho;
    } else {
      contact.length += 0.5 * before * rho;
      contacts[k - 1].length += before * (1.0 - 0.5 * rho);
    }
    if (k + 1 == contacts.size()) {
      double after = passed_by(contact, track);
      if (track.open) after = std::min(after, std::max(0.0, track.air_from_xi - contact.xi));
      contact.length += after;
    }
  }
  if (contacts.empty()) return 0.0;
  const double rho = age(contacts.front());
  return rho >= 1.0 - kYoungest ? 1.0 : rho;
}

}  // namespace stylet
