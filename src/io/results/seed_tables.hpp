// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "h5.hpp"
#include "stylet/implant/recorded_implant.hpp"

#include <array>
#include <limits>
#include <span>
#include <vector>

/// The group /implant of run.h5 (docs/results.md): the plan of seeds, and what a live session has carried out of it.
namespace stylet::results {

/// A row of /implant/needles.
struct PlanNeedleRow {
  std::array<char, 64> name{};
  std::array<char, 16> hole{};
  std::array<double, 3> entry_mm{}, direction{};
  double depth_mm = 0.0;
};
/// A row of /implant/planned_seeds. As everywhere in files, seeds are counted from 1.
struct PlanSeedRow {
  std::int64_t number = 0, needle = 0;
  std::array<double, 3> planned_mm{}, axis{};
  double drop_depth_mm = 0.0;
};
/// A live session knows the causes before SeedCause::probe: its seeds are those of tissue that no probe displaces.
inline constexpr std::size_t kActCauses = static_cast<std::size_t>(SeedCause::probe);

/// A row of /implant/acts. Its check is the CRC-32 of its other columns in their order.
struct ActRow {
  std::int8_t kind = 0;
  double time_s = std::numeric_limits<double>::quiet_NaN();
  std::int64_t number = 0, needle = 0;
  double dropped_s = 0.0;
  std::array<double, 3> planned_mm{}, dropped_mm{}, rest_mm{}, axis{};
  std::array<std::array<double, 3>, kActCauses> cause_mm{};
  std::int8_t in_tissue = 0, lost = 0;
  std::uint32_t check = 0;
};
/// A row of /implant/doses, with a check as ActRow.
struct DoseRow {
  std::int64_t acts = 0, seeds = 0;
  double d90_Gy = std::numeric_limits<double>::quiet_NaN();
  double d90_percent = 0.0, v100_percent = 0.0;
  std::uint32_t check = 0;
};
std::uint32_t check_of(const ActRow& row);
std::uint32_t check_of(const DoseRow& row);
SeedAct from_row(const ActRow& row);
RecordedScore from_row(const DoseRow& row);

/// The group as stored, before the checks. Without needles the file has none.
struct StoredSeeds {
  std::string digest;  ///< of everything but acts and doses
  std::vector<PlanNeedleRow> needles;
  std::vector<PlanSeedRow> planned;
  int current = -1;
  double seed_length_mm = 0.0, seed_diameter_mm = 0.0, prescription_Gy = 0.0;
  std::string source;
  std::vector<ActRow> acts;
  std::vector<DoseRow> doses;
};
/// Digest of the plan as stored.
std::string plan_digest(const StoredSeeds& stored);
/// The plan as stored. Empty if a seed or the present needle refers to a needle that does not exist.
std::optional<RecordedPlan> plan_of(const StoredSeeds& stored);
/// Reads the group; without needles if the file has none. Throws h5::Failure.
StoredSeeds read_seed_tables(hid_t file);

/// Writes the group: the plan at once, acts and doses as they happen. The functions throw h5::Failure.
class SeedTables {
 public:
  SeedTables(hid_t file, const RecordedPlan& plan);
  void append(std::span<const SeedAct> acts);
  void append(std::span<const RecordedScore> doses);
  bool close();  ///< false if the last writing failed

 private:
  h5::Handle act_type_, dose_type_;
  h5::Handle acts_, doses_;
};

}  // namespace stylet::results
