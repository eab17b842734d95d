// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/page_record.hpp"

#include "report/text.hpp"
#include "stylet/core/version.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace stylet::results {
namespace {

std::string known(const std::string& text) { return text.empty() ? "–" : text; }

std::string entry(const std::string& name, const std::string& value) {
  return "<div><dt>" + html_escaped(name) + "</dt><dd>" + html_escaped(known(value)) + "</dd></div>";
}

std::string file_rows(const std::vector<DoseInput>& inputs) {
  std::string rows;
  for (const DoseInput& input : inputs) {
    const std::string name = std::filesystem::path(input.path).filename().string();
    rows += "<tr><td>" + html_escaped(input.role) + "</td><td class=\"file\">" +
            html_escaped(name.empty() ? input.path : name) + "</td><td><code>" + html_escaped(known(input.sha256)) +
            "</code></td></tr>";
  }
  return rows;
}

/// A text as a string of CSS, within a <style> element.
std::string css_string(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || c == '"' || c == '\\' || c == '<') {
      quoted += fmt::format("\\{:x} ", code);
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

/// The first characters of a UTF-8 text, which fit into a margin.
std::string short_text(const std::string& text) {
  constexpr std::size_t kMost = 44;
  std::size_t characters = 0;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const bool starts = (static_cast<unsigned char>(text[k]) & 0xC0U) != 0x80U;
    if (starts && characters++ == kMost) return text.substr(0, k) + "…";
  }
  return text;
}

}  // namespace

std::string plan_name(const DosePlan& plan) {
  if (!plan.label.empty()) return plan.label;
  const std::string name = std::filesystem::path(plan.file).filename().string();
  return name.empty() ? "Brachytherapy plan" : name;
}

std::string record_of(const DoseEvaluation& evaluation) {
  const std::string rows = file_rows(evaluation.inputs);
  return "<dl class=\"record\">" + entry("Patient ID", evaluation.patient.id) +
         entry("Patient", evaluation.patient.name) + entry("Plan", plan_name(evaluation.plan)) +
         entry("Date of the plan", evaluation.strength.plan_date) + entry("Computed on", evaluation.computed_on) +
         entry("Program", fmt::format("Stylet {}", version())) + "</dl>" +
         (rows.empty() ? std::string()
                       : "<div class=\"scroll\"><table class=\"inputs\"><thead><tr><th>Input</th><th>File</th>"
                         "<th>SHA-256</th></tr></thead><tbody>" +
                             rows + "</tbody></table></div>");
}

std::string printed_margins(const DoseEvaluation& evaluation) {
  const std::string patient = "Patient ID " + short_text(known(evaluation.patient.id));
  return fmt::format(
      "@page {{ @top-left {{ content: {}; }} @top-right {{ content: {}; }} @bottom-left {{ content: {}; }} }}",
      css_string(patient + " · " + short_text(plan_name(evaluation.plan))),
      css_string("Computed on " + known(evaluation.computed_on)),
      css_string(fmt::format("Stylet {} · research and teaching, not a medical device", version())));
}

}  // namespace stylet::results
