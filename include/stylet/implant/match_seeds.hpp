// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <optional>
#include <span>
#include <vector>

namespace stylet {

/// The distance beyond which two seeds are not taken for the same one [mm], after the common shift. It is the distance
/// of neighbours in a train with one spacer between seeds (S-1-S): a seed that lies further away may as well be its
/// neighbour. It is twice the mean distance from plan of 1,197 seeds in patients, 4.9 mm (docs/validation.md).
inline constexpr double kMatchLimit_mm = 10.0;

/// A seed that was dropped and a seed that was found, taken for the same one.
struct SeedPair {
  std::size_t dropped = 0;  ///< position in the list of seeds that were dropped
  std::size_t found = 0;    ///< position in the list of seeds that were found
  bool ambiguous = false;   ///< another match of this seed is nearly as likely
};

/// Which seeds that were found are which seeds that were dropped.
struct SeedMatching {
  std::vector<SeedPair> pairs;         ///< in the order of the seeds that were dropped
  std::vector<std::size_t> not_found;  ///< dropped, and no seed was found for them
  std::vector<std::size_t> extra;      ///< found, and no seed was dropped for them
  Vec3 shift_mm = Vec3::Zero();        ///< [mm] mean of found − dropped over all pairs
  Vec3 shift_error_mm = Vec3::Zero();  ///< [mm] its standard error along each axis; 0 with fewer than two pairs
  double scatter_mm = 0.0;   ///< standard deviation of found − dropped along an axis; 0 with fewer than two pairs
  bool frame_moved = false;  ///< in the given places fewer than half of the seeds matched; first the centres were
                             ///< put on each other, which matches more

  /// Whether the common shift is larger than chance alone would make it in one of twenty implants: beyond 2.39 standard
  /// errors along one of the three axes (Bonferroni). False with fewer than two pairs.
  [[nodiscard]] bool shift_beyond_chance() const;
};

/// Matches seeds one to one so that the sum of the squared distances is least, where each seed that is left alone costs
/// as much as a pair at kMatchLimit_mm. A shift that all seeds have in common does not count: matching and shift are
/// found in turn, from no shift on, until the matching stays. If fewer than half of the seeds match so, and one list is
/// at least half as long as the other, the difference of the centres is tried as the first shift too.
/// A pair is ambiguous if exchanging its seed with that of another pair, or with a seed that is left alone, has a
/// likelihood of more than 1/19 of its own, so that the pair is less than 95 % sure. The likelihood is that of normal
/// errors with the scatter of all pairs.
/// @param dropped, found [mm] LPS, in any order and number
SeedMatching match_seeds(std::span<const Vec3> dropped, std::span<const Vec3> found);

}  // namespace stylet
