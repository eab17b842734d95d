// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/laws.hpp"
#include "stylet/coupling/track.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace stylet {

/// The track that the needle is in, and the tracks that earlier insertions left in the tissue. Room for all of them is
/// set aside at construction; nothing allocates after that.
class Tracks {
 public:
  static constexpr int kRoom = 64;  ///< earlier tracks; for one more the oldest is forgotten

  /// @param capacity most marks of one track
  /// @param join_mm a surface point nearer than this to the entry of an earlier track lies in its mouth
  Tracks(int capacity, double join_mm);

  Track now;  ///< the current track; it has no length while the needle is outside

  [[nodiscard]] std::span<const Track> earlier() const { return {earlier_.data(), count_}; }
  /// Whether the current insertion runs in an earlier track.
  [[nodiscard]] bool has_joined() const { return joined_ >= 0; }

  /// A needle meets the surface at x [mm] LPS in the unit direction: the current track begins there. It is the
  /// continuation of an earlier track that begins within join_mm, in the needle's direction, and goes on beneath x; of
  /// several the nearest. Otherwise it is a new one.
  /// @return whether an earlier track goes on
  bool begin(const Vec3& x, const Vec3& direction);

  /// The insertion is over: its track, if it has any length, becomes an earlier one, or takes the place of the one that
  /// it ran in, and keeps that one's entry.
  void finish();

 private:
  [[nodiscard]] int earlier_at(const Vec3& x, const Vec3& direction) const;
  void move_entry(const Vec3& entry);

  double join_mm_;
  std::vector<Track> earlier_;  ///< the first count_ are in use, the rest is room
  std::size_t count_ = 0;
  int joined_ = -1;  ///< the earlier track that this insertion runs in, -1 = none
};

}  // namespace stylet
