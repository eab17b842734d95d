// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"
#include "stylet/dose/dose_plan.hpp"

#include <array>
#include <optional>
#include <span>
#include <string>

namespace stylet {

/// Why a seed, or a dwell position, does not lie where it was planned. The causes add up to its error.
enum class SeedCause {
  bend,        ///< the needle was bent, or did not reach its depth
  motion,      ///< the tissue was displaced when the seed was dropped, and has gone back since
  relaxation,  ///< the tissue had crept under the needle when the seed was dropped, and has gone back since
  strand,      ///< the strand holds the seed at its distance from the others
  release,     ///< the seed jumped along its track when it was let go
  aim,         ///< its needle was aimed beside the plan on purpose, to make up for the others
  probe,  ///< the probe displaced the tissue when the seed was dropped, and the contours of the plan are without it
  wait    ///< tissue and catheter moved against each other between planning and delivery (temporary implants)
};
inline constexpr std::size_t kSeedCauses = 7;  ///< those of a seed of a permanent implant, the first ones
inline constexpr std::size_t kAllCauses = 8;
/// "needle bend", "tissue motion", "tissue relaxation", "strand", "release", "aim", "probe", "planning to delivery"
const char* to_string(SeedCause cause);

/// A dwell position when the images of the plan are taken, with all catheters in place.
struct DwellAtPlanning {
  Vec3 room_mm = Vec3::Zero();    ///< [mm] LPS, its place in the room
  Vec3 tissue_mm = Vec3::Zero();  ///< [mm] LPS, the tissue that is there, by its place at rest
};

/// The history of one seed: where it was planned, dropped, and comes to rest. All places are of its centre, in LPS
/// [mm].
/// In a temporary implant it is a dwell position, which the delivery leaves nowhere: `dropped_mm` is its place in the
/// room at the delivery, and `rest_mm` the tissue that is there, by its place at rest.
struct SeedHistory {
  std::size_t number = 0;  ///< its position in DosePlan::sources
  std::size_t needle = 0;  ///< number of its needle, in the order in which needles were inserted
  Vec3 planned_mm = Vec3::Zero();
  Vec3 dropped_mm = Vec3::Zero();              ///< place in the room where the cannula, or the tip, left it
  Vec3 rest_mm = Vec3::Zero();                 ///< place in the tissue at rest, with all needles out
  Vec3 axis = Vec3::UnitZ();                   ///< unit vector at rest, towards the tip of its needle
  double dropped_s = 0.0;                      ///< [s] since the start of its needle
  bool lost = false;                           ///< it has left the patient and gives no dose
  bool in_tissue = true;                       ///< whether the tissue point where it was dropped could be found
  std::optional<DwellAtPlanning> at_planning;  ///< of a dwell position; empty for a seed
  std::array<Vec3, kAllCauses> cause_mm{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(),
                                        Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};

  /// Whether both are the same drop, wherever they rest. A seed that is taken back and dropped again is another one.
  [[nodiscard]] bool is_same_drop(const SeedHistory& other) const {
    return number == other.number && needle == other.needle && dropped_s == other.dropped_s &&
           dropped_mm == other.dropped_mm;
  }
  [[nodiscard]] Vec3 error_mm() const { return rest_mm - planned_mm; }
  [[nodiscard]] Vec3& by(SeedCause cause) { return cause_mm[static_cast<std::size_t>(cause)]; }
  [[nodiscard]] const Vec3& by(SeedCause cause) const { return cause_mm[static_cast<std::size_t>(cause)]; }
};

/// The kind of an implant: its seeds are dwell positions, and its needles catheters, if it is temporary.
[[nodiscard]] Implant implant_of(std::span<const SeedHistory> seeds);

}  // namespace stylet
