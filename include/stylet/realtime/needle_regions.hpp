// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/insertion.hpp"

#include <array>
#include <span>

namespace stylet {

/// Which regions of the mesh a needle is in, with its tip or any part of its shaft: those that its track goes through
/// up to where the tip is, so that a needle which is drawn back leaves them one after the other. Follows an insertion
/// step by step; does not allocate.
class NeedleRegions {
 public:
  /// After every step.
  void follow(const Insertion& insertion);

  /// Writes the regions that the needle is in, each once, that of the tip first.
  /// @param contacts of now, as Insertion::contacts() has them
  /// @return how many; those beyond out.size() are left out
  std::size_t now(const Insertion& insertion, TipState tip, std::span<const ContactState> contacts,
                  std::span<std::int16_t> out) const;

 private:
  struct Entry {
    double xi = 0.0;  ///< [mm] along the track
    int region = -1;
  };
  std::array<Entry, 64> entered_;  ///< in this insertion, as the tip went
  std::size_t count_ = 0;
};

}  // namespace stylet
