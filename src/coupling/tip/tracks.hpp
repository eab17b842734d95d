// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/laws.hpp"
#include "stylet/coupling/track.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace stylet {

/// The current track, and the tracks that earlier insertions left in the tissue. All memory is allocated at
/// construction.
class Tracks {
 public:
  static constexpr int kRoom = 64;  ///< largest number of earlier tracks; one more replaces the oldest

  /// @param capacity largest number of marks on one track
  /// @param join_mm a surface point nearer than this to the entry of an earlier track joins that track
  Tracks(int capacity, double join_mm);

  Track now;  ///< the current track; its length is 0 while the needle is outside

  [[nodiscard]] std::span<const Track> earlier() const { return {earlier_.data(), count_}; }
  /// Whether the current insertion has joined an earlier track.
  [[nodiscard]] bool has_joined() const { return joined_ >= 0; }

  /// Begins the current track where a needle meets the surface: at x [mm] LPS, in the unit direction `direction`. It
  /// joins an earlier track that begins within join_mm of x, has the needle's direction and ends behind x; of several
  /// such tracks, the nearest. Otherwise it is a new track.
  /// @return whether it has joined an earlier track
  bool begin(const Vec3& x, const Vec3& direction);

  /// Ends the insertion. Its track, if it has any length, becomes an earlier track; a joined track replaces the earlier
  /// one and keeps that one's entry.
  void finish();

 private:
  [[nodiscard]] int earlier_at(const Vec3& x, const Vec3& direction) const;
  void move_entry(const Vec3& entry);

  double join_mm_;
  std::vector<Track> earlier_;  ///< the first count_ elements are in use
  std::size_t count_ = 0;
  int joined_ = -1;  ///< number of the earlier track that this insertion has joined, −1: none
};

}  // namespace stylet
