// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/cause_picture.hpp"

#include "dose/round_number.hpp"
#include "implant/implant_words.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet::results {
namespace {

// Sizes of the picture in its own units.
constexpr double kCauseLeft = 92, kCauseWide = 306, kCauseRight = 62, kCauseTop = 8, kCauseBar = 15, kCauseLine = 19,
                 kCauseHead = 24, kCauseGap = 10;
constexpr const char* kCauseSizeColour = "#5b6169";
constexpr const char* kCauseAxisColour = "#0072b2";

/// The bars of one cause, or of all together.
struct CauseGroup {
  std::string name;
  double size_mm = 0.0;
  Vec3 mean_mm = Vec3::Zero();
};

std::vector<CauseGroup> cause_groups(const ImplantHistory& history) {
  const SeedErrors errors = seed_errors(history.seeds);
  std::vector<CauseGroup> groups;
  for (const CauseOfErrors& cause : causes_that_moved(history))
    groups.push_back({to_string(cause.cause), cause.mean_mm, cause.mean_vector_mm});
  if (groups.empty()) return groups;
  groups.push_back({"all causes together",
                    errors.mean_mm,
                    {errors.axes[0].mean_mm, errors.axes[1].mean_mm, errors.axes[2].mean_mm}});
  return groups;
}

/// Where lengths lie in the picture.
class CauseScale {
 public:
  explicit CauseScale(const std::vector<CauseGroup>& groups) {
    double most = 0.0, least = 0.0;
    for (const CauseGroup& group : groups) {
      most = std::max({most, group.size_mm, group.mean_mm.maxCoeff()});
      least = std::min(least, group.mean_mm.minCoeff());
    }
    step_ = round_below((most - least) / 3.0);
    low_ = 1.1 * least;
    high_ = step_ * std::ceil(most / step_);
  }
  [[nodiscard]] double at(double mm) const { return kCauseLeft + kCauseWide * (mm - low_) / (high_ - low_); }

  /// Vertical lines with numbers below, over the height of the picture.
  [[nodiscard]] std::string lines(double bottom) const {
    std::string svg;
    for (double k = std::ceil(low_ / step_); k <= high_ / step_ + 1e-6; ++k) {
      svg += fmt::format(
          "<path d=\"M{0:.1f} {1}V{2}\" stroke=\"{3}\"/><text class=\"tick\" x=\"{0:.1f}\" y=\"{4}\" "
          "text-anchor=\"middle\">{5}</text>",
          at(k * step_), kCauseTop, bottom, k == 0.0 ? "#8a9099" : "#e6e8eb", bottom + 17,
          (k < 0.0 ? "−" : "") + fmt::format("{:g}", std::abs(k * step_)));
    }
    return svg;
  }

 private:
  double low_ = 0.0, high_ = 1.0, step_ = 1.0;
};

std::string cause_bar(const CauseScale& scale, double top, const std::string& name, double mm, bool size) {
  const double from = scale.at(std::min(0.0, mm)), to = scale.at(std::max(0.0, mm));
  return fmt::format(
      "<text class=\"name\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text><rect x=\"{:.1f}\" y=\"{:.1f}\" "
      "width=\"{:.1f}\" height=\"{}\" fill=\"{}\"/><text class=\"figure\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>",
      kCauseLeft - 8, top + 12, name, from, top, std::max(to - from, 0.6), kCauseBar,
      size ? kCauseSizeColour : kCauseAxisColour, to + 6, top + 12,
      size ? fmt::format("{:.2f}", mm) : signed_number(mm, 2));
}

}  // namespace

std::string cause_picture(const ImplantHistory& history) {
  const std::vector<CauseGroup> groups = cause_groups(history);
  if (groups.empty()) return {};
  const CauseScale scale(groups);
  constexpr double kCauseGroupHigh = kCauseHead + 4 * kCauseLine + kCauseGap;
  const double bottom = kCauseTop + kCauseGroupHigh * static_cast<double>(groups.size());
  std::string svg = fmt::format(
      "<svg class=\"causes-picture\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"Size and direction of the causes "
      "of the errors\" font-size=\"14\">{}",
      kCauseLeft + kCauseWide + kCauseRight, bottom + 44, scale.lines(bottom));
  double top = kCauseTop;
  for (const CauseGroup& group : groups) {
    svg += fmt::format("<text class=\"group\" x=\"4\" y=\"{:.1f}\">{}</text>", top + 16, html_escaped(group.name));
    top += kCauseHead;
    svg += cause_bar(scale, top, "mean size", group.size_mm, true);
    for (std::size_t axis = 0; axis < 3; ++axis)
      svg += cause_bar(scale, top + kCauseLine * static_cast<double>(axis + 1), kToward[axis],
                       group.mean_mm[static_cast<Index>(axis)], false);
    top += 4 * kCauseLine + kCauseGap;
  }
  return svg + fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"middle\">Mean error [mm]</text></svg>",
                           kCauseLeft + kCauseWide / 2, bottom + 38);
}

}  // namespace stylet::results
