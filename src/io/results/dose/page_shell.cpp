// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/page_shell.hpp"

#include "report/html_parts.hpp"

namespace stylet::results {

namespace {

// The places where scripts put histograms and sections (web/report/src/dose/page.ts).
constexpr const char* kDvhPlot =
    "<div class=\"needs-script\"><div class=\"legend\" id=\"dvh-legend\"></div><div class=\"plot\" id=\"dvh-plot\">"
    "</div></div>";
constexpr const char* kSectionPictures =
    "<div class=\"needs-script\"><div class=\"iso-key\" id=\"iso-key\"></div><div class=\"sections\" "
    "id=\"section-pictures\"></div></div>";
constexpr const char* kSign =
    "<dl class=\"sign\"><div><dt>Checked by</dt><dd></dd></div><div><dt>Date</dt><dd></dd></div><div><dt>Signature</dt>"
    "<dd></dd></div></dl>";

}  // namespace

Result<std::string> page_about_dose(const PageAssets& page, Slots slots) {
  slots["dvh_plot"] = kDvhPlot + chart_note(slots["dvh_file"]);
  slots["section_pictures"] = kSectionPictures;
  slots["sign"] = kSign;
  slots["data_id"] = "dose-data";
  return whole_page(page, std::move(slots), "report.html");
}

}  // namespace stylet::results
