// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/insertion.hpp"

#include <array>
#include <span>

namespace stylet {

/// Determines the regions of the mesh in which a needle is, with its tip or any part of its shaft: the regions through
/// which its track goes up to the tip. A needle that is drawn back thus leaves them one after the other. Follows an
/// insertion step by step; does not allocate.
class NeedleRegions {
 public:
  /// Call after every step.
  void follow(const Insertion& insertion);

  /// Writes the regions in which the needle is, each once, the tip's region first.
  /// @param contacts present contacts from Insertion::contacts()
  /// @return number of regions written; regions beyond out.size() are left out
  std::size_t now(const Insertion& insertion, TipState tip, std::span<const ContactState> contacts,
                  std::span<std::int16_t> out) const;

 private:
  struct Entry {
    double xi = 0.0;  ///< [mm] arc length along the track
    int region = -1;
  };
  std::array<Entry, 64> entered_;  ///< regions entered in this insertion, in order
  std::size_t count_ = 0;
};

}  // namespace stylet
