// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/tip/tracks.hpp"

#include <algorithm>
#include <utility>

namespace stylet {

namespace {
constexpr double kSameDirection = 0.98;  ///< cosine of the angle between two needles above which the second may join
                                         ///< the first one's track; raised, fewer needles join
}  // namespace

Tracks::Tracks(int capacity, double join_mm) : join_mm_(join_mm), earlier_(kRoom) {
  now.marks.reserve(static_cast<std::size_t>(capacity));
  for (Track& track : earlier_) track.marks.reserve(static_cast<std::size_t>(capacity));
}

bool Tracks::begin(const Vec3& x, const Vec3& direction) {
  joined_ = earlier_at(x, direction);
  if (joined_ >= 0) {
    now = earlier_[static_cast<std::size_t>(joined_)];
    for (Track::Mark& mark : now.marks) mark.point = -1;
    // On curved or tilted skin this needle meets the surface before or behind the earlier entry.
    move_entry(x);
    return true;
  }
  now.entry = x;
  now.entry_direction = direction;
  now.marks.clear();
  now.end_xi = 0.0;
  now.open = false;
  return false;
}

void Tracks::finish() {
  if (now.end_xi > 0.0) {
    std::size_t place = static_cast<std::size_t>(joined_);
    if (has_joined()) {
      // The earlier entry is kept: otherwise needle after needle, each beside the last, would move it across the skin.
      move_entry(earlier_[place].entry);
    } else {
      if (count_ < earlier_.size()) {
        ++count_;
      } else {
        std::rotate(earlier_.begin(), earlier_.begin() + 1, earlier_.end());
      }
      place = count_ - 1;
    }
    std::swap(earlier_[place], now);
  }
  now.marks.clear();
  now.end_xi = 0.0;
  now.open = false;
  joined_ = -1;
}

int Tracks::earlier_at(const Vec3& x, const Vec3& direction) const {
  int found = -1;
  double nearest = join_mm_;
  for (std::size_t k = 0; k < count_; ++k) {
    const Track& track = earlier_[k];
    const double distance = (track.entry - x).norm();
    if (distance >= nearest || track.entry_direction.dot(direction) <= kSameDirection) continue;
    if (track.end_xi <= track.entry_direction.dot(x - track.entry)) continue;
    nearest = distance;
    found = static_cast<int>(k);
  }
  return found;
}

/// Moves the start of the current track, and of its arc length, to another place of the surface.
void Tracks::move_entry(const Vec3& entry) {
  const double later = now.entry_direction.dot(entry - now.entry);
  now.entry = entry;
  now.end_xi -= later;
  now.air_from_xi -= later;
  for (Track::Mark& mark : now.marks) mark.xi -= later;
  std::erase_if(now.marks, [](const Track::Mark& mark) { return mark.xi <= 0.0; });
}

}  // namespace stylet
