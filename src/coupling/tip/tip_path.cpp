// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/tip/tip_path.hpp"

#include "coupling/regions.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {
/// [mm] Depth up to which a point counts as on the surface. Raised, a tip that is just inside counts as outside.
constexpr double kAtSurface_mm = 1e-6;
}  // namespace

TipPath::TipPath(const InsertionTissue& mesh, const CouplingSettings& settings, const Pose& base, const Needle& needle,
                 TissueResponse& tissue)
    : tip(settings, *mesh.locator, base, needle, tissue),
      tracks(settings.capacity, settings.join_mm),
      marks(mesh, settings, tissue),
      mesh_(mesh),
      settings_(settings),
      needle_(needle),
      tissue_(tissue) {}

void TipPath::place_in_air(const Vec3& tip_now) {
  phase_ = TipState::air;
  air_tip_ = tip_now;
  slid_off_ = false;
  forget_entry();
}

void TipPath::forget_entry() {
  awaited_entry_.reset();
  went_past_surface_ = false;
}

bool TipPath::in_tissue(const Vec3& x) const { return mesh_.locator->find(x - kAtSurface_mm * tangent()).has_value(); }

/// For a tip inside the tissue: the point where a straight line back along the needle leaves the tissue, if it is
/// within the needle's diameter of the tip.
std::optional<Vec3> TipPath::surface_behind(const Vec3& x) const {
  if (!in_tissue(x)) return std::nullopt;
  const Vec3 from = needle_.point(0.0);
  const auto crossing = mesh_.locator->first_entry(from, x);
  if (!crossing) return std::nullopt;
  const Vec3 surface = from + crossing->t * (x - from);
  return (x - surface).norm() <= settings_.merge_mm ? std::optional(surface) : std::nullopt;
}

bool TipPath::meet_surface(const Vec3& from, const Vec3& to, Step& step) {
  slid_off_ = slid_off_ && (in_tissue(to) || mesh_.locator->first_entry(needle_.point(0.0), to));
  if (slid_off_) return true;
  if (went_past_surface_) {
    if (mesh_.locator->find(to)) {
      step.flags |= Step::compliance_missing;
      return false;
    }
    forget_entry();
    return true;
  }
  const bool waited = awaited_entry_.has_value();
  awaited_entry_.reset();
  const auto crossing = mesh_.locator->first_entry(from, to);
  if (!crossing) return true;
  const Vec3 x = from + crossing->t * (to - from);
  const Vec3 inwards = -mesh_.locator->face_normal(crossing->tet, crossing->local);
  if (inwards.dot(tangent()) < settings_.grazing_cos) {
    events.add(EventKind::grazed, region_of(mesh_, crossing->tet));
    return true;
  }
  went_past_surface_ = waited && (to - x).norm() > settings_.merge_mm;
  if (went_past_surface_ || !tissue_.compliance().available(crossing->tet)) {
    step.flags |= Step::compliance_missing;
    awaited_entry_ = {x, tangent(), crossing->tet};
    return false;
  }
  touch_surface(*crossing, x, phase_ == TipState::exited ? EventKind::re_entered : EventKind::skin_contact);
  return true;
}

/// The tip touches the patient's surface from outside. A new track starts there, or the needle joins an earlier track;
/// or the present track continues after a gap outside the tissue.
void TipPath::touch_surface(const Crossing& crossing, const Vec3& x, EventKind kind) {
  const int region = region_of(mesh_, crossing.tet);
  const Vec3 t = tangent();
  const MaterialPoint at{crossing.tet, mesh_.locator->weights(crossing.tet, x)};
  Track& track = tracks.now;
  events.add(kind, region);
  tissue_.leave_behind(track, 1.0);

  bool joins = false;
  if (kind == EventKind::skin_contact) {
    joins = tracks.begin(x, t);
    marks.go_on_from(track, (joins ? 1.0 : 0.5) * settings_.spacing_mm);
  } else {
    track.end_xi += (x - track.end).norm();
    track.open = false;
    marks.go_on_from(track, 0.5 * settings_.spacing_mm);
  }
  entry_N_ = laws(region).rigid ? 0.0 : std::max(laws(region).puncture_N, laws(region).cutting_N);
  entry_direction_ = t;
  tissue_.compliance().enter_by(entry_N_, entry_direction_);
  tissue_.begin_tip(track.end_xi);
  if (joins) {
    tip.put(track.end, track.end_at, !track.open, TipContact::State::open);
    const int inside = region_of(mesh_, track.end_at.tet);
    tip.ahead.be_tissue(inside, laws(inside).cutting_N);
    phase_ = TipState::in_track;
  } else {
    tip.put(x, at, true, TipContact::State::stick);
    const double membrane = membrane_force(mesh_.laws, -1, region);
    tip.ahead.be_outer_surface(crossing.tet, region, -mesh_.locator->face_normal(crossing.tet, crossing.local),
                               membrane, laws(region).cutting_N);
    phase_ = std::isinf(membrane) ? TipState::bone : TipState::pressing;
    if (std::isinf(membrane)) events.add(EventKind::bone_contact, region);
    track.end = x;
    track.end_at = at;
  }
  if (tip.cut.is_stale()) tissue_.move_tip(at, x);  // the compliance at the surface is used instead
}

void TipPath::break_surface(double hand_N, Step& step) {
  ++step.pivots;
  ++tip.toggles;
  tip.set_state(TipContact::State::cut);
  events.add(EventKind::puncture, region_of(mesh_, tip.ahead.behind()), hand_N);
  tip.ahead.pass(tip.ahead.behind());
  cross_surface();
}

/// LPS, unit normal of the face through which the tip passes into the element `behind`; from outside, `here` is that
/// element itself.
Vec3 TipPath::inwards_of(Index here, Index behind) const {
  const auto& neighbours = mesh_.locator->topology().neighbour[static_cast<std::size_t>(behind)];
  const Index before = here == behind ? -1 : here;
  for (int face = 0; face < 4; ++face) {
    if (neighbours[static_cast<std::size_t>(face)] == before) return -mesh_.locator->face_normal(behind, face);
  }
  return tangent();
}

/// Moves to the element behind the surface at the end of the track.
void TipPath::cross_surface() {
  const Index behind = tip.ahead.behind();
  if (behind < 0) {
    const int before = region_of(mesh_, tip.cut.at().tet);
    phase_ = TipState::exited;
    tracks.now.open = true;
    tracks.now.air_from_xi = tracks.now.end_xi;
    tip.exit();
    air_tip_ = tip.cut.x();
    events.add(EventKind::exited, before);
    return;
  }
  const int region = region_of(mesh_, behind);
  tip.cut.enter(behind, inwards_of(tip.cut.at().tet, behind), tangent());
  tip.ahead.be_tissue(region, laws(region).cutting_N);
  tip.ask_own_law();
  events.add(EventKind::region_entered, region);
}

bool TipPath::end_leg(double h, const ContactForces& forces) {
  tip.set_state(TipContact::State::cut);
  if (!(tip.would_cut(h) > tip.cut.advance())) {
    tip.cut.march(tip.cut.advance());
    return false;
  }
  tip.cut.begin_leg();
  tip.aim(forces);
  return true;
}

/// The track grows by a leg of the cut.
void TipPath::grow_track(const Cut::Place& from, const Cut::Place& to, Step& step) {
  if (!(to.advance > from.advance)) return;
  Track& track = tracks.now;
  const double from_xi = track.end_xi;
  track.end = to.x;
  track.end_at = to.at;
  track.end_xi += to.advance - from.advance;
  marks.lay(track, from.x, from_xi, from.at.tet, step);
}

void TipPath::commit(Step& step) {
  if (tip.touches()) {
    const auto legs = tip.cut.legs();
    for (std::size_t k = 0; k < legs.size(); ++k)
      grow_track(legs[k], k + 1 < legs.size() ? legs[k + 1] : tip.cut.start(), step);
    grow_track(tip.cut.start(), tip.cut.end(), step);
  }
  if (tip.touches() && tip.cut.is_blocked()) {
    tip.cut.unblock();
    const auto face = static_cast<std::size_t>(tip.cut.crossing().local);
    const Index here = tip.cut.at().tet;
    const Index behind = mesh_.locator->topology().neighbour[static_cast<std::size_t>(here)][face];
    const int to = region_of(mesh_, behind);
    const double break_N = to < 0 ? 0.0 : membrane_force(mesh_.laws, region_of(mesh_, here), to);
    if (to < 0) {
      tip.ahead.pass(behind);
      cross_surface();
    } else if (break_N <= laws(to).cutting_N) {  // no membrane, or none stronger than the tissue behind it
      tip.ahead.pass(behind);
      cross_surface();
      tip.set_state(TipContact::State::cut);
    } else {
      tip.ahead.be_surface(behind, break_N);
      if (tip.ahead.is_bone()) events.add(EventKind::bone_contact, to);
    }
  }
  if (!tip.touches()) return;
  slide_off_where_flat();
  if (!tip.touches()) return;
  if (tip.waits()) step.flags |= Step::compliance_missing;
  if (tip.refuses_own_law()) step.flags |= Step::unusable_law;
  switch (tip.state()) {
    case TipContact::State::open:
      phase_ = TipState::in_track;
      break;
    case TipContact::State::cut:
      phase_ = TipState::cutting;
      break;
    case TipContact::State::stick:
      phase_ = tip.ahead.is_bone() ? TipState::bone : TipState::pressing;
      break;
  }
}

/// A needle that bows out turns its tip on the patient's surface until it lies flat.
void TipPath::slide_off_where_flat() {
  if (tip.state() != TipContact::State::stick || !tip.ahead.is_flat(tangent(), settings_.grazing_cos)) return;
  events.add(EventKind::grazed, tip.ahead.region());
  tip.exit();
  slid_off_ = tracks.now.end_xi == 0.0;
  if (!slid_off_) {  // it had come out of the tissue at the far side before
    phase_ = TipState::exited;
    tracks.now.open = true;
    tracks.now.air_from_xi = tracks.now.end_xi;
    air_tip_ = tip_now();
  }
}

void TipPath::pass_open_end(const ContactForces& forces, Step& step) {
  const Track& track = tracks.now;
  if (!track.open) return;
  const Vec3 shift = tissue_.displacement(ContactCompliance::kTip, forces);
  const double ahead = tangent().dot(track.end + shift - tip_now());
  const Vec3 now = tip_now() - shift;
  if (ahead > 0.0 && phase_ == TipState::exited) {
    phase_ = TipState::in_track;
    forget_entry();
    events.add(EventKind::re_entered, region_of(mesh_, track.end_at.tet));
  } else if (ahead <= 0.0 && phase_ == TipState::in_track) {
    phase_ = TipState::exited;
    events.add(EventKind::exited, region_of(mesh_, track.end_at.tet));
  }
  if (phase_ != TipState::exited || meet_surface(air_tip_, now, step)) air_tip_ = now;
}

/// On curved or tilted skin a tip beside its entry may be behind the entry plane and yet in the tissue. A needle that
/// is drawn out is in its track until it is out, however far the hand has moved sideways.
bool TipPath::has_left(bool drawn_out) const {
  if (tip.holds()) return false;
  if (!tip.touches() && tracks.now.end_xi == 0.0) return true;  // it has slid off
  const Vec3 t = tangent();
  const Vec3 from_entry = tip_now() - tracks.now.entry;
  const double deep = t.dot(from_entry);
  const double beside = (from_entry - deep * t).norm();
  const bool beside_mouth = deep < settings_.spacing_mm && beside > settings_.join_mm && phase_ != TipState::exited;
  if (beside_mouth && !drawn_out) return true;
  return (deep < 0.0 || beside_mouth) && !in_tissue(tip_now());
}

void TipPath::take_up() {
  tissue_.compliance().change_needle();
  if (in_air()) return;
  tissue_.compliance().enter_by(entry_N_, entry_direction_);
  tip.cut.take_compliance();
}

void TipPath::finish() {
  tissue_.leave_behind(tracks.now, 1.0);
  tracks.finish();
  if (tip.cut.at().tet >= 0) tissue_.set_place(ContactCompliance::kTip, {tip.cut.at(), Vec3::Zero()});
  tip.forget();
}

/// A needle that left its track sideways meets the surface again where its shaft does, unless the tip is so far inside
/// that this would be a blow: a bowed needle may swing that far when it slips off.
void TipPath::come_out() {
  const bool slid_off = slid_off_;
  place_in_air(surface_behind(tip_now()).value_or(tip_now()));
  slid_off_ = slid_off;
  events.add(EventKind::withdrawn, -1);
}

NeedleWhereabouts TipPath::whereabouts() const {
  if (awaited_entry_) return *awaited_entry_;
  if (is_outside()) return {air_tip_, tangent(), -1};
  const bool cuts = tip.state() == TipContact::State::cut;
  return {tip.cut.x(), cuts ? tip.cut.direction() : tangent(), tip.cut.at().tet};
}

}  // namespace stylet
