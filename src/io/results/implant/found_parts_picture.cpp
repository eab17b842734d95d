// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/round_number.hpp"
#include "fixed_number.hpp"
#include "implant/found_pictures.hpp"
#include "implant/implant_words.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet::results {
namespace {

// Sizes of the picture in its own units.
constexpr double kPartsLeft = 168, kPartsWide = 260, kPartsRight = 118, kPartsTop = 8, kPartsBar = 15, kPartsLine = 19,
                 kPartsHead = 24, kPartsGap = 10;
constexpr const char* kAsFoundColour = "#5b6169";
constexpr const char* kWithoutShiftColour = "#0072b2";
constexpr double kPartOfNothing_mm2 = 5e-4;  // parts below it are left out, as by their two decimals

/// The bars of one part.
struct PartBars {
  std::string name;
  const ErrorPart* as_found = nullptr;
  const ErrorPart* without_shift = nullptr;
};

std::vector<PartBars> bars_of_parts(const FoundComparison& comparison) {
  std::vector<PartBars> bars;
  for (const ErrorPart& part : comparison.as_found.parts) {
    PartBars one{.name = part.name, .as_found = &part};
    for (const ErrorPart& other : comparison.without_shift.parts) {
      if (other.name == part.name) one.without_shift = &other;
    }
    const double other = one.without_shift ? one.without_shift->mean_mm2 : 0.0;
    if (std::max(std::abs(part.mean_mm2), std::abs(other)) > kPartOfNothing_mm2) bars.push_back(one);
  }
  return bars;
}

}  // namespace

std::string found_parts_picture(const FoundComparison& comparison) {
  const std::vector<PartBars> bars = bars_of_parts(comparison);
  if (bars.empty()) return {};
  double least = 0.0, most = 0.0;
  for (const PartBars& one : bars) {
    for (const ErrorPart* part : {one.as_found, one.without_shift}) {
      if (!part) continue;
      least = std::min(least, part->mean_mm2);
      most = std::max(most, part->mean_mm2);
    }
  }
  const double step = round_below((most - least) / 3.0);
  const double low = 1.1 * least, high = std::max(step, step * std::ceil(most / step));
  const auto x = [&](double mm2) { return kPartsLeft + kPartsWide * (mm2 - low) / (high - low); };
  const double bottom = kPartsTop + static_cast<double>(bars.size()) * (kPartsHead + 2 * kPartsLine + kPartsGap);
  std::string svg = fmt::format(
      "<svg class=\"causes-picture\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"Parts of the mean square "
      "of the errors found\" font-size=\"14\">",
      kPartsLeft + kPartsWide + kPartsRight, bottom + 44);
  for (double k = std::ceil(low / step); k <= high / step + 1e-6; ++k) {
    svg += fmt::format(
        "<path d=\"M{0:.1f} {1}V{2}\" stroke=\"{3}\"/><text class=\"tick\" x=\"{0:.1f}\" y=\"{4}\" "
        "text-anchor=\"middle\">{5}</text>",
        x(k * step), kPartsTop, bottom, k == 0.0 ? "#8a9099" : "#e6e8eb", bottom + 17,
        (k < 0.0 ? "−" : "") + fmt::format("{:g}", std::abs(k * step)));
  }
  double top = kPartsTop;
  const auto bar = [&](const char* name, const ErrorPart* part, const char* colour) {
    svg += fmt::format("<text class=\"name\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>", kPartsLeft - 8,
                       top + 12, name);
    if (part) {
      const double from = x(std::min(0.0, part->mean_mm2)), to = x(std::max(0.0, part->mean_mm2));
      const std::string percent = signed_number(part->percent, 0);
      svg += fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{}\" fill=\"{}\"/><text class=\"figure\" "
          "x=\"{:.1f}\" y=\"{:.1f}\">{} ({} %)</text>",
          from, top, std::max(to - from, 0.6), kPartsBar, colour, to + 6, top + 12, signed_number(part->mean_mm2, 2),
          percent);
    } else {
      svg += fmt::format("<text class=\"name\" x=\"{:.1f}\" y=\"{:.1f}\">taken away</text>", x(0.0) + 6, top + 12);
    }
    top += kPartsLine;
  };
  for (const PartBars& one : bars) {
    svg += fmt::format("<text class=\"group\" x=\"4\" y=\"{:.1f}\">{}</text>", top + 16, html_escaped(one.name));
    top += kPartsHead;
    bar("as found", one.as_found, kAsFoundColour);
    bar("without common shift", one.without_shift, kWithoutShiftColour);
    top += kPartsGap;
  }
  return svg + fmt::format(
                   "<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"middle\">Part of the mean square error "
                   "[mm²]</text></svg>",
                   kPartsLeft + kPartsWide / 2, bottom + 38);
}

}  // namespace stylet::results
