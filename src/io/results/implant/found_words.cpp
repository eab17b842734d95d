// SPDX-License-Identifier: GPL-3.0-or-later
#include "fixed_number.hpp"
#include "implant/implant_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace stylet {
namespace {

using results::fixed;

/// At most so many seeds are named in a sentence; the tables have all.
constexpr std::size_t kNamedSeeds = 8;

std::string names_of(const std::vector<std::string>& names) {
  const std::vector<std::string> first(
      names.begin(), names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), kNamedSeeds)));
  return fmt::format("{}{}", fmt::join(first, ", "), names.size() > first.size() ? ", …" : "");
}

std::string match_sentence(const ImplantHistory& history, const FoundImplant& found) {
  const SeedMatching& matching = found.comparison.matching;
  std::vector<std::string> missing, extra;
  for (const std::size_t k : matching.not_found) missing.push_back(fmt::format("{}", history.seeds[k].number + 1));
  for (const std::size_t k : matching.extra) extra.push_back(found.seeds.seeds[k].where);
  const std::size_t dropped = matching.pairs.size() + missing.size();
  const std::size_t count = found.seeds.seeds.size();
  std::string text = fmt::format("{} seed{} found, and {} come{} to rest in the simulation; {} of them match{}.", count,
                                 count == 1 ? " was" : "s were", dropped, dropped == 1 ? "s" : "",
                                 matching.pairs.size(), matching.pairs.size() == 1 ? "es" : "");
  if (!missing.empty()) {
    text += fmt::format(
        " {} of the simulated seeds {} not found, lost or gone further than the match limit (no. {} of "
        "the plan).",
        missing.size(), missing.size() == 1 ? "was" : "were", names_of(missing));
  }
  if (!extra.empty()) {
    text += fmt::format(" {} of the found seeds {} no simulated seed ({}).", extra.size(),
                        extra.size() == 1 ? "matches" : "match", names_of(extra));
  }
  return text;
}

std::string ambiguity_sentence(const FoundComparison& comparison) {
  const auto ambiguous = std::count_if(comparison.matching.pairs.begin(), comparison.matching.pairs.end(),
                                       [](const SeedPair& pair) { return pair.ambiguous; });
  std::string text = fmt::format(
      "A match further apart than {:g} mm after the common shift is not believed, since the neighbour in the train is "
      "as "
      "near. ",
      kMatchLimit_mm);
  if (ambiguous == 0) return text + "No match is ambiguous.";
  return text + fmt::format("{} of the matches {} ambiguous: with another seed they would be nearly as likely.",
                            ambiguous, ambiguous == 1 ? "is" : "are");
}

std::string shift_sentence(const SeedMatching& matching) {
  const auto& error = matching.shift_error_mm;
  std::string text =
      fmt::format("The matched seeds have a common shift of {} mm against the simulation: {}, {} and {}",
                  fixed(matching.shift_mm.norm(), 1), results::toward_text(matching.shift_mm.x(), 0),
                  results::toward_text(matching.shift_mm.y(), 1), results::toward_text(matching.shift_mm.z(), 2));
  if (matching.pairs.size() < 2) return text + ".";
  text += fmt::format(" (standard errors {}, {} and {} mm). ", fixed(error.x(), 1), fixed(error.y(), 1),
                      fixed(error.z(), 1));
  return text +
         (matching.shift_beyond_chance()
              ? "This is more than chance makes it: the images have another frame than the plan, the gland lies "
                "otherwise, or all seeds went a way that the simulation does not know. The errors are given with "
                "it and without it."
              : "Chance alone may make it so large.");
}

std::string agreement_sentence(const FoundComparison& comparison) {
  const Agreement& all = comparison.all;
  if (!all.explained_percent) return "There are too few matches to say how much of the errors the simulation explains.";
  std::string text = "Without the common shift, ";
  text += *all.explained_percent > 0.0
              ? fmt::format("the simulation explains {} % of the variance of the errors found",
                            fixed(*all.explained_percent, 0))
              : std::string(
                    "the simulation explains nothing of the errors found: the seeds scatter more about their "
                    "simulated places than about their planned ones");
  if (all.correlation) {
    text += fmt::format(" (correlation {}; unrelated errors exceed ±{} in one of twenty implants)",
                        fixed(*all.correlation, 2), fixed(*comparison.correlation_by_chance, 2));
  }
  return text + ".";
}

}  // namespace

std::vector<std::string> found_sentences(const ImplantHistory& history, const FoundImplant& found) {
  std::vector<std::string> sentences{match_sentence(history, found)};
  if (found.comparison.seeds.empty()) return sentences;
  sentences.push_back(ambiguity_sentence(found.comparison));
  sentences.push_back(shift_sentence(found.comparison.matching));
  sentences.push_back(agreement_sentence(found.comparison));
  return sentences;
}

}  // namespace stylet
