// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/implant/found_seed.hpp"
#include "stylet/implant/match_seeds.hpp"
#include "stylet/implant/seed_errors.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// A seed of the plan that was found on images. All places and vectors are in LPS [mm].
struct MatchedSeed {
  SeedHistory seed;                  ///< as it was simulated
  std::size_t found = 0;             ///< position in the list of seeds that were found
  Vec3 found_mm = Vec3::Zero();      ///< where it was found
  Vec3 remainder_mm = Vec3::Zero();  ///< found − place of rest: what the simulation does not explain
  bool ambiguous = false;            ///< as in SeedPair

  /// From the planned place to where it was found: the parts by cause and the remainder add up to it.
  [[nodiscard]] Vec3 error_mm() const { return found_mm - seed.planned_mm; }
};

/// A part of the mean square of the errors of all matched seeds.
struct ErrorPart {
  std::string name;       ///< of a cause; "common shift"; "not explained by the simulation"
  double mean_mm2 = 0.0;  ///< [mm²] mean of error · part; negative where it points against the error
  double percent = 0.0;   ///< of the mean square of the error; 0 where that is 0
};

/// The errors of the matched seeds, in one choice of what is an error.
struct FoundErrors {
  SeedErrors error;              ///< found − planned
  SeedErrors remainder;          ///< found − simulated place of rest
  double mean_square_mm2 = 0.0;  ///< [mm²] of the errors
  std::vector<ErrorPart> parts;  ///< they add up to mean_square_mm2
};

/// How well simulated errors agree with those that were found. The common shift does not count.
struct Agreement {
  std::optional<double> correlation;        ///< Pearson's; empty: fewer than three seeds, or all errors are equal
  std::optional<double> explained_percent;  ///< 100 (1 − variance of the remainder / variance of the found error);
                                            ///< negative where the simulation makes it worse
};

/// The seeds that were found, beside those that were simulated.
struct FoundComparison {
  SeedMatching matching;           ///< its `dropped` are positions in ImplantHistory::seeds
  std::vector<MatchedSeed> seeds;  ///< one for each pair, in the order of the plan
  FoundErrors as_found;            ///< in the frame of the plan, as the file gives the places
  FoundErrors without_shift;       ///< after the common shift is taken away
  std::array<Agreement, 3> axes;   ///< x, y, z in LPS
  Agreement all;                   ///< of all three axes together
  /// The correlation that unrelated errors exceed, in size, in one of twenty implants; empty with fewer than three
  /// seeds.
  std::optional<double> correlation_by_chance;
};

/// Matches the seeds that were found with those that have come to rest in the simulation, and splits their errors.
/// Seeds that the simulation has lost are not matched.
FoundComparison compare_found(const ImplantHistory& history, const std::vector<FoundSeed>& found);

/// The plan with the seeds where they were found. A matched seed has the strength of its planned seed, and where the
/// images do not show its axis, the simulated axis; any other seed has the mean strength of the plan.
/// @param shift_mm [mm] LPS, taken away from each place
DosePlan found_plan(const DosePlan& plan, const ImplantHistory& history, const std::vector<FoundSeed>& found,
                    const FoundComparison& comparison, const Vec3& shift_mm = Vec3::Zero());

}  // namespace stylet
