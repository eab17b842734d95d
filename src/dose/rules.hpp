// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/plan_rules.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Parts of the rules for plans: their names and bounds, and what they find.
namespace stylet::dose {

/// The rules, in the order of the table.
enum class Rule {
  isotope_and_model,
  isotope_known,
  half_life,
  source_length,
  seed_strength,
  afterloader_strength,
  low_rate_strength,
  equal_strengths,
  isotope_and_implant,
  type_and_technique,
  dwell_of_permanent,
  dwell_missing,
  channel_time,
  channel_weights,
  control_points,
  implant_time,
  pulses,
  total_kerma,
  prescription,
  prescription_missing,
  prescriptions_differ,
  fractions,
  dates,
  unused_source,
  same_place,
  overlap,
  extent,
  far_from_target,
  other_patient,
  number_of_sources,
  target,
  not_computed,
  target_dose,
  count
};

/// A range of plausible numbers inside a range of possible ones.
struct Range {
  double least, low, high, most;
  [[nodiscard]] bool possible(double x) const { return x >= least && x <= most; }
  [[nodiscard]] bool plausible(double x) const { return x >= low && x <= high; }
};

inline constexpr Range kAfterloader_U{500.0, 5000.0, 70000.0, 200000.0};
inline constexpr Range kPulsed_U{50.0, 500.0, 10000.0, 50000.0};
inline constexpr Range kLowRate_U{0.01, 0.1, 200.0, 1000.0};
inline constexpr Range kPermanent_Gy{5.0, 40.0, 200.0, 1000.0};
inline constexpr Range kFraction_Gy{0.5, 2.0, 50.0, 200.0};
inline constexpr Range kHighRate_s{0.0, 30.0, 3600.0, 21600.0};
inline constexpr Range kTargetShare{0.0, 0.5, 2.0, 10.0};  ///< D90 of the target over the prescription
inline constexpr Range kTarget_cc{0.0, 3.0, 250.0, 1e9};
inline constexpr double kStrengthRatio = 3.0;
inline constexpr double kSameHalfLife = 0.002, kOtherHalfLife = 0.1;  ///< relative
inline constexpr double kSameWeights = 0.005;
inline constexpr double kSameKerma = 0.1;
inline constexpr double kPlanBefore_days = 90.0;
inline constexpr double kSamePlace_mm = 0.01;
inline constexpr double kFarFromTarget_mm = 15.0, kBesideTarget_mm = 5.0, kOtherPatient_mm = 30.0;
inline constexpr double kWidest_mm = 150.0, kNarrowest_mm = 10.0;
inline constexpr std::size_t kManySeeds = 300, kManyDwells = 2000, kFewSeeds = 5;

/// An isotope of brachytherapy.
struct Nuclide {
  std::string_view name;
  double half_life_days;
  Range seed_U;      ///< strength of one seed
  bool is_of_seeds;  ///< whether its sources stay, usually
};
/// Empty: the isotope is not in the table.
std::optional<Nuclide> nuclide(std::string_view isotope);
/// The table, for documents.
std::span<const Nuclide> nuclides();

/// Findings of the rules in a plan.
class Findings {
 public:
  void warn(Rule rule, std::string sentence);
  void refuse(Rule rule, const std::string& where, const std::string& what, const std::string& cure);
  [[nodiscard]] bool refused() const { return error_.has_value(); }
  /// The sentences, or the first error.
  Result<std::vector<std::string>> result();

 private:
  std::vector<std::string> sentences_;
  std::optional<Error> error_;
};

/// The plan that is judged, with its models and structures.
struct Judged {
  const DosePlan& plan;
  std::span<const SourceModel> models;
  std::span<const DoseStructure> structures;
  const DoseOptions& options;

  [[nodiscard]] bool temporary() const { return plan.implant == Implant::temporary; }
  /// Whether an afterloader moves one strong source: the plan says so, or isotope and times.
  [[nodiscard]] bool is_high_rate() const;
};

void judge_sources(const Judged& judged, Findings& found);       ///< isotopes, models, strengths
void judge_times(const Judged& judged, Findings& found);         ///< type, technique, channels, times
void judge_prescription(const Judged& judged, Findings& found);  ///< prescription, fractions, dates
void judge_places(const Judged& judged, Findings& found);        ///< places of sources and target

}  // namespace stylet::dose
