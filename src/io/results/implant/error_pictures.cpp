// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/error_pictures.hpp"

#include "dose/round_number.hpp"
#include "implant/implant_words.hpp"
#include "implant/third_mark.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet::results {
namespace {

// Sizes of a picture in its own units.
constexpr double kErrorLeft = 60, kErrorRight = 10, kErrorTop = 10, kErrorWide = 396, kErrorHigh = 250,
                 kErrorBelow = 46;

/// A range of numbers with round ticks.
struct ErrorRange {
  double low = 0.0, high = 1.0, step = 1.0;

  ErrorRange(double least, double most, double ticks) {
    const double width = std::max(most - least, 1.0);
    step = round_below(width / ticks);
    low = least - 0.04 * width;
    high = most + 0.04 * width;
  }
  [[nodiscard]] double share(double value) const { return (value - low) / (high - low); }
  [[nodiscard]] std::vector<double> ticks() const {
    std::vector<double> values;
    for (double k = std::ceil(low / step); k * step <= high; ++k) values.push_back(k * step);
    return values;
  }
};

struct ErrorScales {
  ErrorRange z, error;

  explicit ErrorScales(const std::vector<SeedHistory>& seeds) : z(range_of_z(seeds)), error(range_of_errors(seeds)) {}
  [[nodiscard]] double x(double z_mm) const { return kErrorLeft + kErrorWide * z.share(z_mm); }
  [[nodiscard]] double y(double error_mm) const { return kErrorTop + kErrorHigh * (1.0 - error.share(error_mm)); }
  /// The nearest error that the picture shows.
  [[nodiscard]] double shown(double error_mm) const { return std::clamp(error_mm, error.low, error.high); }

 private:
  static ErrorRange range_of_z(const std::vector<SeedHistory>& seeds) {
    const auto lower = [](const SeedHistory& a, const SeedHistory& b) { return a.planned_mm.z() < b.planned_mm.z(); };
    const auto [least, most] = std::minmax_element(seeds.begin(), seeds.end(), lower);
    return {least->planned_mm.z(), most->planned_mm.z(), 5.0};
  }
  /// Single seeds far from the others do not decide the scale.
  static ErrorRange range_of_errors(const std::vector<SeedHistory>& seeds) {
    const double limit = 2.0 * seed_errors(seeds).p95_mm;
    double least = 0.0, most = 0.0;
    for (const SeedHistory& seed : seeds) {
      if (seed.lost) continue;
      least = std::max(-limit, std::min(least, seed.error_mm().minCoeff()));
      most = std::min(limit, std::max(most, seed.error_mm().maxCoeff()));
    }
    return {least, most, 5.0};
  }
};

std::string error_tick(double value) { return with_minus_signs(fmt::format("{:g}", value == 0.0 ? 0.0 : value)); }

std::string error_frame(const ErrorScales& scales, std::size_t axis) {
  std::string svg;
  for (const double mm : scales.error.ticks()) {
    svg += fmt::format(
        "<path d=\"M{} {:.1f}h{}\" stroke=\"{}\"/><text class=\"tick\" x=\"{}\" y=\"{:.1f}\" "
        "text-anchor=\"end\">{}</text>",
        kErrorLeft, scales.y(mm), kErrorWide, mm == 0.0 ? "#8a9099" : "#e6e8eb", kErrorLeft - 7, scales.y(mm) + 5,
        error_tick(mm));
  }
  for (const double mm : scales.z.ticks()) {
    svg += fmt::format(
        "<path d=\"M{0:.1f} {1}v5\" stroke=\"#8a9099\"/><text class=\"tick\" x=\"{0:.1f}\" y=\"{2}\" "
        "text-anchor=\"middle\">{3}</text>",
        scales.x(mm), kErrorTop + kErrorHigh, kErrorTop + kErrorHigh + 20, error_tick(mm));
  }
  return svg + fmt::format(
                   "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">Planned position, inferior to superior [mm]</text>"
                   "<text transform=\"translate(15 {}) rotate(-90)\" text-anchor=\"middle\">← {} · Error [mm] · {} →"
                   "</text>",
                   kErrorLeft + kErrorWide / 2, kErrorTop + kErrorHigh + 41, kErrorTop + kErrorHigh / 2, kAgainst[axis],
                   kToward[axis]);
}

std::string error_picture(const ImplantHistory& history, const std::vector<std::size_t>& thirds,
                          const ErrorScales& scales, std::size_t axis) {
  std::string svg = fmt::format(
      "<svg class=\"errors-picture\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"Errors to the {} over "
      "the planned position\" font-size=\"14\">{}<g class=\"marks\">",
      kErrorLeft + kErrorWide + kErrorRight, kErrorTop + kErrorHigh + kErrorBelow, kToward[axis],
      error_frame(scales, axis));
  for (std::size_t k = 0; k < history.seeds.size(); ++k) {
    const SeedHistory& seed = history.seeds[k];
    if (seed.lost) continue;
    const double error = seed.error_mm()[static_cast<Index>(axis)];
    const double shown = scales.shown(error);
    svg +=
        third_mark(scales.x(seed.planned_mm.z()), scales.y(shown), thirds[k],
                   fmt::format("{} {}, {} {}: {}", capital(nouns_of(history).source), seed.number + 1,
                               nouns_of(history).needle, history.needles[seed.needle].name, toward_text(error, axis)),
                   shown != error);
  }
  return svg + "</g></svg>";
}

/// A sentence about the seeds that lie beyond the scale; empty where there are none.
std::string beyond_scale(const std::vector<SeedHistory>& seeds, const ErrorScales& scales) {
  std::size_t beyond = 0;
  for (const SeedHistory& seed : seeds) {
    const Vec3 error = seed.error_mm();
    const auto inside = [&](double mm) { return scales.shown(mm) == mm; };
    if (!seed.lost && !(inside(error.x()) && inside(error.y()) && inside(error.z()))) ++beyond;
  }
  if (beyond == 0) return {};
  const ImplantNouns& nouns = nouns_of(implant_of(seeds));
  return fmt::format(
      "<p class=\"note\">Open marks at the edge stand for errors beyond the scale; {} {} one. The table of {} has "
      "them.</p>",
      beyond, beyond == 1 ? fmt::format("{} has such", nouns.source) : fmt::format("{} have such", nouns.sources),
      nouns.sources);
}

}  // namespace

std::string error_pictures(const ImplantHistory& history) {
  constexpr std::array kCaptions{"Left and right", "Posterior and anterior", "Superior and inferior"};
  if (seed_errors(history.seeds).seeds == 0) return "<p class=\"note\">No seed is left in the patient.</p>";
  const std::vector<std::size_t> thirds = thirds_of(history);
  const ErrorScales scales(history.seeds);
  std::string html;
  for (std::size_t axis = 0; axis < kCaptions.size(); ++axis) {
    html += fmt::format("<figure><figcaption>{}</figcaption>{}</figure>", kCaptions[axis],
                        error_picture(history, thirds, scales, axis));
  }
  return "<div class=\"scatters\">" + html + "</div>" + beyond_scale(history.seeds, scales);
}

std::string third_key(const ImplantHistory& history) {
  const std::vector<std::size_t> thirds = thirds_of(history);
  std::string html;
  for (std::size_t third = 0; third < kThirds.size(); ++third) {
    const auto seeds = std::count(thirds.begin(), thirds.end(), third);
    if (seeds == 0) continue;
    html += fmt::format(
        "<span><svg width=\"14\" height=\"14\" viewBox=\"0 0 14 14\" aria-hidden=\"true\">{}</svg>{} ({})</span>",
        third_mark(7, 7, third, kThirds[third]), kThirds[third], seeds);
  }
  return html;
}

}  // namespace stylet::results
