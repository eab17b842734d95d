// SPDX-License-Identifier: GPL-3.0-or-later
#include "insertion_parts.hpp"

#include <algorithm>
#include <cmath>

/// What viscous tissue remembers of the needle. All of this is at rest where the relaxation time is 0.
namespace stylet {

namespace {
constexpr double kTipReach =
    2.5;  ///< needle radii over which a tip's field (ε = 1.5 R) falls to a half along the force
constexpr double kDentReach = 4.0;  ///< times the dent: so much slower, or the tissue would start back past the tip
}  // namespace

/// Forces that u = A g goes by: those of now where the tissue is elastic, else filtered over time.
void Insertion::Parts::gather_filtered_forces() {
  gather_forces();
  if (!memory.on()) return;
  for (int point = 0; point < compliance.points(); ++point) {
    forces.col(point) = memory.share() * forces.col(point) + memory.past(point);
  }
}

/// The sub-step is over. The tip is a new material point wherever it has cut to. What it left behind goes to the last
/// point of the track, but not at once: such a point stands for a piece of shaft and yields several times less than a
/// tip, and tissue would start back. It goes as the tip's own field falls off with the way it has cut, and where the
/// dent is deeper than that field is wide, no faster than a tip can follow. Before there is such a point it stays.
void Insertion::Parts::remember() {
  if (!memory.on()) return;
  gather_forces();
  memory.end(forces.leftCols(compliance.points()));
  const double cut = track.end_xi - memory_xi;
  memory_xi = track.end_xi;
  if (cut <= 0.0) return;
  const double dent =
      (compliance(ContactCompliance::kTip, ContactCompliance::kTip) * memory.past(ContactCompliance::kTip)).norm();
  const double reach = std::max(kTipReach * settings.needle_radius_mm, kDentReach * dent);
  leave_memory_behind(1.0 - std::exp(-cut / reach));
}

/// The last point of the track takes over a part of what is remembered at the tip.
void Insertion::Parts::leave_memory_behind(double part) {
  if (!memory.on()) return;
  for (auto mark = track.marks.rbegin(); mark != track.marks.rend(); ++mark) {
    if (mark->point < 0) continue;
    memory.hand_over(ContactCompliance::kTip, mark->point, part);
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
