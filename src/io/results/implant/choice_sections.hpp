// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/implant_results.hpp"

#include <string>
#include <vector>

/// The sections of the page about the same implant under other choices.
namespace stylet::results {

/// The implant under one choice.
struct ImplantChoice {
  std::string name;  ///< as a heading, "Firm tissue"
  const ImplantHistory* history = nullptr;
  const DoseEvaluation* dose = nullptr;
};

/// A section that compares choices.
struct ChoiceSection {
  const char* id;
  const char* heading;
  const char* intro;  ///< HTML
  std::vector<ImplantChoice> choices;
};

/// Before and after the needles were aimed to make up for the errors, where they were; in firm, typical and soft
/// tissue, where a span was asked for. The choices point into the outcome.
std::vector<ChoiceSection> choice_sections(const ImplantOutcome& outcome);

/// A section as HTML, with the place of its chart (web/report/src/implant/charts.ts).
std::string choice_html(const ChoiceSection& section, const ImplantOutcome& outcome);

}  // namespace stylet::results
