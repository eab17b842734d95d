// SPDX-License-Identifier: GPL-3.0-or-later
#include "insertion_parts.hpp"

/// What viscous tissue remembers of the needle. All of this is at rest where the relaxation time is 0.
namespace stylet {

/// Forces that u = A g goes by: those of now where the tissue is elastic, else filtered over time.
void Insertion::Parts::gather_filtered_forces() {
  gather_forces();
  if (!memory.on()) return;
  for (int point = 0; point < compliance.points(); ++point) {
    forces.col(point) = memory.share() * forces.col(point) + memory.past(point);
  }
}

/// The sub-step is over. The tip is a new material point wherever it has cut to; what it left behind goes to the points
/// of the track on either side of it by the lever rule, which keeps force and moment.
void Insertion::Parts::remember() {
  if (!memory.on()) return;
  gather_forces();
  memory.end(forces.leftCols(compliance.points()));
  const double here = memory_xi;
  memory_xi = track.end_xi;
  if (track.end_xi <= here) return;

  const Track::Mark* behind = nullptr;
  const Track::Mark* ahead = nullptr;
  for (const Track::Mark& mark : track.marks) {
    if (mark.point < 0) continue;
    if (mark.xi <= here) {
      behind = &mark;
    } else if (ahead == nullptr) {
      ahead = &mark;
    }
  }
  const double next = ahead != nullptr ? ahead->xi : track.end_xi;
  const double back = behind != nullptr ? (next - here) / (next - behind->xi) : 0.0;
  if (behind != nullptr) memory.hand_over(ContactCompliance::kTip, behind->point, back);
  if (ahead != nullptr) memory.hand_over(ContactCompliance::kTip, ahead->point, 1.0);
}

/// The tip leaves its place: the last point of the track takes over what is remembered there.
void Insertion::Parts::leave_memory_behind() {
  if (!memory.on()) return;
  for (auto mark = track.marks.rbegin(); mark != track.marks.rend(); ++mark) {
    if (mark->point < 0) continue;
    memory.hand_over(ContactCompliance::kTip, mark->point, 1.0);
    return;
  }
}

/// The needle is in the air and the tissue goes on relaxing; once it is still, the model is what it was at first.
void Insertion::Parts::relax() {
  if (!relaxing) return;
  gather_forces();
  memory.end(forces.leftCols(compliance.points()));
  if (memory.relaxed(compliance)) forget_tissue();
}

/// The tissue model is what it was before the first contact.
void Insertion::Parts::forget_tissue() {
  relaxing = false;
  memory.reset();
  compliance.reset();
}

}  // namespace stylet
