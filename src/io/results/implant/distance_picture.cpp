// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/distance_picture.hpp"

#include "dose/round_number.hpp"
#include "implant/implant_words.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet::results {
namespace {

// Sizes of the picture in its own units.
constexpr double kDistanceLeft = 58, kDistanceWide = 470, kDistanceRight = 16, kDistanceTop = 10, kDistanceHigh = 260,
                 kDistanceKeyLine = 22;

std::vector<double> sorted_distances(const std::vector<SeedHistory>& seeds) {
  std::vector<double> distances;
  for (const SeedHistory& seed : seeds) {
    if (!seed.lost) distances.push_back(seed.error_mm().norm());
  }
  std::sort(distances.begin(), distances.end());
  return distances;
}

}  // namespace

std::string distance_picture(const std::vector<DistanceCurve>& curves) {
  std::vector<std::vector<double>> distances;
  double most = 0.0;
  for (const DistanceCurve& curve : curves) {
    distances.push_back(sorted_distances(*curve.seeds));
    if (!distances.back().empty()) most = std::max(most, distances.back().back());
  }
  if (!(most > 0.0)) return {};
  const double step = round_below(most / 4.0), end = 1.04 * most;
  const auto x = [&](double mm) { return kDistanceLeft + kDistanceWide * mm / end; };
  const auto y = [](double percent) { return kDistanceTop + kDistanceHigh * (1.0 - percent / 100.0); };
  const double keys = kDistanceTop + kDistanceHigh + 62;
  const ImplantNouns& nouns = nouns_of(implant_of(*curves.front().seeds));
  std::string svg = fmt::format(
      "<svg class=\"errors-picture distances\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"Share of the {} within "
      "a "
      "distance from plan\" font-size=\"14\">",
      kDistanceLeft + kDistanceWide + kDistanceRight, keys + kDistanceKeyLine * static_cast<double>(curves.size()),
      nouns.sources);
  for (int percent = 0; percent <= 100; percent += 25) {
    svg += fmt::format(
        "<path d=\"M{} {:.1f}h{}\" stroke=\"{}\"/><text class=\"tick\" x=\"{}\" y=\"{:.1f}\" "
        "text-anchor=\"end\">{}</text>",
        kDistanceLeft, y(percent), kDistanceWide, percent == 0 ? "#8a9099" : "#e6e8eb", kDistanceLeft - 7,
        y(percent) + 5, percent);
  }
  for (double mm = 0.0; mm <= end; mm += step) {
    svg += fmt::format("<text class=\"tick\" x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{:g}</text>", x(mm),
                       kDistanceTop + kDistanceHigh + 20, mm);
  }
  svg += fmt::format(
      "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">Distance from the planned place [mm]</text><text "
      "transform=\"translate(14 {}) rotate(-90)\" text-anchor=\"middle\">{} within it [%]</text>",
      kDistanceLeft + kDistanceWide / 2, kDistanceTop + kDistanceHigh + 42, kDistanceTop + kDistanceHigh / 2,
      capital(nouns.sources));
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const std::string look = fmt::format("stroke=\"{}\" stroke-width=\"2.5\" stroke-dasharray=\"{}\"", curves[k].colour,
                                         curves[k].dashes.empty() ? "none" : curves[k].dashes);
    std::string path = fmt::format("M{:.1f} {:.1f}", x(0.0), y(0.0));
    const auto count = static_cast<double>(distances[k].size());
    for (std::size_t n = 0; n < distances[k].size(); ++n)
      path += fmt::format("H{:.1f}V{:.1f}", x(distances[k][n]), y(100.0 * static_cast<double>(n + 1) / count));
    svg += fmt::format("<path d=\"{}H{:.1f}\" fill=\"none\" {}/>", path, x(end), look);
    const double line = keys + kDistanceKeyLine * static_cast<double>(k);
    svg += fmt::format("<path d=\"M{} {:.1f}h40\" {}/><text x=\"{}\" y=\"{:.1f}\">{}</text>", kDistanceLeft, line, look,
                       kDistanceLeft + 50, line + 5, html_escaped(curves[k].name));
  }
  return svg + "</svg>";
}

}  // namespace stylet::results
