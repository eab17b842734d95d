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

/// A cause in words, and where it occurs. Tables, files, reports and pages are made of these.
struct SeedCauseWords {
  SeedCause cause{};
  const char* name;      ///< in summary.json, in reports and in the live page
  const char* column;    ///< beginning of its columns in tables and files
  const char* of_drop;   ///< a sentence about a seed that a hand drops (`stylet serve`); null: it does not occur there
  const char* of_seed;   ///< a sentence about a seed of a permanent implant; null: it does not occur there
  const char* of_dwell;  ///< a sentence about a dwell position of a temporary implant; null: it does not occur there
  int since;             ///< first version of the run.h5 of an implant that has it
};
/// All causes, in the order of SeedCause.
inline constexpr std::array kSeedCauses{
    SeedCauseWords{SeedCause::bend, "needle bend", "bend", "The needle was bent when it left the seed.",
                   "The needle was bent, or did not reach its depth, when the seed left it.",
                   "The catheter was bent, or did not reach its depth, when the images of the plan were taken.", 1},
    SeedCauseWords{SeedCause::motion, "tissue motion", "motion",
                   "The needle had displaced the tissue, which has gone back since and taken the seed along.",
                   "The needle held the tissue displaced when the seed was dropped; the tissue has gone back since and "
                   "has taken the seed along.",
                   "The catheters held the tissue displaced when the images of the plan were taken, so the dwell "
                   "position was in other tissue than planned.",
                   1},
    SeedCauseWords{SeedCause::relaxation, "tissue relaxation", "relaxation",
                   "The tissue had crept under the needle, which goes back slowly.",
                   "The tissue had crept under the needle when the seed was dropped; it has gone back since and has "
                   "taken the seed along.",
                   "The tissue had crept under the catheters when the images of the plan were taken.", 1},
    SeedCauseWords{SeedCause::strand, "strand", "strand", "The strand holds the seed at its distance from the others.",
                   "The strand holds the seed at its distance from the other seeds of the needle.", nullptr, 1},
    SeedCauseWords{SeedCause::release, "release", "release", "The seed jumped along its track when it was let go.",
                   "The seed jumped along its track when it was let go.", nullptr, 1},
    SeedCauseWords{SeedCause::aim, "aim", "aim",
                   "Where a straight needle held as you held it would have left the seed, less its planned place.",
                   "The needle was aimed beside the plan on purpose, to make up for the other causes.", nullptr, 1},
    SeedCauseWords{SeedCause::probe, "probe", "probe", nullptr,
                   "The probe held the gland displaced when the seed was dropped, and the contours of the plan were "
                   "drawn without it; with the probe out the tissue goes back and takes the seed along.",
                   nullptr, 1},
    SeedCauseWords{SeedCause::wait, "planning to delivery", "wait", nullptr, nullptr,
                   "Tissue and catheter moved against each other between the images of the plan and the delivery.", 2},
};
constexpr const SeedCauseWords& words_of(SeedCause cause) { return kSeedCauses[static_cast<std::size_t>(cause)]; }
/// "needle bend", "tissue motion", …
constexpr const char* to_string(SeedCause cause) { return words_of(cause).name; }
/// The sentence about a cause in an implant of a kind.
constexpr const char* meaning_of(SeedCause cause, Implant implant) {
  return implant == Implant::temporary ? words_of(cause).of_dwell : words_of(cause).of_seed;
}

/// The parts of a seed's error by cause [mm] LPS.
struct SeedCauseParts : std::array<Vec3, kSeedCauses.size()> {
  SeedCauseParts() { fill(Vec3::Zero()); }
};

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
  SeedCauseParts cause_mm;

  /// Whether both are the same drop, wherever they rest. A seed that is taken back and dropped again is another one.
  [[nodiscard]] bool is_same_drop(const SeedHistory& other) const {
    return number == other.number && needle == other.needle && dropped_s == other.dropped_s &&
           dropped_mm == other.dropped_mm;
  }
  /// Divides the error of a seed that has just been left, by its places dropped and at rest, into aim, bend, relaxation
  /// and motion. Strand, release, probe and wait are added later, where they move it.
  /// @param aim_mm where a straight needle would have left it, less its planned place
  /// @param lasting_mm displacement of its tissue that the tissue has crept into
  void explain(const Vec3& aim_mm, const Vec3& lasting_mm) {
    by(SeedCause::aim) = aim_mm;
    by(SeedCause::bend) = dropped_mm - planned_mm - aim_mm;
    by(SeedCause::relaxation) = -lasting_mm;
    by(SeedCause::motion) = rest_mm - dropped_mm - by(SeedCause::relaxation);
  }
  [[nodiscard]] Vec3 error_mm() const { return rest_mm - planned_mm; }
  [[nodiscard]] Vec3& by(SeedCause cause) { return cause_mm[static_cast<std::size_t>(cause)]; }
  [[nodiscard]] const Vec3& by(SeedCause cause) const { return cause_mm[static_cast<std::size_t>(cause)]; }
};

/// The kind of an implant: its seeds are dwell positions, and its needles catheters, if it is temporary.
[[nodiscard]] Implant implant_of(std::span<const SeedHistory> seeds);

}  // namespace stylet
