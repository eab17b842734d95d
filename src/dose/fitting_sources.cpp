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

}  // namespace

std::string isotope_name(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 16> elements{{{"i", "I"},
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
                                                                                           {"cobalt", "Co"},
                                                                                           {"au", "Au"},
                                                                                           {"gold", "Au"},
                                                                                           {"yb", "Yb"},
                                                                                           {"ytterbium", "Yb"}}};
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

std::string isotope_of(const SourceKind& kind) {
  std::string name = isotope_name(kind.isotope);
  if (name != kind.isotope || name.find('-') != std::string::npos) return name;
  for (const SourceModel& source : known_sources()) {
    if (std::abs(kind.half_life_days / source.half_life_days - 1.0) < kSameHalfLife) return source.isotope;
  }
  return {};
}

bool fits_length(const SourceKind& kind, const SourceModel& source) {
  return kind.source_length_mm <= 0.0 || std::abs(kind.source_length_mm - source.active_length_mm) <= kSameLength_mm ||
         std::abs(kind.source_length_mm - source.outer_length_mm) <= kSameLength_mm;
}

std::vector<SourceModel> fitting_sources(const SourceKind& kind) {
  const std::string isotope = isotope_of(kind);
  std::vector<SourceModel> of_isotope, of_length;
  for (const SourceModel& source : known_sources()) {
    if (!isotope.empty() && source.isotope != isotope) continue;
    of_isotope.push_back(source);
    if (fits_length(kind, source)) of_length.push_back(source);
  }
  return of_length.empty() ? of_isotope : of_length;
}

std::vector<SourceModel> fitting_sources(const DosePlan& plan) { return fitting_sources(source_kind(plan, 0)); }

Error unnamed_source(const DosePlan& plan, std::size_t number) {
  const SourceKind kind = source_kind(plan, number);
  std::string says;
  const std::string isotope = isotope_of(kind);
  if (!isotope.empty()) says += " " + isotope;
  if (kind.source_length_mm > 0.0) says += fmt::format(" of {:g} mm length", kind.source_length_mm);
  std::string list;
  for (const SourceModel& source : fitting_sources(kind)) {
    list += fmt::format("{}{} ({}, {}, active length {:g} mm)", list.empty() ? "" : "; ", source.name, source.title,
                        source.isotope, source.active_length_mm);
  }
  const bool several = kind_count(plan) > 1;
  const std::string what =
      fmt::format("the plan does not name the model of its sources{}; it says{}",
                  several ? fmt::format(" '{}'", kind.id) : "", says.empty() ? " nothing about them" : says);
  if (list.empty())
    return input_error(plan.file, what + ", and the program knows no such source",
                       several
                           ? fmt::format("Give a file with the source's TG-43 data (--source {}=FILE.json)", kind.id)
                           : "Give a file with the source's TG-43 data (--source FILE.json)");
  return input_error(plan.file, what,
                     (several ? fmt::format("Name the model with --source {}=NAME; these fit: ", kind.id)
                              : "Name the model with --source; these fit: ") +
                         list);
}

}  // namespace stylet
