// SPDX-License-Identifier: GPL-3.0-or-later
#include "evidence/reproduce/page_text.hpp"
#include "report/page_template.hpp"
#include "report/text.hpp"
#include "sensitivity_page.hpp"
#include "stylet/core/json_text.hpp"
#include "stylet/measure/timing.hpp"
#include "validation_data.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet::validate {

using results::html_escaped;
using results::html_prose;

namespace {

constexpr std::array kGroups{Group::analysis, Group::other_code, Group::measurements, Group::independence};

/// The verdict as word, sign and colour, each of which is sufficient by itself.
std::string badge(Verdict verdict) {
  const auto make = [&](const char* style, const char* sign) {
    return fmt::format("<span class=\"verdict {}\"><i>{}</i>{}</span>", style, sign, to_string(verdict));
  };
  switch (verdict) {
    case Verdict::pass:
      return make("pass", "✓");
    case Verdict::missed:
      return make("missed", "✗");
    case Verdict::skipped:
      return make("skipped", "–");
    case Verdict::information:
      return make("information", "i");
    case Verdict::crashed:
      return make("crashed", "!");
  }
  return {};
}

std::string with_unit(const std::string& value, const std::string& unit) {
  return html_escaped(unit.empty() ? value : value + " " + unit);
}

std::string row_html(const Row& row) {
  const RowSpec& spec = row.spec;
  std::string claim = "<p class=\"claim\">" + html_prose(spec.claim) + "</p>";
  const auto add = [&](const char* style, const std::string& text) {
    if (!text.empty()) claim += fmt::format("<p class=\"{}\">{}</p>", style, html_prose(text));
  };
  add(row.verdict == Verdict::crashed ? "why" : "note-text", row.finding.note);
  if (row.verdict == Verdict::missed) add("why", row.finding.why_missed);
  if (row.verdict == Verdict::skipped) add("note-text", row.finding.skipped);
  claim += fmt::format("<p class=\"made\"><code>{}</code> · {}</p>", html_escaped(spec.id),
                       html_escaped(reproduce::duration(row.seconds)));

  const std::string value = std::isnan(row.finding.value) ? "–" : with_unit(value_text(row.finding.value), spec.unit);
  std::string picture;
  if (!row.finding.plot.curves.empty())
    picture = fmt::format("<div class=\"plot row\" id=\"plot-{}\"></div>", html_escaped(spec.id));
  return fmt::format(
      "<tr id=\"{}\"><td>{}</td><td>{}</td><td class=\"reference\">{}</td><td class=\"ours\"><b>{}</b></td>"
      "<td class=\"limit\">{}</td><td>{}</td></tr>",
      html_escaped(spec.id), badge(row.verdict), claim, html_prose(spec.reference), value,
      spec.accepted.any() ? with_unit(accepted_text(spec.accepted), spec.unit) : html_escaped("for information"),
      picture);
}

std::string group_html(const Validation& v, Group group) {
  std::string rows;
  int count = 0;
  int judged = 0;
  int passed = 0;
  for (const Row& row : v.rows) {
    if (row.spec.group != group) continue;
    ++count;
    judged += row.verdict == Verdict::pass || row.verdict == Verdict::missed ? 1 : 0;
    passed += row.verdict == Verdict::pass ? 1 : 0;
    rows += row_html(row);
  }
  if (count == 0) return {};
  return fmt::format(
      "<section aria-labelledby=\"group-{0}\"><h2 id=\"group-{0}\">{1} <small class=\"facts\">{2} of {3} "
      "pass</small></h2>"
      "<div class=\"scroll\"><table class=\"rows\"><colgroup><col class=\"result\"><col><col class=\"reference\">"
      "<col class=\"value\"><col class=\"accepted\"><col class=\"plotted\"></colgroup>"
      "<thead><tr><th>Result</th><th>Claim</th><th>Reference</th><th>Value</th><th>Accepted</th>"
      "<th>Plot</th></tr></thead><tbody>{4}</tbody></table></div></section>",
      static_cast<int>(group), html_escaped(title(group)), passed, judged, rows);
}

std::string counted(int count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string summary_html(const Validation& v) {
  if (v.rows.empty()) return {};
  const int judged = v.count(Verdict::pass) + v.count(Verdict::missed);
  std::string html = fmt::format(
      "<section aria-labelledby=\"summary\"><h2 id=\"summary\">Summary</h2><p class=\"lead\"><strong>{} of {} judged "
      "claims pass, {}.</strong>",
      v.count(Verdict::pass), judged,
      v.count(Verdict::missed) == 0 ? "none is missed" : counted(v.count(Verdict::missed), "is MISSED", "are MISSED"));
  if (v.count(Verdict::skipped) > 0)
    html += " " + counted(v.count(Verdict::skipped), "row was", "rows were") + " skipped.";
  if (v.count(Verdict::information) > 0)
    html += " " + counted(v.count(Verdict::information), "row is", "rows are") + " shown for information.";
  if (v.count(Verdict::crashed) > 0) html += " " + counted(v.count(Verdict::crashed), "row", "rows") + " crashed.";
  html += "</p>";
  std::string missed;
  for (const Row& row : v.rows) {
    if (row.verdict != Verdict::missed && row.verdict != Verdict::crashed) continue;
    missed += fmt::format("<li><a href=\"#{}\">{}</a>: {}, accepted {}</li>", html_escaped(row.spec.id),
                          html_prose(row.spec.claim), with_unit(value_text(row.finding.value), row.spec.unit),
                          with_unit(accepted_text(row.spec.accepted), row.spec.unit));
  }
  if (!missed.empty())
    html +=
        "<div class=\"missed-list\"><p>✗ Missed rows; each gives the known reasons</p><ul>" + missed + "</ul></div>";
  return html + "</section>";
}

std::string how_made(const Validation& v) {
  const measure::Machine machine = measure::this_machine();
  const auto pair = [](const std::string& name, const std::string& value) {
    return "<dt>" + html_escaped(name) + "</dt><dd>" + html_escaped(value) + "</dd>";
  };
  std::string extent = "all rows";
  if (!v.options.only.empty())
    extent = fmt::format("{} only", fmt::join(v.options.only, ", "));
  else if (v.options.quick)
    extent = "--quick: only rows that take a few seconds at most";
  return pair("Command", v.options.command) +
         pair("Machine", fmt::format("{}, {} cores", machine.processor, machine.cores)) +
         pair("Compiler", machine.compiler) + pair("Program", "Stylet " + v.version) +
         pair("Duration", fmt::format("{:.0f} s", v.seconds)) + pair("Extent", extent);
}

}  // namespace

Result<std::string> validation_page(const Validation& v) {
  std::string groups;
  for (const Group group : kGroups) groups += group_html(v, group);
  const results::Slots slots{
      {"title", "Stylet, validated"},
      {"heading", "What the model claims, and what it is checked against"},
      {"kicker", "Validation"},
      {"facts", html_escaped(fmt::format("{} · {}", counted(static_cast<int>(v.rows.size()), "claim", "claims"),
                                         measure::this_machine().processor))},
      {"summary", summary_html(v)},
      {"groups", groups},
      {"sensitivity", v.sensitivity ? sensitivity_html(*v.sensitivity) : std::string()},
      {"made", how_made(v)},
      {"no_script",
       "<noscript><p class=\"page note\">The pictures need JavaScript. The same numbers are in the files beside "
       "this page.</p></noscript>\n"},
      {"data_id", "validation-data"},
      {"data", results::json_script_safe(json_text(page_data(v)))},
  };
  return results::whole_page(results::validate_assets(), slots, "validate.html");
}

}  // namespace stylet::validate
