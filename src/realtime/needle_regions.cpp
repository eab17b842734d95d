// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/needle_regions.hpp"

#include <algorithm>

namespace stylet {

namespace {

/// Arc length [mm] of the tip along its track. The contacts on the shaft are at the first marks of the track.
double tip_xi(const Insertion& insertion, TipState tip, std::span<const ContactState> contacts) {
  const Track& track = insertion.track();
  if (tip != TipState::in_track) return track.end_xi;
  const auto grips = static_cast<std::size_t>(
      std::count_if(contacts.begin(), contacts.end(), [](const ContactState& c) { return !c.tip; }));
  if (grips == 0 || grips > track.marks.size()) return 0.0;
  return track.marks[grips - 1].xi + insertion.needle().length() - contacts.back().s;
}

}  // namespace

void NeedleRegions::follow(const Insertion& insertion) {
  for (const InsertionEvent& event : insertion.events()) {
    if (event.kind == EventKind::withdrawn) count_ = 0;
    if (event.kind == EventKind::region_entered && count_ < entered_.size())
      entered_[count_++] = {insertion.track().end_xi, event.region};
  }
}

std::size_t NeedleRegions::now(const Insertion& insertion, TipState tip, std::span<const ContactState> contacts,
                               std::span<std::int16_t> out) const {
  if (tip == TipState::air) return 0;
  const double here = tip_xi(insertion, tip, contacts);
  std::array<double, 64> deepest{};  // for each region written: greatest arc length at which the track is in it
  std::size_t count = 0;
  const auto consider = [&](double xi, int region) {
    if (xi > here) return;
    const auto end = out.begin() + static_cast<std::ptrdiff_t>(count);
    const auto found = std::find(out.begin(), end, static_cast<std::int16_t>(region));
    const auto at = static_cast<std::size_t>(found - out.begin());
    if (found == end && (count == out.size() || count == deepest.size())) return;
    if (found == end) out[count++] = static_cast<std::int16_t>(region);
    deepest[at] = found == end ? xi : std::max(deepest[at], xi);
  };
  for (std::size_t k = 0; k < count_; ++k) consider(entered_[k].xi, entered_[k].region);
  // A track of an earlier insertion has marks only.
  for (const Track::Mark& mark : insertion.track().marks) consider(mark.xi, mark.region);
  if (count > 0) {
    const auto first = std::max_element(deepest.begin(), deepest.begin() + static_cast<std::ptrdiff_t>(count));
    std::swap(out[0], out[static_cast<std::size_t>(first - deepest.begin())]);
  }
  return count;
}

}  // namespace stylet
