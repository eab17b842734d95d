// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/page_shell.hpp"

#include "report/assets.hpp"
#include "report/html_parts.hpp"
#include "report/text.hpp"
#include "stylet/core/version.hpp"

#include <fmt/format.h>

namespace stylet::results {

namespace {

// The places where scripts put histograms and sections (web/report/src/dose/page.ts).
constexpr const char* kDvhPlot =
    "<div class=\"needs-script\"><div class=\"legend\" id=\"dvh-legend\"></div><div class=\"plot\" id=\"dvh-plot\">"
    "</div></div>";
constexpr const char* kSectionPictures =
    "<div class=\"needs-script\"><div class=\"iso-key\" id=\"iso-key\"></div><div class=\"sections\" "
    "id=\"section-pictures\"></div></div>";

}  // namespace

Result<std::string> page_about_dose(std::string_view body, Slots slots) {
  constexpr const char* kName = "report.html";
  slots["dvh_plot"] = kDvhPlot + chart_note(slots["dvh_file"]);
  slots["section_pictures"] = kSectionPictures;
  Result<std::string> filled = fill_page(body, slots, kName);
  if (!filled) return filled;
  slots["body"] = *std::move(filled);
  slots["version"] = html_escaped(version());
  slots["versions"] = html_escaped(fmt::format("Stylet {}", version()));
  return fill_page(dose_shell(), slots, kName);
}

}  // namespace stylet::results
