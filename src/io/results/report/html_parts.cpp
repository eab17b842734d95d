// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/html_parts.hpp"

#include "report/text.hpp"

namespace stylet::results {

std::string text_cell(const std::string& text) { return "<td>" + html_escaped(text) + "</td>"; }
std::string figure_cell(const std::string& text) {
  return "<td class=\"number\">" + html_escaped(with_minus_signs(text)) + "</td>";
}
std::string text_heading(const std::string& text) { return "<th>" + html_escaped(text) + "</th>"; }
std::string figure_heading(const std::string& text) { return "<th class=\"number\">" + html_escaped(text) + "</th>"; }

std::string scrolled_table(const std::string& frame_style, const std::string& style, const std::string& head,
                           const std::string& rows) {
  return "<div class=\"" + frame_style + "\"><table class=\"" + style + "\"><thead><tr>" + head +
         "</tr></thead><tbody>" + rows + "</tbody></table></div>";
}

std::string figure_tile(const std::string& value, const std::string& caption) {
  return "<li><b>" + with_minus_signs(value) + "</b><span>" + html_escaped(caption) + "</span></li>";
}

std::string definition(const std::string& name, const std::string& value) {
  return value.empty() ? std::string() : "<dt>" + html_escaped(name) + "</dt><dd>" + html_prose(value) + "</dd>";
}

std::string sentence_list(const std::vector<std::string>& sentences) {
  std::string html;
  for (const std::string& sentence : sentences) html += "<li>" + html_prose(sentence) + "</li>";
  return html;
}

std::string box_of_warnings(const std::vector<std::string>& warnings) {
  return warnings.empty() ? std::string() : "<ul class=\"warnings\">" + sentence_list(warnings) + "</ul>";
}

std::string chart_note(const std::string& file) {
  return "<noscript><p class=\"note\">This chart needs JavaScript. Its numbers are in <code>" + file +
         "</code>.</p></noscript>";
}

}  // namespace stylet::results
