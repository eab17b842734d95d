// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/structure_look.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace stylet::results {
namespace {

using Rgb = std::array<int, 3>;
constexpr Rgb kNoColour{128, 128, 128};

// Okabe & Ito, "Color universal design", 2008; the last two are darker variants of sky blue and yellow.
constexpr std::array<std::pair<const char*, Rgb>, 4> kRegionColours{
    {{"prostate", {213, 94, 0}}, {"urethra", {138, 118, 0}}, {"rectum", {170, 77, 138}}, {"bladder", {0, 114, 178}}}};
constexpr std::array<Rgb, 7> kFreeColours{
    {{0, 158, 115}, {0, 114, 178}, {204, 121, 167}, {230, 159, 0}, {86, 180, 233}, {120, 94, 240}, {90, 90, 90}}};

/// Relative luminance, 0 … 1.
double luminance(const Rgb& colour) {
  const auto linear = [](int part) { return std::pow(std::clamp(part, 0, 255) / 255.0, 2.2); };
  return 0.2126 * linear(colour[0]) + 0.7152 * linear(colour[1]) + 0.0722 * linear(colour[2]);
}

/// The colour as dark as a line on white needs to be: its contrast is 3 : 1 or more.
Rgb legible(Rgb colour) {
  constexpr double kLightest = 0.28;
  while (luminance(colour) > kLightest) {
    for (int& part : colour) part = part * 9 / 10;
  }
  return colour;
}

double distance(const Rgb& a, const Rgb& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

bool is_free(const Rgb& colour, const std::vector<Rgb>& used) {
  constexpr double kSame = 60.0;
  return std::none_of(used.begin(), used.end(), [&](const Rgb& other) { return distance(colour, other) < kSame; });
}

Rgb choose(const StructureDose& structure, const std::vector<Rgb>& used) {
  std::vector<Rgb> wishes;
  if (structure.colour != kNoColour) wishes.push_back(structure.colour);
  for (const auto& [region, colour] : kRegionColours) {
    if (structure.region == region) wishes.push_back(colour);
  }
  wishes.insert(wishes.end(), kFreeColours.begin(), kFreeColours.end());
  for (const Rgb& wish : wishes) {
    if (is_free(legible(wish), used)) return legible(wish);
  }
  return legible(kFreeColours[used.size() % kFreeColours.size()]);
}

}  // namespace

std::vector<std::string> structure_colours(const std::vector<StructureDose>& structures) {
  std::vector<Rgb> used;
  std::vector<std::string> colours;
  for (const StructureDose& structure : structures) {
    const Rgb colour = choose(structure, used);
    used.push_back(colour);
    colours.push_back(fmt::format("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2]));
  }
  return colours;
}

bool surrounds_others(const StructureDose& structure) {
  constexpr double kLarge_cc = 1500.0;
  return structure.type == "EXTERNAL" || structure.dvh.volume_cc() > kLarge_cc;
}

const StructureDose* find_region(const DoseEvaluation& evaluation, const std::string& region) {
  const auto found = std::find_if(evaluation.structures.begin(), evaluation.structures.end(),
                                  [&](const StructureDose& s) { return s.region == region; });
  return found == evaluation.structures.end() ? nullptr : &*found;
}

}  // namespace stylet::results
