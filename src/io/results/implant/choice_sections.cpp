// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/choice_sections.hpp"

#include "dose/page_tables.hpp"
#include "dose/structure_look.hpp"
#include "fixed_number.hpp"
#include "implant/implant_tables.hpp"
#include "implant/implant_words.hpp"
#include "report/html_parts.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <cctype>
#include <tuple>

namespace stylet::results {
namespace {

/// "1.9 mm (firm), 2.1 mm (typical) and 2.8 mm (soft)"
std::string figures_in_words(const std::vector<ImplantChoice>& choices, const std::vector<double>& values, int digits,
                             const char* unit) {
  std::string text;
  for (std::size_t k = 0; k < choices.size(); ++k) {
    std::string name = choices[k].name;
    name.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(name.front())));
    text += fmt::format("{}{} {} ({})",
                        k == 0                    ? ""
                        : k + 1 == choices.size() ? " and "
                                                  : ", ",
                        fixed(values[k], digits), unit, name);
  }
  return text;
}

/// How much of the errors of found seeds each choice explains; empty where it cannot be said.
std::string explained_sentence(const std::vector<ImplantChoice>& choices, const std::optional<FoundImplant>& found) {
  if (!found) return {};
  std::vector<double> explained;
  for (const ImplantChoice& choice : choices) {
    const Agreement all = compare_found(*choice.history, found->seeds.seeds).all;
    if (!all.explained_percent) return {};
    explained.push_back(*all.explained_percent);
  }
  return " Of the variance of the errors found on imaging, the simulation explains " +
         figures_in_words(choices, explained, 0, "%") + "; a negative share makes it worse.";
}

std::string choice_sentence(const std::vector<ImplantChoice>& choices, const std::optional<FoundImplant>& found) {
  std::vector<double> errors, d90;
  for (const ImplantChoice& choice : choices) {
    errors.push_back(seed_errors(choice.history->seeds).mean_mm);
    const StructureDose* target = find_region(*choice.dose, "prostate");
    if (target) d90.push_back(target->dvh.dose_of_percent(90.0));
  }
  const char* const sources = nouns_of(*choices.front().history).sources;
  std::string text =
      fmt::format("The mean error of the {} is ", sources) + figures_in_words(choices, errors, 1, "mm") + ".";
  if (d90.size() == choices.size()) text += " The target’s D90 is " + figures_in_words(choices, d90, 0, "Gy") + ".";
  return text + explained_sentence(choices, found);
}

}  // namespace

std::string choice_html(const ChoiceSection& section, const ImplantOutcome& outcome) {
  std::string head = text_heading("") + figure_heading(capital(nouns_of(outcome.history).sources));
  for (const char* name : {"Mean distance [mm]", "95 % within [mm]", "Left [mm]", "Posterior [mm]", "Superior [mm]"})
    head += figure_heading(name);
  std::string rows;
  std::vector<NamedDose> doses{{"Planned", &outcome.planned}};
  for (const ImplantChoice& choice : section.choices) {
    rows += error_row(choice.name, seed_errors(choice.history->seeds));
    doses.push_back({choice.name, choice.dose});
  }
  return fmt::format(
      "<section aria-labelledby=\"{0}\"><h2 id=\"{0}\">{1}</h2><p>{2}</p><p>{3}</p>{4}<div "
      "class=\"distances needs-script\"><div class=\"plot\" id=\"{0}-chart\"></div></div>{5}{6}</section>",
      section.id, section.heading, section.intro, html_prose(choice_sentence(section.choices, outcome.found)),
      scrolled_table("scroll", "figures errors", head, rows), chart_note("summary.json"), goal_table(doses));
}

std::vector<ChoiceSection> choice_sections(const ImplantOutcome& outcome) {
  std::vector<ChoiceSection> sections;
  if (outcome.before) {
    sections.push_back(
        {"compensation",
         "Before and after compensation",
         "The needles were aimed beside their plan by the mean error of their seeds, with the opposite sign, so that "
         "the seeds come to rest nearer to their plan. The rest of this page is about the implant after compensation. "
         "What differs from seed to seed of one needle cannot be aimed away.",
         {{"Before compensation", &outcome.before->history, &outcome.before->delivered},
          {"After compensation", &outcome.history, &outcome.delivered}}});
  }
  if (outcome.spans.size() == 2) {
    const auto& [firm, soft] = std::tie(outcome.spans[0], outcome.spans[1]);
    sections.push_back({"span",
                        "Firm, typical and soft tissue",
                        "The same needles in firmer and in softer tissue. Nobody has measured the tissue of this "
                        "patient: a figure is only as sure as it is alike in all three. The rest of this page is about "
                        "typical tissue.",
                        {{"Firm tissue", &firm.history, &firm.delivered},
                         {"Typical tissue", &outcome.history, &outcome.delivered},
                         {"Soft tissue", &soft.history, &soft.delivered}}});
  }
  return sections;
}

}  // namespace stylet::results
