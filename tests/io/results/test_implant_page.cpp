// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of the page report.html of an implant.
#include "report_page.hpp"
#include "results/implant/found_csv.hpp"
#include "results/implant/implant_page.hpp"
#include "results/implant/implant_tables.hpp"
#include "results/implant/implant_words.hpp"
#include "results/implant/oedema_section.hpp"
#include "support/folder.hpp"
#include "synthetic_implant.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <sstream>
#include <vector>

using namespace stylet;
using namespace stylet::test;
using namespace stylet::testing;

namespace {

/// The outcome with coarse samples, which is computed once.
const ImplantOutcome& outcome() {
  static const ImplantOutcome invented = synthetic_implant(4.0, 1.5);
  return invented;
}

/// The same with seeds that were found on images.
const ImplantOutcome& outcome_with_found() {
  static const ImplantOutcome invented = [] {
    ImplantOutcome implant = outcome();
    add_invented_found_seeds(implant);
    return implant;
  }();
  return invented;
}

std::string page_of(const ImplantOutcome& implant) {
  const Result<std::string> page = results::implant_page(implant);
  return page ? *page : page.error().message();
}

/// The data for the page's scripts.
nlohmann::json data_of(const std::string& page) {
  return nlohmann::json::parse(between(page, "id=\"implant-data\">", "</script>"));
}

}  // namespace

TEST(ImplantPage, has_the_figures_of_errors_and_doses_and_no_slot_left) {
  const std::string page = page_of(outcome());
  const std::string text = markup(page);
  EXPECT_EQ(count(text, "{{"), 0U);
  const SeedErrors errors = seed_errors(outcome().history.seeds);
  EXPECT_EQ(errors.seeds, 43U);
  const std::string tiles = between(text, "<ul class=\"tiles\">", "</ul>");
  expect_once(
      tiles, {fmt::format("<b>{:.1f}&nbsp;mm</b>", errors.mean_mm), fmt::format("<b>{:.1f}&nbsp;mm</b>", errors.p95_mm),
              "44<small>1 lost</small>", fmt::format("<b>{}</b>", outcome().history.needles.size())});
  const double d90 = outcome().planned.structures[0].dvh.dose_of_percent(90.0);
  EXPECT_EQ(count(tiles, fmt::format("{:.0f}&nbsp;Gy", d90)), 1U);
  const std::string table = between(text, "<table class=\"figures errors\">", "</table>");
  EXPECT_EQ(count(table, "<tr>"), 5U) << "a heading, all seeds, base, mid and apex";
  EXPECT_EQ(count(table, fmt::format("+{:.2f} ± {:.2f}", errors.axes[2].mean_mm, errors.axes[2].sd_mm)), 1U);
}

TEST(ImplantPage, links_to_the_reports_of_both_doses_and_names_the_files_beside_it) {
  const std::string text = markup(page_of(outcome()));
  for (const char* part :
       {"href=\"planned/report.html\"", "href=\"delivered/report.html\"", "seeds.csv", "summary.json"})
    EXPECT_GE(count(text, part), 1U) << part;
  EXPECT_EQ(count(text, "src=\"http") + count(text, "href=\"http"), 0U) << "all assets are in the page";
}

TEST(ImplantPage, judges_the_goals_of_both_doses) {
  ImplantOutcome implant = outcome();
  implant.planned.goals[0].met = true;
  implant.delivered.goals[0].met = false;
  const std::string table = between(page_of(implant), "<table class=\"goals\">", "</table>");
  expect_once(table, {"Planned", "Delivered"});
  EXPECT_EQ(count(table, "class=\"verdict"), 2 * implant.delivered.goals.size());
  const std::string row = between(table, "<td>D90</td>", "</tr>");
  EXPECT_LT(row.find("</i>met<"), row.find("</i>missed<"));
}

TEST(ImplantPage, says_where_the_probe_was_and_which_places_are_without_it) {
  ImplantOutcome implant = outcome();
  EXPECT_EQ(count(markup(page_of(implant)), "lifted by") + count(markup(page_of(implant)), "Probe out"), 0U);
  implant.probe = ProbeReport{};
  implant.probe->settings.kind = ProbeKind::biplane;
  implant.probe->settings.lift_mm = 7.0;
  std::string text = markup(page_of(implant));
  EXPECT_EQ(count(text, "With the probe and all needles out"), 1U);
  EXPECT_GE(count(text, "lifted by 7"), 1U);
  EXPECT_EQ(count(text, "Probe out"), 0U);
  EXPECT_TRUE(nlohmann::json::parse(implant_json(implant))["implant"]["probe_out"].is_null());
  // With contours of the probe in place there is a dose without it.
  implant.probe->settings.in_contours = true;
  implant.probe_out = implant.planned;
  text = markup(page_of(implant));
  EXPECT_EQ(count(text, "With all needles out"), 1U);
  EXPECT_GE(count(text, "Probe out"), 1U);
  EXPECT_EQ(count(text, "gland and seeds go back together"), 1U);
  const auto json = nlohmann::json::parse(implant_json(implant))["implant"];
  EXPECT_EQ(json["probe_out"]["goals"].size(), implant.planned.goals.size());
  EXPECT_TRUE(json["probe"]["in_contours"].get<bool>());
}

TEST(ImplantPage, escapes_names_and_sentences) {
  ImplantOutcome implant = outcome();
  const std::string name = "<script>alert(1)</script>";
  implant.scenario.name = name;
  implant.history.needles[0].name = name;
  implant.warnings = {name};
  implant.planned.plan.label = name;
  implant.planned.structures[0].name = name;
  implant.delivered.structures[0].name = name;
  implant.delivered.assumptions = {name};
  const std::string page = page_of(implant);
  EXPECT_EQ(count(page, "<script>alert"), 0U);
  EXPECT_GE(count(page, "&lt;script&gt;alert(1)&lt;/script&gt;"), 8U);
  const auto data = nlohmann::json::parse(between(page, "id=\"implant-data\">", "</script>"));
  EXPECT_EQ(data["seeds"][0]["needle"], name);
}

TEST(ImplantPage, gives_the_scripts_planned_histograms_at_the_doses_of_the_delivered_ones) {
  const std::string page = page_of(outcome());
  const auto dose = nlohmann::json::parse(between(page, "id=\"dose-data\">", "</script>"));
  const auto data = nlohmann::json::parse(between(page, "id=\"implant-data\">", "</script>"));
  ASSERT_EQ(data["planned_percent"].size(), outcome().planned.structures.size());
  for (const auto& curve : data["planned_percent"]) EXPECT_EQ(curve.size(), dose["dvh"]["dose_Gy"].size());
  EXPECT_EQ(data["seeds"].size(), 44U);
  EXPECT_TRUE(data["seeds"][43]["rest_mm"].is_null()) << "the last seed is lost";
  EXPECT_EQ(data["thirds"].size(), 3U);
}

TEST(ImplantPage, says_what_the_swelling_takes_away_and_when_only_where_the_gland_swells) {
  const std::string page = page_of(outcome());
  const std::string section = between(page, "<section aria-labelledby=\"oedema\">", "</section>");
  EXPECT_EQ(count(section, "takes away 14.0 Gy (9.3&nbsp;%), half of it within the first 8 days"), 1U) << section;
  EXPECT_EQ(count(section, "id=\"oedema-charts\""), 1U);
  const auto json = nlohmann::json::parse(implant_json(outcome()))["implant"]["oedema"];
  ASSERT_EQ(json["moments"].size(), 17U);
  EXPECT_NEAR(json["moments"][0]["swelling_percent"][2].get<double>(), 14.5, 1e-12);
  EXPECT_TRUE(json["moments"][16]["days"].is_null());
  EXPECT_DOUBLE_EQ(json["moments"][16]["D90_Gy"].get<double>(), 136.0);
  EXPECT_DOUBLE_EQ(json["D90_taken_away_Gy"].get<double>(), 14.0);
  ImplantOutcome without = outcome();
  without.oedema.reset();
  const std::string page_without = page_of(without);
  EXPECT_EQ(count(page_without, "Dose while the gland swells"), 0U);
  EXPECT_TRUE(data_of(page_without)["oedema"].is_null());
  EXPECT_TRUE(nlohmann::json::parse(implant_json(without))["implant"]["oedema"].is_null());
}

TEST(ImplantPage, gives_the_scripts_the_shafts_of_needles_in_place_together_and_says_so) {
  const std::string page = page_of(outcome());
  const auto needles = data_of(page)["needles"];
  ASSERT_EQ(needles.size(), outcome().history.needles.size() + 2);
  EXPECT_EQ(needles[0]["stabilises"], true);
  EXPECT_EQ(needles[2]["name"], outcome().history.needles[0].name);
  // The shaft begins not more than 25 mm in front of the skin and ends at the tip.
  const NeedleHistory& needle = outcome().history.needles[0];
  EXPECT_GT(needles[2]["shaft_mm"][0][2].get<double>(), needle.entry_mm.z() - 25.0);
  EXPECT_NEAR(needles[2]["shaft_mm"].back()[2].get<double>(), needle.record.shapes[1].points_mm.back().z(), 0.006);
  EXPECT_EQ(count(page, "Shafts are those of needles"), 1U);
  ImplantOutcome alone = outcome();
  alone.history.stabilising.clear();
  for (NeedleHistory& of : alone.history.needles)
    std::erase_if(of.record.shapes, [](const NeedleShape& shape) { return shape.when == kAllInPlace; });
  const std::string page_alone = page_of(alone);
  EXPECT_TRUE(data_of(page_alone)["needles"].empty());
  EXPECT_EQ(count(page_alone, "Shafts are those of needles"), 0U);
}

TEST(OedemaCurves, follow_the_width_along_each_axis_and_end_as_the_course_does) {
  DoseCourse course = *outcome().oedema;
  course.swelling.at_start = Vec3(0.1, 0.2, -0.05);
  const auto curves = results::oedema_curves_json(course);
  ASSERT_EQ(curves["days"].size(), 121U);
  EXPECT_DOUBLE_EQ(curves["days"].back().get<double>(), 4.0 * course.half_life_days);
  for (const char* name : {"D90_Gy", "D90_without_swelling_Gy"}) EXPECT_EQ(curves[name].size(), 121U);
  EXPECT_NEAR(curves["swelling_percent"][1][0].get<double>(), 20.0, 1e-12);
  EXPECT_NEAR(curves["swelling_percent"][2][0].get<double>(), -5.0, 1e-12);
  EXPECT_EQ(curves["in_the_end_Gy"], (std::vector<double>{136.0, 150.0, 14.0}));
  for (DoseMoment& moment : course.moments) std::swap(moment.d90_Gy, moment.d90_without_swelling_Gy);
  EXPECT_DOUBLE_EQ(results::oedema_curves_json(course)["in_the_end_Gy"][2].get<double>(), -14.0);
  EXPECT_NE(results::oedema_words(course).find("adds 14.0 Gy"), std::string::npos);
  EXPECT_NE(results::oedema_words(course).find("5 % narrower from inferior to superior"), std::string::npos);
}

TEST(ImplantPage, can_be_made_when_every_seed_is_lost) {
  ImplantOutcome implant = outcome();
  for (SeedHistory& seed : implant.history.seeds) seed.lost = true;
  const std::string page = page_of(implant), text = markup(page);
  EXPECT_EQ(count(text, "{{") + count(text, "nan"), 0U);
  for (const auto& seed : data_of(page)["seeds"]) EXPECT_TRUE(seed["rest_mm"].is_null());
}

TEST(ImplantPage, has_a_section_about_seeds_found_on_images_only_where_there_are_any) {
  EXPECT_EQ(count(markup(page_of(outcome())), "Found on imaging"), 0U);
  const std::string page = page_of(outcome_with_found());
  const std::string text = markup(page);
  EXPECT_EQ(count(text, "{{") + count(text, "nan"), 0U);
  const std::string section = between(text, "id=\"found\"", "</section>");
  const FoundComparison& comparison = outcome_with_found().found->comparison;
  ASSERT_EQ(comparison.seeds.size(), 41U);
  expect_once(section, {"41<small>42 found, 43 simulated</small>", "more than chance", "(no. 4, 11 of the plan)",
                        "<td>matches no simulated seed</td>"});
  EXPECT_EQ(count(section, "<td>not found</td>"), 2U);
  EXPECT_EQ(count(section, "<td>lost in the simulation</td>"), 1U);
  const std::string table = between(section, "<table class=\"figures errors found-errors\">", "</table>");
  EXPECT_EQ(count(table, fmt::format("<td class=\"number\">{:.2f}</td>", comparison.as_found.error.mean_mm)), 1U);
  expect_once(text, {"href=\"found/report.html\""});
  EXPECT_EQ(count(text, "found.csv</code> beside") + count(text, "<code>found.csv</code>."), 1U);
  const auto data = data_of(page);
  EXPECT_EQ(data["found"]["seeds"].size(), 41U);
  EXPECT_EQ(data["found"]["not_dropped"].size(), 1U);
  EXPECT_EQ(data["found"]["as_found"]["parts"].back()["cause"], "not explained by the simulation");
  EXPECT_EQ(data["found_percent"].size(), data["planned_percent"].size());
}

TEST(ImplantPage, bears_found_seeds_that_match_nothing) {
  ImplantOutcome implant = outcome();
  for (SeedHistory& seed : implant.history.seeds) seed.lost = true;
  add_invented_found_seeds(implant);
  const std::string text = markup(page_of(implant));
  EXPECT_EQ(count(text, "{{") + count(text, "nan"), 0U);
  EXPECT_EQ(count(between(text, "id=\"found\"", "</section>"), "0 of them match."), 1U);
}

TEST(ImplantPage, shows_compensation_and_span_where_they_were_asked_for) {
  const std::string without = markup(page_of(outcome()));
  EXPECT_EQ(count(without, "id=\"compensation\"") + count(without, "id=\"span\""), 0U);
  ImplantOutcome implant = outcome_with_found();
  const OtherImplant other{"tissue firm", implant.history, implant.delivered};
  implant.before = other;
  implant.spans = {other, other};
  implant.spans[1].name = "tissue soft";
  const std::string page = page_of(implant), text = markup(page);
  EXPECT_EQ(count(text, "{{") + count(text, "nan"), 0U);
  const std::string before = between(text, "id=\"compensation\"", "</section>");
  const double mean = seed_errors(implant.history.seeds).mean_mm;
  expect_once(before,
              {fmt::format("{:.1f}&nbsp;mm (before compensation) and {:.1f}&nbsp;mm (after compensation)", mean, mean),
               "<table class=\"goals\">"});
  const std::string span = between(text, "id=\"span\"", "</section>");
  EXPECT_EQ(count(span, "Firm tissue</th>") + count(span, "Soft tissue</th>"), 2U) << "columns of the goals";
  const auto choices = data_of(page)["choices"];
  ASSERT_EQ(choices["span"].size(), 3U);
  EXPECT_EQ(choices["span"][1]["distances_mm"].size(), 43U) << "the lost seed has no distance";
  EXPECT_EQ(choices["compensation"][0]["name"], "Before compensation");
  EXPECT_EQ(count(span, "errors found on imaging"), 1U);
  const auto json = nlohmann::json::parse(implant_json(implant));
  EXPECT_TRUE(json["implant"]["spans"][0]["agreement"]["explained_percent"].is_number());
}

TEST(FoundSentences, say_whether_the_shift_is_chance_and_what_is_explained) {
  ImplantOutcome implant = outcome_with_found();
  const auto all = [&] {
    implant.found->comparison = compare_found(implant.history, implant.found->seeds.seeds);
    std::string text;
    for (const std::string& sentence : found_sentences(implant.history, *implant.found)) text += sentence + " ";
    return text;
  };
  EXPECT_EQ(count(all(), "This is more than chance makes it"), 1U);
  const Vec3 shift = implant.found->comparison.matching.shift_mm;
  for (FoundSeed& seed : implant.found->seeds.seeds) seed.at_mm -= shift;
  EXPECT_EQ(count(all(), "Chance alone may make it so large."), 1U);
  for (SeedHistory& seed : implant.history.seeds)
    seed.rest_mm = seed.planned_mm + 3.0 * (seed.rest_mm - seed.planned_mm);
  EXPECT_EQ(count(all(), "explains nothing"), 1U);
  implant.found->seeds.seeds.resize(2);
  EXPECT_EQ(count(all(), "too few matches"), 1U);
}

TEST(FoundCsv, of_an_earlier_run_is_removed_and_a_file_of_the_user_stays) {
  const Folder folder;
  EXPECT_TRUE(results::remove_earlier_found(folder.path()).ok()) << "nothing is there";
  write_file(folder / "found.csv", found_csv(outcome_with_found().history, *outcome_with_found().found));
  write_file(folder / "found/dose.json", "{}");
  EXPECT_TRUE(results::remove_earlier_found(folder.path()).ok());
  EXPECT_FALSE(std::filesystem::exists(folder / "found.csv") || std::filesystem::exists(folder / "found/dose.json"));
  write_file(folder / "found.csv", "x_mm,y_mm,z_mm\n1,2,3\n");
  EXPECT_TRUE(results::remove_earlier_found(folder.path()).ok());
  EXPECT_TRUE(std::filesystem::exists(folder / "found.csv"));
}

TEST(FoundCsv, has_a_row_for_each_seed_of_the_plan_and_each_found_seed_without_match) {
  const std::string text = found_csv(outcome_with_found().history, *outcome_with_found().found);
  std::istringstream lines(text);
  std::string line;
  std::size_t rows = 0;
  while (std::getline(lines, line)) {
    ++rows;
    EXPECT_EQ(count(line, ","), 45U) << line;
  }
  EXPECT_EQ(rows, 1U + 44U + 1U);
}

/// The invented implant as a temporary one, whose dwell positions have moved since planning.
ImplantOutcome temporary_outcome() {
  ImplantOutcome implant = outcome();
  for (SeedHistory& dwell : implant.history.seeds) {
    dwell.lost = false;
    dwell.by(SeedCause::release).setZero();
    dwell.by(SeedCause::wait) = Vec3(0.0, 0.1, -1.5);
    dwell.at_planning = DwellAtPlanning{dwell.dropped_mm, dwell.rest_mm};
    dwell.rest_mm += dwell.by(SeedCause::wait);
  }
  implant.at_planning = OtherImplant{"at planning", history_at_planning(implant.history), implant.planned};
  return implant;
}

TEST(TemporaryPage, speaks_of_dwell_positions_and_catheters_and_has_three_places_and_doses) {
  const ImplantOutcome implant = temporary_outcome();
  const std::string text = markup(page_of(implant));
  EXPECT_EQ(count(text, "{{"), 0U);
  expect_once(text, {"Simulation of a temporary implant", "Errors of the dwell positions"});
  EXPECT_GE(count(text, "Tissue at planning [mm]"), 1U);
  EXPECT_GE(count(text, "At planning"), 1U);
  EXPECT_EQ(count(text, "against the tissue, on the whole"), 1U);
  EXPECT_EQ(count(text, "needles out"), 0U);
  EXPECT_EQ(count(text, "Shafts are those of needles"), 0U);
  EXPECT_EQ(count(text, "needle first"), 0U);
  const std::string table = seeds_csv(implant);
  expect_once(table, {"planning_room_x_mm", "wait_z_mm"});
  EXPECT_EQ(count(table, "strand"), 0U);
  const auto json = nlohmann::json::parse(implant_json(implant));
  EXPECT_EQ(json["implant"]["dwell_positions"].size(), implant.history.seeds.size());
  EXPECT_EQ(json["implant"]["why"].back()["cause"], "planning to delivery");
  EXPECT_FALSE(json["implant"].contains("seeds"));
}

TEST(TemporaryPage, gives_the_scripts_its_words) {
  const auto nouns_on = [](const ImplantOutcome& implant) { return data_of(page_of(implant))["nouns"]; };
  EXPECT_EQ(nouns_on(temporary_outcome())["sources"], "dwell positions");
  EXPECT_EQ(nouns_on(temporary_outcome())["needle"], "catheter");
  EXPECT_EQ(nouns_on(outcome())["sources"], "seeds");
  EXPECT_EQ(nouns_on(outcome())["needle"], "needle");
}

TEST(CausesOnThePage, are_those_that_moved_a_seed_and_a_sentence_names_the_others) {
  ImplantOutcome implant = outcome();
  const auto causes = data_of(page_of(implant))["causes"];
  ASSERT_EQ(causes.size(), 3U);
  EXPECT_EQ(causes[0]["name"], "needle bend");
  EXPECT_EQ(count(results::causes_left_out(implant.history), "strand, release, aim and probe"), 1U);
  for (SeedHistory& seed : implant.history.seeds) {
    for (const SeedCause cause : {SeedCause::strand, SeedCause::release, SeedCause::aim, SeedCause::probe})
      seed.by(cause) = Vec3(0, 0, 0.2);
  }
  EXPECT_EQ(data_of(page_of(implant))["causes"].size(), 7U);
  EXPECT_EQ(results::causes_left_out(implant.history), "");
}

TEST(NeedleTable, has_a_dash_where_there_is_no_gland) {
  ImplantHistory history = outcome().history;
  const std::size_t dashes = count(results::needle_table(history), ">–<");
  history.needles[0].gland_shift_mm = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  const std::string table = results::needle_table(history);
  EXPECT_EQ(count(table, ">–<"), dashes + 1);
  EXPECT_EQ(count(table, "nan"), 0U);
  EXPECT_EQ(count(table, "<tr>"), history.needles.size() + 1);
}

TEST(SeedTable, says_which_seeds_are_lost) {
  const std::string table = results::seed_error_table(outcome().history);
  EXPECT_EQ(count(table, "<td>lost</td>"), 1U);
  EXPECT_EQ(count(table, "<tr>"), 45U);
}

TEST(SignedNumber, has_no_sign_at_zero) {
  EXPECT_EQ(results::signed_number(0.004, 2), "0.00");
  EXPECT_EQ(results::signed_number(-0.004, 2), "0.00");
  EXPECT_EQ(results::signed_number(-1.5, 1), "−1.5");
  EXPECT_EQ(results::signed_number(1.5, 1), "+1.5");
}
