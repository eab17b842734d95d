// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/dvh_picture.hpp"

#include "dose/round_number.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stylet::results {
namespace {

// Sizes of the picture in its own units.
constexpr double kLeft = 60, kTop = 20, kWide = 720, kHigh = 360, kKeyLine = 22;

/// The plot's frame, its lines at every 20 % and its ticks of dose.
std::string frame_of_picture(double most_Gy) {
  std::string svg;
  for (int percent = 0; percent <= 100; percent += 20) {
    const double y = kTop + kHigh * (1.0 - percent / 100.0);
    svg += fmt::format(
        "<path d=\"M{0} {1:.1f}h{2}\" stroke=\"#d9dce0\"/><text x=\"{3}\" y=\"{4:.1f}\" "
        "text-anchor=\"end\">{5}</text>",
        kLeft, y, kWide, kLeft - 8, y + 5, percent);
  }
  const double every = round_below(most_Gy / 4.0);
  for (double dose = 0.0; dose <= most_Gy; dose += every) {
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{:g}</text>", kLeft + kWide * dose / most_Gy,
                       kTop + kHigh + 20, dose);
  }
  return svg + fmt::format(
                   "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">Dose [Gy]</text><text transform=\"translate(16 {}) "
                   "rotate(-90)\" text-anchor=\"middle\">Volume [%]</text>",
                   kLeft + kWide / 2, kTop + kHigh + 42, kTop + kHigh / 2);
}

/// One histogram as a line. @param look further attributes of the line
std::string histogram_line(const std::vector<double>& dose_Gy, const std::vector<double>& percent,
                           const std::string& look) {
  std::string path;
  for (std::size_t k = 0; k < dose_Gy.size(); ++k) {
    path += fmt::format("{}{:.1f} {:.1f}", k == 0 ? "M" : "L", kLeft + kWide * dose_Gy[k] / dose_Gy.back(),
                        kTop + kHigh * (1.0 - percent[k] / 100.0));
  }
  return fmt::format("<path d=\"{}\" fill=\"none\" {}/>", path, look);
}

}  // namespace

std::string dvh_picture(const std::vector<StructureDose>& structures, const DvhTable& dvh,
                        const std::vector<std::string>& colours, const DvhTable* planned, const DvhTable* found) {
  if (structures.empty() || dvh.dose_Gy.size() < 2) return {};
  const double keys = kTop + kHigh + 62;
  std::string svg = fmt::format(
      "<svg class=\"dvh-picture\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"Dose–volume histograms\" "
      "font-size=\"14\">{}",
      kLeft + kWide + 20, keys + kKeyLine * static_cast<double>(structures.size()),
      frame_of_picture(dvh.dose_Gy.back()));
  for (std::size_t s = 0; s < structures.size(); ++s) {
    svg += histogram_line(dvh.dose_Gy, dvh.percent[s], fmt::format("stroke=\"{}\" stroke-width=\"2\"", colours[s]));
    for (const auto& [other, dashes] : {std::pair(planned, "7 5"), std::pair(found, "2 3")}) {
      if (!other) continue;
      svg +=
          histogram_line(other->dose_Gy, other->percent[s],
                         fmt::format("stroke=\"{}\" stroke-width=\"2\" stroke-dasharray=\"{}\"", colours[s], dashes));
    }
    const double y = keys + kKeyLine * static_cast<double>(s);
    svg += fmt::format(
        "<path d=\"M{1} {2:.1f}h30\" stroke=\"{0}\" stroke-width=\"3\"/><text x=\"{3}\" y=\"{4:.1f}\">{5}</text>",
        colours[s], kLeft, y, kLeft + 40, y + 5, html_escaped(structures[s].name));
  }
  return svg + "</svg>";
}

}  // namespace stylet::results
