// SPDX-License-Identifier: GPL-3.0-or-later
#include "sensitivity_page.hpp"

#include "report/text.hpp"
#include "validation_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace stylet::validate {

using results::html_escaped;
using results::html_prose;

namespace {

struct Output {
  double Outputs::*value;
  const char* name;
  const char* unit;
};
constexpr std::array<Output, 3> kOutputs{{{&Outputs::peak_axial_N, "Peak axial force", "N"},
                                          {&Outputs::target_shift_mm, "Shift of the target", "mm"},
                                          {&Outputs::tip_deflection_mm, "Deflection of the tip", "mm"}}};

bool two_sided(const Influence& influence) { return !influence.high.empty(); }

/// Change of an output in percent of its base value; 0 if the run failed.
double percent(double base, double value) {
  return std::isfinite(value) && base != 0.0 ? 100.0 * (value - base) / std::abs(base) : 0.0;
}

/// Largest change of an output by any parameter; choices are not counted.
double largest(const Sensitivity& study, const Output& output) {
  double most = 1e-9;
  for (const Influence& i : study.influences) {
    if (!two_sided(i)) continue;
    most = std::max({most, std::abs(percent(study.base.*output.value, i.at_low.*output.value)),
                     std::abs(percent(study.base.*output.value, i.at_high.*output.value))});
  }
  return most;
}

/// A bar that starts in the middle of the cell. The middle stands for the base value, the edge for the largest change.
std::string bar(const char* side, double change, double most) {
  constexpr double half = 33.0;  // [%] of the cell's width; the rest is for the numbers
  const double width = half * std::min(1.0, std::abs(change) / most);
  const bool right = change >= 0.0;
  const double left = right ? 50.0 : 50.0 - width;
  const std::string place = right ? fmt::format("left:calc({:.2f}% + 0.3rem)", 50.0 + width)
                                  : fmt::format("right:calc({:.2f}% + 0.3rem)", 50.0 + width);
  return fmt::format(
      "<i class=\"{0}\" style=\"left:{1:.2f}%;width:{2:.2f}%\"></i><span class=\"{0}\" style=\"{3}\">{4}</span>", side,
      left, width, place, change_text(100.0, 100.0 + change));
}

}  // namespace

std::string change_text(double from, double to) {
  if (!std::isfinite(to) || from == 0.0) return "–";
  const double change = 100.0 * (to - from) / std::abs(from);
  if (std::abs(change) < 0.05) return "0 %";
  return fmt::format("{}{:.{}f} %", change > 0.0 ? "+" : "−", std::abs(change), std::abs(change) < 9.95 ? 1 : 0);
}

std::vector<std::size_t> by_influence(const Sensitivity& study) {
  std::vector<double> weight(study.influences.size(), 0.0);
  for (const Output& output : kOutputs) {
    const double most = largest(study, output);
    const double base = study.base.*output.value;
    for (std::size_t k = 0; k < weight.size(); ++k) {
      const Influence& i = study.influences[k];
      double change = std::abs(percent(base, i.at_low.*output.value));
      if (two_sided(i)) change = std::max(change, std::abs(percent(base, i.at_high.*output.value)));
      weight[k] = std::max(weight[k], change / most);
    }
  }
  std::vector<std::size_t> order(weight.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const bool choice_a = !two_sided(study.influences[a]);
    const bool choice_b = !two_sided(study.influences[b]);
    if (choice_a != choice_b) return choice_b;  // choices come last
    return weight[a] > weight[b];
  });
  return order;
}

std::string sensitivity_html(const Sensitivity& study) {
  std::string head;
  for (const Output& output : kOutputs) {
    head += fmt::format("<th>{}<br><small class=\"facts\">{} {}</small></th>", output.name,
                        value_text(study.base.*output.value), output.unit);
  }
  std::string rows;
  std::size_t runs = 1;
  for (const std::size_t k : by_influence(study)) {
    const Influence& i = study.influences[k];
    runs += two_sided(i) ? 2 : 1;
    const std::string range =
        two_sided(i) ? fmt::format("{} → {} … {}", i.base, i.low, i.high) : fmt::format("{} → {}", i.base, i.low);
    std::string cells;
    for (const Output& output : kOutputs) {
      const double base = study.base.*output.value;
      const double most = largest(study, output);
      std::string bars = bar("low", percent(base, i.at_low.*output.value), most);
      if (two_sided(i)) bars += bar("high", percent(base, i.at_high.*output.value), most);
      cells += "<td><div class=\"bars\">" + bars + "</div></td>";
    }
    rows += fmt::format("<tr><td>{}<br><code>{}</code> <span class=\"range\">{}{}</span></td>{}</tr>",
                        html_prose(i.meaning), html_escaped(i.key),
                        html_escaped(i.unit.empty() ? range : range + " " + i.unit),
                        i.note.empty() ? std::string() : "; " + html_escaped(i.note), cells);
  }
  return fmt::format(
      "<section aria-labelledby=\"sensitivity\"><h2 id=\"sensitivity\">What to measure: influence of each "
      "parameter</h2>"
      "<p>{}. Each parameter is moved by ±{:.0f} %, all others stay. Bars show the change of the output from its base "
      "value; the longest bar of a column is its most influential parameter. Choices, at the end, are not moved but "
      "made "
      "otherwise; their bars may be cut off at the column’s scale. {} runs on {} threads in {:.0f}&nbsp;s.</p>"
      "<div class=\"swatches\"><span><i style=\"background:#56b4e9\"></i>parameter lower, or the other choice</span>"
      "<span><i style=\"background:#d55e00\"></i>parameter higher</span></div>"
      "<div class=\"scroll\"><table class=\"tornado\"><colgroup><col class=\"parameter\"><col><col><col></colgroup>"
      "<thead><tr><th>Parameter</th>{}</tr></thead><tbody>{}</tbody></table></div></section>",
      html_escaped(study.scenario), 100.0 * study.change, runs, study.threads, study.seconds, head, rows);
}

std::vector<std::vector<std::string>> sensitivity_lines(const Sensitivity& study) {
  std::vector<std::vector<std::string>> table{
      {"parameter", "from", "low", "high", "force low", "high", "shift low", "high", "tip low", "high"}};
  for (const std::size_t k : by_influence(study)) {
    const Influence& i = study.influences[k];
    std::vector<std::string> row{i.key, i.base, i.low, i.high};
    for (const Output& output : kOutputs) {
      const double base = study.base.*output.value;
      row.push_back(change_text(base, i.at_low.*output.value));
      row.push_back(two_sided(i) ? change_text(base, i.at_high.*output.value) : std::string());
    }
    table.push_back(std::move(row));
  }
  return table;
}

}  // namespace stylet::validate
