// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/contacts/marks.hpp"

#include "coupling/regions.hpp"

#include <algorithm>
#include <array>

namespace stylet {

namespace {
/// Where no mark can be laid, the next place is tried after 1/16 of the spacing. Raised, marks are nearer to their
/// regular places and the search takes longer.
constexpr double kTriesPerSpacing = 16.0;
/// Distance from the last mark, in spacings, after which an interpolated mark is accepted. Raised, fewer marks are
/// interpolated and gaps grow.
constexpr double kPatience = 1.5;
/// Largest number of elements that one sub-step may pass through; no track has needed more.
constexpr int kMostElements = 64;
}  // namespace

/// Placement of the points of contacts. A node that is moved may be moved anywhere, so faces are for added nodes only.
Placement Marks::placement() const {
  using Method = CouplingSettings::Method;
  if (settings_.method == Method::embedded || settings_.method == Method::near_field) return Placement::embedded;
  const bool adds = settings_.method == Method::node_addition;
  return adds && settings_.rule == CouplingSettings::Rule::paper ? Placement::face : Placement::interior;
}

/// Whether a point is a linear combination of its neighbours, because there are more interpolated contacts in an
/// element than the element can tell apart. No contact is made for it, and its neighbours share its length.
/// @param marks number of marks on the track before it
bool Marks::follows_from(int point, const Track& track, std::size_t marks) const {
  std::array<int, ContactCompliance::kNeighbours> neighbours{};
  std::size_t count = 0;
  for (std::size_t k = marks; k > 0 && count < neighbours.size(); --k) {
    if (track.marks[k - 1].point >= 0) neighbours[count++] = track.marks[k - 1].point;
  }
  return tissue_.compliance().independence(point, std::span(neighbours).first(count)) < settings_.independence;
}

bool Marks::lay_one(Track& track, double xi, const Vec3& x, const MaterialPoint& at, Placement placement,
                    const Vec3& travel, Step& step) {
  if (track.marks.size() == static_cast<std::size_t>(settings_.capacity)) {
    step.flags |= Step::out_of_contacts;
    return true;  // counts as laid: no other place would be better
  }
  const ContactCompliance::Added added = tissue_.compliance().add(at, x, placement, travel);
  if (added.refusal == ContactCompliance::Refusal::geometry) return false;
  if (added.refusal == ContactCompliance::Refusal::missing) {
    step.flags |= Step::compliance_missing;
    track.marks.push_back({xi, x, at, region_of(mesh_, at.tet), -1});  // represent() adds a point once the compliance
                                                                       // is there
    return true;
  }
  if (added.refusal == ContactCompliance::Refusal::capacity) step.flags |= Step::out_of_contacts;
  if (added.point < 0) return true;

  if (placement == Placement::embedded && follows_from(added.point, track, track.marks.size())) {
    tissue_.compliance().remove_last_embedded();
    return false;
  }
  track.marks.push_back({xi, x, at, region_of(mesh_, at.tet), added.point});
  tissue_.set_place(added.point, {at, travel.normalized()});
  return true;
}

void Marks::lay(Track& track, const Vec3& from, double from_xi, Index from_tet, Step& step) {
  if (placement() == Placement::face) {
    lay_on_faces(track, from, from_xi, from_tet, step);
    return;
  }
  const Vec3 direction = (track.end - from).normalized();
  const bool nodes = placement() != Placement::embedded;
  while (next_xi_ <= track.end_xi) {
    const Vec3 x = from + std::max(0.0, next_xi_ - from_xi) * direction;
    const auto at = mesh_.locator->find(x, track.end_at.tet, -direction);
    bool laid = false;
    if (at && nodes) laid = lay_one(track, next_xi_, x, *at, Placement::interior, direction, step);
    // A track along a face or an edge leaves no room for a node; use an interpolated point there.
    const double last = track.marks.empty() ? 0.0 : track.marks.back().xi;
    if (at && !laid && (!nodes || next_xi_ - last >= kPatience * settings_.spacing_mm)) {
      laid = lay_one(track, next_xi_, x, *at, Placement::embedded, direction, step);
    }
    next_xi_ += laid ? settings_.spacing_mm : settings_.spacing_mm / kTriesPerSpacing;
  }
}

/// The rule of Goksel et al. 2005: a node wherever the tip passes from one element into the next.
void Marks::lay_on_faces(Track& track, const Vec3& from, double from_xi, Index tet, Step& step) {
  const Locator& locator = *mesh_.locator;
  const Vec3 to = track.end;
  const double piece = (to - from).norm();
  if (piece <= 0.0) return;
  const Vec3 direction = (to - from) / piece;
  if (from_xi == 0.0 && track.marks.empty()) {  // the skin: a face of one element
    lay_one(track, 0.0, from, {tet, locator.weights(tet, from)}, Placement::face, direction, step);
  }
  double done = 0.0;
  for (int steps = 0; steps < kMostElements && tet != track.end_at.tet; ++steps) {
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
    if (xi - last_xi >= settings_.merge_mm) {
      lay_one(track, xi, x, {tet, locator.weights(tet, x)}, Placement::face, direction, step);
    }
    done = first;
    tet = locator.topology().neighbour[static_cast<std::size_t>(tet)][static_cast<std::size_t>(local)];
    if (tet < 0) break;
  }
}

Marks::Outcome Marks::represent(Track& track, std::size_t number, const Vec3& along, Step& step) {
  Track::Mark& mark = track.marks[number];
  Placement where = placement();
  auto added = tissue_.compliance().add(mark.at, mark.x, where, along);
  if (added.refusal == ContactCompliance::Refusal::geometry) {
    where = Placement::embedded;
    added = tissue_.compliance().add(mark.at, mark.x, where);
  }
  if (added.point < 0) {
    step.flags |=
        added.refusal == ContactCompliance::Refusal::missing ? Step::compliance_missing : Step::out_of_contacts;
    return Outcome::refused;
  }
  if (where == Placement::embedded && follows_from(added.point, track, number)) {
    tissue_.compliance().remove_last_embedded();
    track.marks.erase(track.marks.begin() + static_cast<std::ptrdiff_t>(number));
    return Outcome::dropped;
  }
  mark.point = added.point;
  tissue_.set_place(added.point, {mark.at, along});
  return Outcome::there;
}

}  // namespace stylet
