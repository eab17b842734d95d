// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/round_number.hpp"
#include "fixed_number.hpp"
#include "implant/found_pictures.hpp"
#include "implant/implant_words.hpp"
#include "implant/third_mark.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet::results {
namespace {

// Sizes of a picture in its own units; the plot is a square.
constexpr double kScatterLeft = 54, kScatterRight = 12, kScatterTop = 10, kScatterSide = 340, kScatterBelow = 46;

/// The same range of millimetres along both axes of all pictures.
class ScatterScale {
 public:
  explicit ScatterScale(const FoundComparison& comparison) {
    double least = 0.0, most = 0.0;
    for (const MatchedSeed& matched : comparison.seeds) {
      least = std::min({least, matched.error_mm().minCoeff(), matched.seed.error_mm().minCoeff()});
      most = std::max({most, matched.error_mm().maxCoeff(), matched.seed.error_mm().maxCoeff()});
    }
    const double width = std::max(most - least, 1.0);
    step_ = round_below(width / 4.0);
    low_ = least - 0.04 * width;
    high_ = most + 0.04 * width;
  }
  [[nodiscard]] double x(double mm) const { return kScatterLeft + kScatterSide * (mm - low_) / (high_ - low_); }
  [[nodiscard]] double y(double mm) const { return kScatterTop + kScatterSide * (high_ - mm) / (high_ - low_); }

  /// Grid lines with numbers.
  [[nodiscard]] std::string grid() const {
    std::string svg;
    for (double k = std::ceil(low_ / step_); k * step_ <= high_; ++k) {
      const double mm = k * step_;
      const char* colour = k == 0.0 ? "#8a9099" : "#e6e8eb";
      const std::string number = (mm < 0.0 ? "−" : "") + fmt::format("{:g}", std::abs(mm));
      svg += fmt::format(
          "<path d=\"M{0:.1f} {1}v{2}M{3} {4:.1f}h{2}\" stroke=\"{5}\"/><text class=\"tick\" x=\"{0:.1f}\" "
          "y=\"{6}\" text-anchor=\"middle\">{7}</text><text class=\"tick\" x=\"{8}\" y=\"{9:.1f}\" "
          "text-anchor=\"end\">{7}</text>",
          x(mm), kScatterTop, kScatterSide, kScatterLeft, y(mm), colour, kScatterTop + kScatterSide + 20, number,
          kScatterLeft - 7, y(mm) + 5);
    }
    return svg;
  }

  /// The line found = simulated + shift, as far as it is in the picture.
  [[nodiscard]] std::string line(double shift_mm, const char* look) const {
    const double from = std::max(low_, low_ - shift_mm), to = std::min(high_, high_ - shift_mm);
    if (from >= to) return {};
    return fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" fill=\"none\" {}/>", x(from), y(from + shift_mm),
                       x(to), y(to + shift_mm), look);
  }

 private:
  double low_ = 0.0, high_ = 1.0, step_ = 1.0;
};

std::string scatter_picture(const ImplantHistory& history, const FoundComparison& comparison,
                            const std::vector<std::size_t>& thirds, const ScatterScale& scale, std::size_t axis) {
  const auto a = static_cast<Eigen::Index>(axis);
  std::string svg = fmt::format(
      "<svg class=\"errors-picture\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"Found over simulated errors "
      "to the {}\" font-size=\"14\">{}{}{}",
      kScatterLeft + kScatterSide + kScatterRight, kScatterTop + kScatterSide + kScatterBelow, kToward[axis],
      scale.grid(), scale.line(0.0, kEqualLine), scale.line(comparison.matching.shift_mm[a], kShiftedLine));
  svg += "<g class=\"marks\">";
  for (std::size_t k = 0; k < comparison.seeds.size(); ++k) {
    const MatchedSeed& matched = comparison.seeds[k];
    const double simulated = matched.seed.error_mm()[a], found = matched.error_mm()[a];
    svg += third_mark(scale.x(simulated), scale.y(found), thirds[comparison.matching.pairs[k].dropped],
                      fmt::format("Seed {}, needle {}: simulated {}, found {}{}", matched.seed.number + 1,
                                  history.needles[matched.seed.needle].name, toward_text(simulated, axis),
                                  toward_text(found, axis), matched.ambiguous ? " (ambiguous match)" : ""),
                      matched.ambiguous);
  }
  return svg + fmt::format(
                   "</g><text x=\"{}\" y=\"{}\" text-anchor=\"middle\">Simulated error [mm]</text><text "
                   "transform=\"translate(14 {}) rotate(-90)\" text-anchor=\"middle\">Found error [mm]</text><text "
                   "class=\"end\" x=\"{}\" y=\"{}\">{} ↑</text><text class=\"end\" x=\"{}\" y=\"{}\" "
                   "text-anchor=\"end\">{} →</text></svg>",
                   kScatterLeft + kScatterSide / 2, kScatterTop + kScatterSide + 41, kScatterTop + kScatterSide / 2,
                   kScatterLeft + 6, kScatterTop + 15, kToward[axis], kScatterLeft + kScatterSide - 5,
                   kScatterTop + kScatterSide - 7, kToward[axis]);
}

std::string agreement_caption(const Agreement& agreement) {
  if (!agreement.correlation) return {};
  return fmt::format("<span>correlation {}</span>",
                     (*agreement.correlation < 0.0 ? "−" : "") + fixed(std::abs(*agreement.correlation), 2));
}

}  // namespace

std::string found_scatters(const ImplantHistory& history, const FoundComparison& comparison) {
  constexpr std::array kCaptions{"Left and right", "Posterior and anterior", "Superior and inferior"};
  const std::vector<std::size_t> thirds = thirds_of(history);
  const ScatterScale scale(comparison);
  std::string html;
  for (std::size_t axis = 0; axis < kCaptions.size(); ++axis) {
    html += fmt::format("<figure><figcaption>{}{}</figcaption>{}</figure>", kCaptions[axis],
                        agreement_caption(comparison.axes[axis]),
                        scatter_picture(history, comparison, thirds, scale, axis));
  }
  return "<div class=\"scatters square\">" + html + "</div>";
}

}  // namespace stylet::results
