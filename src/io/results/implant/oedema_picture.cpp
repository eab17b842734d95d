// SPDX-License-Identifier: GPL-3.0-or-later
// Three plots over the days since the implant, one above the other.
#include "dose/round_number.hpp"
#include "fixed_number.hpp"
#include "implant/implant_words.hpp"
#include "implant/oedema_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace stylet::results {
namespace {

// Sizes of the picture in its own units.
constexpr double kOedemaLeft = 62, kOedemaWide = 560, kOedemaRight = 240, kOedemaTop = 30, kOedemaGap = 52;
constexpr const char* kOedemaSwollenColour = "#0072b2";
constexpr const char* kOedemaStillColour = "#5b6169";
/// The picture ends after this many half-lives of the sources, when 94 % of the dose is given.
constexpr double kOedemaHalfLives = 4.0;

/// A curve of a plot, with a label at its right end.
struct OedemaCurve {
  std::function<double(double days)> value;
  std::string label;
  std::string colour;
  std::string dashes = "none";
};

struct OedemaPlot {
  std::string title;
  double high = 0.0;  ///< height in units of the picture
  std::vector<OedemaCurve> curves;
};

std::vector<OedemaCurve> width_curves(const DoseCourse& course) {
  const Vec3& s = course.swelling.at_start;
  const auto width = [&course](Index axis) {
    return [&course, axis](double days) { return 100.0 * (course.swelling.factors(days)[axis] - 1.0); };
  };
  if ((s.array() == s.x()).all()) return {{width(0), "", kOedemaSwollenColour}};
  return {{width(0), "right to left", kOedemaSwollenColour},
          {width(1), "anterior to posterior", kOedemaSwollenColour, "7 4"},
          {width(2), "inferior to superior", kOedemaSwollenColour, "2 4"}};
}

/// Smallest and largest value of all curves, and 0.
std::array<double, 2> range_of(const OedemaPlot& plot, const std::vector<double>& days) {
  double low = 0.0, high = 0.0;
  for (const OedemaCurve& curve : plot.curves) {
    for (const double day : days) {
      low = std::min(low, curve.value(day));
      high = std::max(high, curve.value(day));
    }
  }
  return {low, high > low ? high : low + 1.0};
}

/// Draws a plot whose upper edge is at `top`. @param days at which the curves are drawn
std::string oedema_plot(const OedemaPlot& plot, double top, const std::vector<double>& days) {
  const double end = days.back();
  const auto [low, high] = range_of(plot, days);
  const double step = round_below((high - low) / (plot.high > 150.0 ? 3.0 : 2.0));
  const double first = step * std::floor(low / step + 1e-9), last = step * std::ceil(high / step - 1e-9);
  const auto x = [&](double day) { return kOedemaLeft + kOedemaWide * day / end; };
  const auto y = [&](double value) { return top + plot.high * (last - value) / (last - first); };
  std::string svg =
      fmt::format("<text class=\"group\" x=\"{}\" y=\"{:.1f}\">{}</text>", kOedemaLeft, top - 11, plot.title);
  for (double k = std::round(first / step); k <= last / step + 1e-6; ++k) {
    svg += fmt::format(
        "<path d=\"M{} {:.1f}h{}\" stroke=\"{}\"/><text class=\"tick\" x=\"{}\" y=\"{:.1f}\" "
        "text-anchor=\"end\">{}{:g}</text>",
        kOedemaLeft, y(k * step), kOedemaWide, k == 0.0 ? "#8a9099" : "#e6e8eb", kOedemaLeft - 8, y(k * step) + 5,
        k < 0.0 ? "−" : "", std::abs(k * step));
  }
  // Labels keep a line's height between them, from the highest down.
  std::vector<const OedemaCurve*> by_height;
  for (const OedemaCurve& curve : plot.curves) by_height.push_back(&curve);
  std::sort(by_height.begin(), by_height.end(),
            [&](const OedemaCurve* a, const OedemaCurve* b) { return a->value(end) > b->value(end); });
  double free_from = -INFINITY;
  for (const OedemaCurve* curve : by_height) {
    std::string path;
    for (const double day : days)
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x(day), y(curve->value(day)));
    svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2.2\" stroke-dasharray=\"{}\"/>",
                       path, curve->colour, curve->dashes);
    if (curve->label.empty()) continue;
    const double line = std::max(y(curve->value(end)) + 5, free_from);
    free_from = line + 17;
    svg += fmt::format("<text class=\"curve\" x=\"{}\" y=\"{:.1f}\" style=\"fill:{}\">{}</text>",
                       kOedemaLeft + kOedemaWide + 8, line, curve->colour, curve->label);
  }
  return svg;
}

/// Ticks and name of the axis of days below the last plot.
std::string axis_of_days(double bottom, double end) {
  std::string svg;
  const double step = end > 200.0 ? 30.0 * std::max(1.0, std::round(end / 240.0)) : round_below(end / 5.0);
  for (double day = 0.0; day <= end; day += step) {
    svg += fmt::format("<text class=\"tick\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{:g}</text>",
                       kOedemaLeft + kOedemaWide * day / end, bottom + 20, day);
  }
  return svg + fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"middle\">Days since the implant</text>",
                           kOedemaLeft + kOedemaWide / 2, bottom + 42);
}

}  // namespace

std::string oedema_picture(const DoseCourse& course) {
  const double end = kOedemaHalfLives * course.half_life_days;
  std::vector<double> days;
  constexpr int kParts = 120;
  for (int k = 0; k <= kParts; ++k) days.push_back(end * k / kParts);
  const DoseMoment& last = course.moments.back();
  const bool adds = last.taken_away_Gy() < 0.0;
  const auto in_the_end = [](const char* name, double Gy, int digits) {
    return fmt::format("{}{} Gy in the end", name, fixed(Gy, digits));
  };
  const std::array<OedemaPlot, 3> plots{
      OedemaPlot{"Width of the gland beyond its width without swelling [%]", 90, width_curves(course)},
      OedemaPlot{"D90 of the target so far [Gy]",
                 210,
                 {{[&](double day) { return course.at(day).d90_Gy; }, in_the_end("with swelling: ", last.d90_Gy, 0),
                   kOedemaSwollenColour},
                  {[&](double day) { return course.at(day).d90_without_swelling_Gy; },
                   in_the_end("without: ", last.d90_without_swelling_Gy, 0), kOedemaStillColour, "7 4"}}},
      OedemaPlot{adds ? "Added to D90 by the swelling so far [Gy]" : "Taken away from D90 by the swelling so far [Gy]",
                 90,
                 {{[&](double day) { return std::abs(course.at(day).taken_away_Gy()); },
                   in_the_end("", std::abs(last.taken_away_Gy()), 1), kOedemaSwollenColour}}}};
  double top = kOedemaTop;
  std::string svg;
  for (const OedemaPlot& plot : plots) {
    svg += oedema_plot(plot, top, days);
    top += plot.high + kOedemaGap;
  }
  const double bottom = top - kOedemaGap;
  return fmt::format(
             "<svg class=\"errors-picture\" viewBox=\"0 0 {} {:.1f}\" role=\"img\" aria-label=\"Width of the gland and "
             "D90 of the target over the days since the implant, with and without swelling\" font-size=\"14\">",
             kOedemaLeft + kOedemaWide + kOedemaRight, bottom + 50) +
         svg + axis_of_days(bottom, end) + "</svg>";
}

}  // namespace stylet::results
