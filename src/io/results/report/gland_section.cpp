// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/gland_section.hpp"

#include "fixed_number.hpp"
#include "report/narrative.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stylet::results {
namespace {

constexpr int kGlandDigits = 3;  // of shifts [mm], turns [°] and the volume change [%]

std::string number_cell(double value) { return "<td class=\"number\">" + fixed(value, kGlandDigits) + "</td>"; }

std::string shift_rows(const GlandMotion& gland) {
  std::string html;
  for (const NamedShift& shift : named_shifts(gland)) {
    html += "<tr><td>" + html_escaped(shift.name) + "</td>";
    if (shift.mm) {
      html += number_cell(shift.mm->norm());
      for (const double part : *shift.mm) html += number_cell(part);
    } else {
      html += "<td class=\"number\" colspan=\"4\">none</td>";
    }
    html += "</tr>";
  }
  return html;
}

std::string turn_rows(const GlandMotion& gland) {
  std::string html;
  for (const NamedTurn& turn : named_turns(gland))
    html += "<tr><td>" + turn.plane + "</td>" + number_cell(turn.degrees) + "<td>" + turn.direction + "</td></tr>";
  return html;
}

/// Two or three sentences about the gland's motion.
std::string tell(const RunRecording& run, const GlandMotion& gland) {
  std::string text;
  if (gland.shift_at_break_mm) {
    text += fmt::format("Just before the needle broke through its surface, the {} as a whole had moved by {}. ",
                        target_name(run), anatomical(*gland.shift_at_break_mm));
  }
  text +=
      fmt::format("On the way in it moved by at most {}; with the needle in place it lay {} from its initial place.",
                  anatomical(gland.shift_max_mm), anatomical(gland.shift_in_place_mm));
  if (gland.shift_residual_mm) {
    text += gland.shift_residual_mm->norm() < 0.0005
                ? " Once the needle was out, it was back where it had been."
                : fmt::format(" One second after the needle was out, it still lay {} from its initial place.",
                              anatomical(*gland.shift_residual_mm));
  }
  return text;
}

}  // namespace

std::string anatomical(const Vec3& shift_mm) {
  return in_words(shift_mm, {{{"left", "right"}, {"posterior", "anterior"}, {"superior", "inferior"}}}, 2);
}

std::string gland_section(const RunRecording& run) {
  if (!run.summary->gland) return {};
  const GlandMotion& gland = *run.summary->gland;
  const std::string plots =
      run.summary->gland_path.empty()
          ? ""
          : "<p>The path of the gland, as means over its volume. The shift is positive to the left (LR), to posterior "
            "(AP) and to superior (SI). The same numbers, with its rotation, are in <code>gland.csv</code>.</p><div "
            "class=\"legend\" id=\"gland-legend\"></div><div class=\"plots\"><figure><figcaption>Shift of the gland "
            "against depth of the needle’s base</figcaption><div class=\"plot\" "
            "id=\"gland-depth\"></div></figure><figure><figcaption>Shift of the gland against time</figcaption><div "
            "class=\"plot\" id=\"gland-time\"></div></figure></div>";
  return "<section aria-labelledby=\"gland\"><h2 id=\"gland\">How the gland moved</h2><p>" +
         html_prose(tell(run, gland)) + "</p>" + plots +
         "<div class=\"columns\"><div><h3>Shift</h3><div class=\"scroll\"><table><thead><tr><th>Gland</th>"
         "<th class=\"number\">Total [mm]</th><th class=\"number\">LR, + left [mm]</th>"
         "<th class=\"number\">AP, + posterior [mm]</th><th class=\"number\">SI, + superior [mm]</th></tr></thead>"
         "<tbody>" +
         shift_rows(gland) +
         "</tbody></table></div></div><div><h3>Rotation</h3><div class=\"scroll\"><table><thead><tr><th>Plane</th><th "
         "class=\"number\">Angle [°]</th><th>Direction</th></tr></thead><tbody>" +
         turn_rows(gland) + "</tbody></table></div><p>Its volume had changed by " +
         fixed(gland.volume_change_percent, kGlandDigits) +
         "&nbsp;%. Thirds, rotation and volume belong to the moment of its largest shift.</p></div></div></section>";
}

}  // namespace stylet::results
