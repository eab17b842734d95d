// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/implant_results.hpp"

#include <array>
#include <string>
#include <vector>

/// The words and colours of the page of `stylet implant`.
namespace stylet::results {

/// The directions along the axes of LPS, and their opposites.
inline constexpr std::array<const char*, 3> kToward{"left", "posterior", "superior"};
inline constexpr std::array<const char*, 3> kAgainst{"right", "anterior", "inferior"};

/// Colours of the thirds base, mid and apex. Marks of different shapes stand for them too.
inline constexpr std::array<const char*, 3> kThirdColours{"#0072b2", "#00805d", "#b5179e"};

/// The nouns for the parts of an implant: seeds and needles, or dwell positions and catheters.
struct ImplantNouns {
  const char* source;
  const char* sources;
  const char* needle;
  const char* needles;
};
const ImplantNouns& nouns_of(Implant implant);
const ImplantNouns& nouns_of(const ImplantHistory& history);

/// A noun at the start of a sentence or in a heading.
std::string capital(std::string noun);

/// A signed number with a decimal minus sign that is as wide as the plus sign; zero has no sign.
std::string signed_number(double value, int digits);

/// A signed length with its direction instead of a sign: "1.2 mm to inferior". @param axis 0 … 2
std::string toward_text(double value_mm, std::size_t axis);

/// The causes that moved a seed.
std::vector<CauseOfErrors> causes_that_moved(const ImplantHistory& history);

/// A sentence about the causes that moved no seed; empty where each moved one.
std::string causes_left_out(const ImplantHistory& history);

/// The plan, its delivery and the causes of the difference, in a few sentences: paragraphs, as HTML.
std::string implant_story(const ImplantOutcome& outcome);

/// Whether the gland swells, so that the dose differs from that of the plan for this reason too.
bool has_oedema(const Scenario& scenario);

}  // namespace stylet::results
