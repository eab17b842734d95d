// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/dose/fitting_sources.hpp"

#include "stylet/dose/known_sources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

namespace stylet {

namespace {

constexpr double kSameLength_mm = 0.5;
constexpr double kSameHalfLife = 0.02;  // relative

bool fits_length(const DosePlan& plan, const SourceModel& source) {
  return plan.source_length_mm <= 0.0 || std::abs(plan.source_length_mm - source.active_length_mm) <= kSameLength_mm ||
         std::abs(plan.source_length_mm - source.outer_length_mm) <= kSameLength_mm;
}

/// The isotope of a plan: by its name, or where that is none (in files without identities, for example), by the
/// half-life. Empty: unknown.
std::string isotope_of(const DosePlan& plan) {
  std::string name = isotope_name(plan.isotope);
  if (name != plan.isotope || name.find('-') != std::string::npos) return name;
  for (const SourceModel& source : known_sources()) {
    if (std::abs(plan.half_life_days / source.half_life_days - 1.0) < kSameHalfLife) return source.isotope;
  }
  return {};
}

}  // namespace

std::string isotope_name(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 12> elements{{{"i", "I"},
                                                                                           {"iodine", "I"},
                                                                                           {"iod", "I"},
                                                                                           {"pd", "Pd"},
                                                                                           {"palladium", "Pd"},
                                                                                           {"cs", "Cs"},
                                                                                           {"cesium", "Cs"},
                                                                                           {"caesium", "Cs"},
                                                                                           {"ir", "Ir"},
                                                                                           {"iridium", "Ir"},
                                                                                           {"co", "Co"},
                                                                                           {"cobalt", "Co"}}};
  std::string letters, digits;
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalpha(u) != 0) letters += static_cast<char>(std::tolower(u));
    if (std::isdigit(u) != 0) digits += c;
  }
  const auto element =
      std::find_if(elements.begin(), elements.end(), [&](const auto& e) { return e.first == letters; });
  if (element == elements.end() || digits.empty()) return std::string(text);
  return fmt::format("{}-{}", element->second, digits);
}

std::vector<SourceModel> fitting_sources(const DosePlan& plan) {
  const std::string isotope = isotope_of(plan);
  std::vector<SourceModel> of_isotope, of_length;
  for (const SourceModel& source : known_sources()) {
    if (!isotope.empty() && source.isotope != isotope) continue;
    of_isotope.push_back(source);
    if (fits_length(plan, source)) of_length.push_back(source);
  }
  return of_length.empty() ? of_isotope : of_length;
}

Error unnamed_source(const DosePlan& plan) {
  std::string says;
  const std::string isotope = isotope_of(plan);
  if (!isotope.empty()) says += " " + isotope;
  if (plan.source_length_mm > 0.0) says += fmt::format(" of {:g} mm length", plan.source_length_mm);
  std::string list;
  for (const SourceModel& source : fitting_sources(plan)) {
    list += fmt::format("{}{} ({}, {}, active length {:g} mm)", list.empty() ? "" : "; ", source.name, source.title,
                        source.isotope, source.active_length_mm);
  }
  const std::string what = fmt::format("the plan does not name the model of its sources; it says{}",
                                       says.empty() ? " nothing about them" : says);
  if (list.empty())
    return input_error(plan.file, what + ", and the program knows no such source",
                       "Give a file with the source's TG-43 data (--source FILE.json)");
  return input_error(plan.file, what, "Name the model with --source; these fit: " + list);
}

Result<std::vector<std::string>> compare_source(const DosePlan& plan, const SourceModel& source) {
  const std::string isotope = isotope_of(plan);
  if (!isotope.empty() && !source.isotope.empty() && isotope != isotope_name(source.isotope)) {
    return input_error(
        plan.file,
        fmt::format("the plan's sources are {}, and the source model {} is {}", isotope, source.name, source.isotope),
        fmt::format("Name a source model of {} (--source)", isotope));
  }
  std::vector<std::string> sentences;
  if (plan.half_life_days > 0.0 && std::abs(plan.half_life_days / source.half_life_days - 1.0) > 0.002) {
    sentences.push_back(
        fmt::format("The plan says a half-life of {:.6g} d, the source model {} has {:.6g} d; the model's is used.",
                    plan.half_life_days, source.name, source.half_life_days));
  }
  if (!fits_length(plan, source)) {
    sentences.push_back(fmt::format(
        "The plan says a source of {:g} mm length; {} is {:g} mm long with an active part of {:g} mm. Check the model.",
        plan.source_length_mm, source.name, source.outer_length_mm, source.active_length_mm));
  }
  return sentences;
}

}  // namespace stylet
