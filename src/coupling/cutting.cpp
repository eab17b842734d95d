// SPDX-License-Identifier: GPL-3.0-or-later
#include "insertion_parts.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

/// The tip: where it cuts, what surfaces it meets, when it punctures them.
namespace stylet {

namespace {
/// How far ahead a sub-step may ever cut [mm]; the next surface is looked for within this.
constexpr double kReach_mm = 4.0;
/// The cut returns to the needle's axis over about this many needle radii, never more steeply than kSteepest.
constexpr double kSteepest = 0.5;
}  // namespace

int Insertion::Parts::region_of(Index tet) const {
  return tet < 0 ? -1 : tissue.locator->mesh().tet_region[static_cast<std::size_t>(tet)];
}

/// Chooses the direction of the cut in undeformed coordinates. A symmetric tip cuts along its own tangent t; tissue
/// turned by the deformation gradient F = I + ∇u is cut along F⁻¹ t. Where the track's end has drifted off the axis
/// (the base moved sideways while the tip did not cut) the cut leads back to the axis. A bevelled tip leads it to a
/// line beside the axis instead (bevel.cpp).
void Insertion::Parts::aim_tip() {
  const InPhase in_phase(phases, StepPhase::tip);
  gather_filtered_forces();
  const Vec3 t = needle->tangent(length());
  const Mat3 F = Mat3::Identity() + compliance.gradient_at_tip(forces.leftCols(compliance.points()));
  Vec3 along = t + lead_of_bevel(t);
  if (!std::isfinite(tip.lateral_softness)) {
    const Vec3 gap = tip.x + tissue_displacement(ContactCompliance::kTip) - needle->point(length());
    Vec3 back = -(gap - t * t.dot(gap)) / settings.merge_mm;
    if (back.norm() > kSteepest) back *= kSteepest / back.norm();
    along += back;
  }
  Vec3 d = F.determinant() > 0.2 ? Vec3(F.inverse() * along) : along;
  // Strains beyond the linear model must not turn the cut around.
  if (d.dot(t) < 0.5 * d.norm()) d = along;
  tip.direction = d.normalized();
}

/// Puts the end of the track `advance` beyond where it was at the start of the sub-step, or on the first surface
/// before.
void Insertion::Parts::march(double advance) {
  const InPhase in_phase(phases, StepPhase::tip);
  advance = std::min(advance, kReach_mm);
  const Vec3 target = tip.x_start + advance * tip.direction;
  MaterialPoint end;
  tip.blocked = false;
  if (const auto crossing = tissue.locator->first_crossing(tip.x_start, tip.at_start.tet, target, end)) {
    tip.blocked = true;
    tip.crossing = *crossing;
    tip.x = tip.x_start + crossing->t * (target - tip.x_start);
    end.tet = crossing->tet;
    end.weights = tissue.locator->weights(end.tet, tip.x);
  } else {
    tip.x = target;
  }
  tip.at = end;
  tip.advance = (tip.x - tip.x_start).norm();
  tip.stale = !compliance.move_tip(tip.at, tip.x);  // then that of the last place stands in for it
}

/// The tip's compliance becomes that of where it is, if it is there by now; the tissue does not move by that.
void Insertion::Parts::take_compliance() {
  const Vec3 there = memory.displacement(compliance, ContactCompliance::kTip);
  tip.stale = !compliance.move_tip(tip.at, tip.x);
  if (!tip.stale) memory.keep_displacement(compliance, ContactCompliance::kTip, there);
}

/// Axial force of the hand when the tip's force reached its limit: on the way from the balance before to that of now,
/// or that of now where there was none before.
double Insertion::Parts::force_at_break() const {
  const Vec3 t = needle->tangent(length());
  const double before = tip.force_start.dot(t);
  const double now = tip.force.dot(t);
  const double part = balanced && before < tip.limit ? (tip.limit - before) / (now - before) : 1.0;
  return (hand_start + part * (hand_force() - hand_start)).dot(base.rotation * Vec3::UnitZ());
}

/// Whether a membrane bears more than it can. To be asked of a balance only: what breaks does not heal, and the forces
/// of an iterate on the way to a balance are no one's. A tip that has come to lie flat to the skin does not enter, as
/// one that meets it flat does not.
bool Insertion::Parts::membrane_gives() const {
  if (!tip_holds() || !tip.at_membrane) return false;
  const Vec3 t = needle->tangent(length());
  const bool flat = !tip.into_body.isZero() && tip.into_body.dot(t) < settings.grazing_cos;
  return tip.force.dot(t) > tip.limit && !flat;
}

/// The membrane breaks and the cut goes on behind it.
void Insertion::Parts::break_membrane(StepReport& report) {
  ++report.pivots;
  ++tip.toggles;
  tip.state = Tip::State::cut;
  add_event(report, InsertionEventKind::puncture, region_of(tip.next_tet), force_at_break());
  cross_surface(report);
}

/// The tip back to where the sub-step, or the cut behind a membrane, began.
void Insertion::Parts::take_back_cut() {
  if (!tip.touching) return;
  if (tip.blocked && tip.state == Tip::State::stick) tip.state = Tip::State::cut;
  if (tip.state == Tip::State::cut) march(0.0);
}

/// Goes over to the element behind the surface that x lies on.
void Insertion::Parts::cross_surface(StepReport& report) {
  const int before = region_of(tip.at.tet);
  const int region = region_of(tip.next_tet);
  tip.at_membrane = false;
  if (tip.next_tet < 0) {
    phase = TipPhase::exited;
    track.open = true;
    track.air_from_xi = track.end_xi;
    tip.touching = false;
    tip.state = Tip::State::open;
    tip.force.setZero();
    air_tip = tip.x;
    add_event(report, InsertionEventKind::exited, before);
    return;
  }
  if (tip.next_tet != tip.at.tet) {
    tip.at.tet = tip.next_tet;
    tip.at.weights = tissue.locator->weights(tip.at.tet, tip.x);
    take_compliance();
  }
  tip.at_start = tip.at;
  tip.x_start = tip.x;
  tip.advance = 0.0;
  tip.cutting = tissue.laws[static_cast<std::size_t>(region)].cutting_N;
  tip.limit = tip.cutting;
  add_event(report, InsertionEventKind::region_entered, region);
}

/// After the sub-step's balance: the track grows by what was cut; a surface met becomes a membrane, a bone, or the way
/// out.
void Insertion::Parts::commit_tip(StepReport& report) {
  const InPhase in_phase(phases, StepPhase::tip);
  if (tip.touching && tip.advance > 0.0) {
    const double from_xi = track.end_xi;
    const Vec3 from = tip.x_start;
    track.end = tip.x;
    track.end_at = tip.at;
    track.end_xi += tip.advance;
    lay_marks(from, from_xi, tip.at_start, report);
  }
  if (tip.touching && tip.blocked) {
    tip.blocked = false;
    const auto face = static_cast<std::size_t>(tip.crossing.local);
    tip.next_tet = tissue.locator->topology().neighbour[static_cast<std::size_t>(tip.at.tet)][face];
    const int from = region_of(tip.at.tet);
    const int to = region_of(tip.next_tet);
    if (to < 0) {
      cross_surface(report);
    } else {
      const double membrane = membrane_force(tissue.laws, from, to);
      if (membrane <= tissue.laws[static_cast<std::size_t>(to)].cutting_N) {
        cross_surface(report);  // no membrane, or none stronger than the tissue behind it
        tip.state = Tip::State::cut;
      } else {
        tip.at_membrane = true;
        tip.limit = membrane;
        tip.into_body.setZero();
        if (std::isinf(membrane)) add_event(report, InsertionEventKind::bone_contact, to);
      }
    }
  }
  if (!tip.touching) return;
  if (tip.stale) report.flags |= StepReport::compliance_missing;
  switch (tip.state) {
    case Tip::State::open:
      phase = TipPhase::in_track;
      break;
    case Tip::State::cut:
      phase = TipPhase::cutting;
      break;
    case Tip::State::stick:
      phase = std::isinf(tip.limit) ? TipPhase::bone : TipPhase::pressing;
      break;
  }
}

/// The tip is in the air and moved from `from` to `to`: does it meet the outer surface?
/// @return false when it does where no compliance is there: it has yet to enter, or, far inside by the time there is
/// some, to be drawn out. Tissue that would have gone with it did not, so to press on it now would be a blow.
bool Insertion::Parts::enter(const Vec3& from, const Vec3& to, StepReport& report) {
  if (went_past_surface) {
    if (tissue.locator->find(to)) {
      report.flags |= StepReport::compliance_missing;
      return false;
    }
    awaited_entry.reset();
    went_past_surface = false;
    return true;
  }
  const bool waited = awaited_entry.has_value();
  awaited_entry.reset();
  const auto crossing = tissue.locator->first_entry(from, to);
  if (!crossing) return true;
  const Vec3 x = from + crossing->t * (to - from);
  const Vec3 inwards = -tissue.locator->face_normal(crossing->tet, crossing->local);
  const int region = region_of(crossing->tet);
  if (inwards.dot(needle->tangent(length())) < settings.grazing_cos) {
    add_event(report, InsertionEventKind::grazed, region);
    return true;
  }
  went_past_surface = waited && (to - x).norm() > settings.merge_mm;
  if (went_past_surface || !compliance.available(crossing->tet)) {
    report.flags |= StepReport::compliance_missing;
    awaited_entry = {x, needle->tangent(length()), crossing->tet};
    return false;
  }
  touch_surface(*crossing, x, report,
                phase == TipPhase::exited ? InsertionEventKind::re_entered : InsertionEventKind::skin_contact);
  return true;
}

/// The old track that begins within the needle's diameter of a surface point, in the needle's direction, and goes on
/// beneath that point; the nearest of several, -1 = none.
int Insertion::Parts::old_track_at(const Vec3& x, const Vec3& direction) const {
  constexpr double same_direction = 0.98;
  int found = -1;
  double nearest = settings.join_mm;
  for (std::size_t k = 0; k < old_count; ++k) {
    const Track& old = old_tracks[k];
    const double distance = (old.entry - x).norm();
    if (distance >= nearest || old.entry_direction.dot(direction) <= same_direction) continue;
    if (old.end_xi <= old.entry_direction.dot(x - old.entry)) continue;
    nearest = distance;
    found = static_cast<int>(k);
  }
  return found;
}

void Insertion::Parts::begin_track(const Vec3& x, const Vec3& direction) {
  joined = -1;
  track.entry = x;
  track.entry_direction = direction;
  track.marks.clear();
  track.end_xi = 0.0;
  track.open = false;
}

/// Goes on in an old track. It begins where this needle has met the surface, which on curved or tilted skin is before
/// or behind the old entry.
void Insertion::Parts::join_track(int old, const Vec3& x) {
  joined = old;
  track = old_tracks[static_cast<std::size_t>(old)];
  for (Track::Mark& mark : track.marks) mark.point = -1;
  begin_at(x);
}

/// The track begins at another place of the surface, and its arc length there.
void Insertion::Parts::begin_at(const Vec3& entry) {
  const double later = track.entry_direction.dot(entry - track.entry);
  track.entry = entry;
  track.end_xi -= later;
  track.air_from_xi -= later;
  for (Track::Mark& mark : track.marks) mark.xi -= later;
  std::erase_if(track.marks, [](const Track::Mark& mark) { return mark.xi <= 0.0; });
}

/// Starts a track at a surface point, or joins an old one that begins there.
void Insertion::Parts::touch_surface(const Crossing& crossing, const Vec3& x, StepReport& report,
                                     InsertionEventKind kind) {
  const int region = region_of(crossing.tet);
  const Vec3 t = needle->tangent(length());
  add_event(report, kind, region);
  leave_memory_behind(1.0);
  tip = Tip{};
  tip.touching = true;
  tip.x = x;
  tip.at = {crossing.tet, tissue.locator->weights(crossing.tet, x)};

  if (kind == InsertionEventKind::skin_contact) {
    if (const int old = old_track_at(x, t); old >= 0) {
      join_track(old, x);
      tip.touching = !track.open;
      tip.x = track.end;
      tip.at = track.end_at;
      tip.state = Tip::State::open;
      phase = TipPhase::in_track;
    } else {
      begin_track(x, t);
    }
    candidate_xi = track.end_xi + (joined >= 0 ? 1.0 : 0.5) * settings.spacing_mm;
  } else {
    track.end_xi += (x - track.end).norm();  // the needle crossed a gap outside the tissue
    track.open = false;
    candidate_xi = track.end_xi + 0.5 * settings.spacing_mm;
  }
  if (joined < 0 || kind != InsertionEventKind::skin_contact) {
    const double membrane = membrane_force(tissue.laws, -1, region);
    tip.next_tet = crossing.tet;
    tip.at_membrane = true;
    tip.into_body = -tissue.locator->face_normal(crossing.tet, crossing.local);
    tip.cutting = tissue.laws[static_cast<std::size_t>(region)].cutting_N;
    tip.limit = std::max(membrane, tip.cutting);
    tip.state = Tip::State::stick;
    phase = std::isinf(membrane) ? TipPhase::bone : TipPhase::pressing;
    if (std::isinf(membrane)) add_event(report, InsertionEventKind::bone_contact, region);
    track.end = x;
    track.end_at = tip.at;
  } else {
    const int inside = region_of(tip.at.tet);
    tip.cutting = tissue.laws[static_cast<std::size_t>(inside)].cutting_N;
    tip.limit = tip.cutting;
  }
  const RegionLaws& outside = tissue.laws[static_cast<std::size_t>(region)];
  compliance.enter_by(outside.rigid ? 0.0 : std::max(outside.puncture_N, outside.cutting_N), t);
  tip.x_start = tip.x;
  tip.at_start = tip.at;
  memory.forget(ContactCompliance::kTip);
  memory_xi = track.end_xi;
  relaxing = false;
  tip.stale = !compliance.move_tip(tip.at, tip.x);
  if (tip.stale) compliance.move_tip({crossing.tet, tissue.locator->weights(crossing.tet, x)}, x);  // for want of any
}

}  // namespace stylet
