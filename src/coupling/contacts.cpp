// SPDX-License-Identifier: GPL-3.0-or-later
#include "insertion_parts.hpp"

#include <algorithm>
#include <cmath>

/// Laying, waking and dropping of shaft contacts. A contact young enough to lie within three diameters of the tip
/// yields: softness c₀(1/ρ − 1) with ρ = distance to the tip / three diameters, and its share of the friction grows
/// with ρ. It is born and dies with zero force, so neither moves the base force.
namespace stylet {

namespace {
constexpr double kTriesPerSpacing = 16.0;  ///< where a contact cannot be laid, the next place is tried so soon
constexpr double kPatience = 1.5;          ///< spacings without a node before an interpolated contact will do
constexpr double kHandOver = 6.0;          ///< needle radii behind the tip over which a contact takes hold
constexpr double kYoungest = 1e-6;         ///< smallest ρ
}  // namespace

bool Insertion::Parts::lay_mark(double xi, const Vec3& x, const MaterialPoint& at, Placement placement,
                                const Vec3& travel, StepReport& report) {
  if (track.marks.size() == static_cast<std::size_t>(settings.capacity)) {
    report.flags |= StepReport::out_of_contacts;
    return true;  // counts as laid: no other place would be better
  }
  const ContactCompliance::Added added = compliance.add(at, x, placement, travel);
  if (added.refusal == ContactCompliance::Refusal::geometry) return false;
  if (added.refusal == ContactCompliance::Refusal::missing) {
    report.flags |= StepReport::compliance_missing;
    track.marks.push_back({xi, x, at, region_of(at.tet), -1});  // wake_and_drop() lays it when it can
    return true;
  }
  if (added.refusal == ContactCompliance::Refusal::capacity) report.flags |= StepReport::out_of_contacts;
  if (added.point < 0) return true;

  if (placement == Placement::embedded) {
    if (follows_from(added.point, track.marks.size())) {
      compliance.remove_last_embedded();
      return false;
    }
  }
  track.marks.push_back({xi, x, at, region_of(at.tet), added.point});
  point_at[static_cast<std::size_t>(added.point)] = at;
  point_along[static_cast<std::size_t>(added.point)] = travel.normalized();
  return true;
}

/// Interpolated contacts in one element follow from each other as soon as there are more than the element can tell
/// apart: such a contact is not laid, and its neighbours share its length.
/// @param marks so many of the track come before it
bool Insertion::Parts::follows_from(int point, std::size_t marks) const {
  std::array<int, ContactCompliance::kNeighbours> neighbours{};
  std::size_t count = 0;
  for (std::size_t k = marks; k > 0 && count < neighbours.size(); --k) {
    if (track.marks[k - 1].point >= 0) neighbours[count++] = track.marks[k - 1].point;
  }
  return compliance.independence(point, std::span(neighbours).first(count)) < settings.independence;
}

/// Where nodes for contacts go. A node that is moved may go anywhere, so faces concern added ones only.
Placement Insertion::Parts::placement_of_contacts() const {
  if (settings.method == CouplingSettings::Method::embedded || settings.method == CouplingSettings::Method::near_field)
    return Placement::embedded;
  const bool adds = settings.method == CouplingSettings::Method::node_addition;
  return adds && settings.rule == CouplingSettings::Rule::paper ? Placement::face : Placement::interior;
}

/// Contacts along the piece of track just cut, from `from` at from_xi to track.end.
void Insertion::Parts::lay_marks(const Vec3& from, double from_xi, const MaterialPoint& from_at, StepReport& report) {
  const InPhase in_phase(phases, StepPhase::contacts);
  if (placement_of_contacts() == Placement::face) {
    lay_node_addition_on_faces(from, from_xi, from_at.tet, report);
    return;
  }
  const Vec3 direction = (track.end - from).normalized();
  const bool nodes = placement_of_contacts() != Placement::embedded;
  while (candidate_xi <= track.end_xi) {
    const Vec3 x = from + std::max(0.0, candidate_xi - from_xi) * direction;
    const auto at = tissue.locator->find(x, tip.at.tet, -direction);
    bool laid = false;
    if (at && nodes) laid = lay_mark(candidate_xi, x, *at, Placement::interior, direction, report);
    // A track that runs along a face or an edge leaves no room for a node: interpolate there.
    const double last = track.marks.empty() ? 0.0 : track.marks.back().xi;
    if (at && !laid && (!nodes || candidate_xi - last >= kPatience * settings.spacing_mm)) {
      laid = lay_mark(candidate_xi, x, *at, Placement::embedded, direction, report);
    }
    candidate_xi += laid ? settings.spacing_mm : settings.spacing_mm / kTriesPerSpacing;
  }
}

/// The paper's rule: a node wherever the tip passes from one element into the next (Goksel et al. 2005).
void Insertion::Parts::lay_node_addition_on_faces(const Vec3& from, double from_xi, Index tet, StepReport& report) {
  const Locator& locator = *tissue.locator;
  const Vec3 to = track.end;
  const double piece = (to - from).norm();
  if (piece <= 0.0) return;
  const Vec3 direction = (to - from) / piece;
  if (from_xi == 0.0 && track.marks.empty()) {  // the skin: a face with one element
    lay_mark(0.0, from, {tet, locator.weights(tet, from)}, Placement::face, direction, report);
  }
  double done = 0.0;
  for (int steps = 0; steps < 64 && tet != tip.at.tet; ++steps) {
    const Vec4 here = locator.weights(tet, from);
    const Vec4 there = locator.weights(tet, to);
    double first = 2.0;
    int local = -1;
    for (int i = 0; i < 4; ++i) {
      if (there[i] >= 0.0 || there[i] >= here[i]) continue;
      const double t = here[i] / (here[i] - there[i]);
      if (t >= done - 1e-9 && t < first) {
        first = t;
        local = i;
      }
    }
    if (local < 0 || first > 1.0) break;
    const Vec3 x = from + first * (to - from);
    const double xi = from_xi + first * piece;
    const double last_xi = track.marks.empty() ? -1e9 : track.marks.back().xi;
    if (xi - last_xi >= settings.merge_mm) {
      lay_mark(xi, x, {tet, locator.weights(tet, x)}, Placement::face, direction, report);
    }
    done = first;
    tet = locator.topology().neighbour[static_cast<std::size_t>(tet)][static_cast<std::size_t>(local)];
    if (tet < 0) break;
  }
}

/// Contacts the tip has passed come alive; contacts that slid off the tip are dropped. Grips are always the first
/// marks.
void Insertion::Parts::wake_and_drop(StepReport& report) {
  const InPhase in_phase(phases, StepPhase::contacts);
  while (!grips.empty() && grips.back().s >= length()) grips.pop_back();

  const Vec3 tip_now = needle->point(length());
  const Vec3 t = needle->tangent(length());
  while (grips.size() < track.marks.size()) {
    Track::Mark& mark = track.marks[grips.size()];
    if (mark.point < 0) {  // on an old track, which the tissue model has forgotten, or laid ahead of the compliance
      if (t.dot(mark.x - tip_now) > settings.spacing_mm) break;
      Placement placement = placement_of_contacts();
      auto added = compliance.add(mark.at, mark.x, placement, t);
      if (added.refusal == ContactCompliance::Refusal::geometry) {
        placement = Placement::embedded;
        added = compliance.add(mark.at, mark.x, placement);
      }
      if (added.point < 0) {
        report.flags |= added.refusal == ContactCompliance::Refusal::missing ? StepReport::compliance_missing
                                                                             : StepReport::out_of_contacts;
        break;
      }
      if (placement == Placement::embedded && follows_from(added.point, grips.size())) {
        compliance.remove_last_embedded();
        track.marks.erase(track.marks.begin() + static_cast<std::ptrdiff_t>(grips.size()));
        continue;
      }
      mark.point = added.point;
      point_at[static_cast<std::size_t>(added.point)] = mark.at;
      point_along[static_cast<std::size_t>(added.point)] = t;
    }
    const double ahead = t.dot(mark.x + tissue_displacement(mark.point) - tip_now);
    if (ahead >= 0.0) break;
    Grip grip;
    grip.point = mark.point;
    grip.xi = mark.xi;
    grip.x = mark.x;
    grip.s = length() + ahead;
    grip.law = tissue.laws[static_cast<std::size_t>(mark.region)].friction;
    grip.state = Grip::State::forward;
    grips.push_back(grip);
  }
  share_length();
}

/// How far the tip is beyond a contact [mm]: along the shaft, or along the track while that is less. Tissue that the
/// tip has just passed springs back along the shaft at once; the track grows with the cut only.
double Insertion::Parts::passed_by(const Grip& grip) const {
  const double along_shaft = length() - grip.s;
  if (track.open) return std::max(0.0, along_shaft);
  return std::max(0.0, std::min(along_shaft, track.end_xi - grip.xi));
}

/// Tributary lengths, softness of young contacts, and the hand-over of the tip's lateral hold to the shaft.
void Insertion::Parts::share_length() {
  const double hand_over = kHandOver * settings.needle_radius_mm;
  const auto age = [&](const Grip& grip) { return std::min(1.0, passed_by(grip) / hand_over); };
  for (Grip& grip : grips) {
    const double own = compliance(grip.point, grip.point).trace() / 3.0;
    grip.softness = own * (1.0 / std::max(age(grip), kYoungest) - 1.0);
    grip.length = 0.0;
  }
  for (std::size_t k = 0; k < grips.size(); ++k) {
    Grip& grip = grips[k];
    const double rho = age(grip);
    const double before = k == 0 ? grip.xi : grip.xi - grips[k - 1].xi;
    if (k == 0) {
      grip.length += before * rho;
    } else {
      grip.length += 0.5 * before * rho;
      grips[k - 1].length += before * (1.0 - 0.5 * rho);
    }
    if (k + 1 == grips.size()) {
      double after = passed_by(grip);
      if (track.open) after = std::min(after, std::max(0.0, track.air_from_xi - grip.xi));
      grip.length += after;
    }
  }

  if (grips.empty()) {
    tip.lateral_softness = 0.0;
    return;
  }
  const double rho = age(grips.front());
  const double own = compliance(ContactCompliance::kTip, ContactCompliance::kTip).trace() / 3.0;
  tip.lateral_softness = rho >= 1.0 - kYoungest ? std::numeric_limits<double>::infinity() : own * rho / (1.0 - rho);
}

}  // namespace stylet
