// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of report.html: its text, the data of its scripts, and that it loads nothing from elsewhere.
#include "report/narrative.hpp"
#include "report/parameter_tables.hpp"
#include "report/report_data.hpp"
#include "report/report_html.hpp"
#include "report/text.hpp"
#include "report_page.hpp"
#include "stylet/io/region_views.hpp"
#include "support/says.hpp"
#include "synthetic_run.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstring>

using namespace stylet;
using namespace stylet::test;
using namespace stylet::results;
using namespace stylet::testing;

namespace {

std::string page_of(const RunRecording& run) {
  const auto regions = region_views(run.mesh, run.info.target_regions);
  auto page = report_html(run, regions, find_moments(run.frames), {{}, "no driver"});
  EXPECT_TRUE(page.ok());
  if (!page.ok()) return {};
  constexpr std::string_view kNoBreak = "&nbsp;";
  for (std::size_t at = page->find(kNoBreak); at != std::string::npos; at = page->find(kNoBreak, at)) {
    page->replace(at, kNoBreak.size(), " ");
  }
  return *page;
}

nlohmann::json data_of(const RunRecording& run) {
  return nlohmann::json::parse(
      report_data(run, region_views(run.mesh, run.info.target_regions), find_moments(run.frames)));
}

/// Decodes numbers from base 64 (RFC 4648).
template <class Number>
std::vector<Number> numbers(const std::string& text) {
  std::string bytes;
  std::uint32_t bits = 0;
  int have = 0;
  for (const char c : text) {
    if (c == '=') break;
    const auto digit = std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/").find(c);
    EXPECT_NE(digit, std::string_view::npos);
    bits = bits << 6U | static_cast<std::uint32_t>(digit);
    have += 6;
    if (have >= 8) {
      have -= 8;
      bytes += static_cast<char>(bits >> static_cast<unsigned>(have) & 0xFFU);
    }
  }
  std::vector<Number> values(bytes.size() / sizeof(Number));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(Number));
  return values;
}

}  // namespace

TEST(Report, has_a_map_of_the_template_where_there_is_one) {
  const auto run = recording_of(synthetic_run());
  EXPECT_EQ(page_of(run).find("A map before the needle"), std::string::npos);
  EXPECT_TRUE(data_of(run)["map"].is_null());

  const auto regions = region_views(run.mesh, run.info.target_regions);
  const HoleMap map = synthetic_map();
  const auto page = report_html(run, regions, find_moments(run.frames), {{}, "no driver"}, &map);
  ASSERT_TRUE(page);
  expect_says(*page, {"A map before the needle", "There is no rectum in this model."});
  EXPECT_EQ(page->find("There is no urethra in this model."), std::string::npos);
  EXPECT_NE(page->find("e3.5 (planned)"), std::string::npos);
  EXPECT_NE(page->find("the target&#39;s far end lies 210"), std::string::npos) << "why a hole has no figures";
  const auto data = nlohmann::json::parse(report_data(run, regions, find_moments(run.frames), &map)).at("map");
  ASSERT_EQ(data.at("holes").size(), map.holes.size());
  EXPECT_EQ(data.at("missing"), map.missing);
  EXPECT_EQ(data.at("columns").size() * data.at("rows").size(),
            map.holes.size() + static_cast<std::size_t>(map.missing));
  for (std::size_t k = 0; k < map.holes.size(); ++k) {
    const auto& hole = data.at("holes")[k];
    EXPECT_EQ(hole.at("hole"), map.holes[k].hole);
    EXPECT_TRUE(hole.at("clearance_mm").at("rectum").is_null());
    EXPECT_EQ(hole.at("predicted"), map.holes[k].prediction.has_value());
    EXPECT_EQ(hole.at("tip_error_mm").is_null(), !map.holes[k].prediction.has_value());
  }
}

TEST(Report, with_needles_in_place_says_so_and_from_where_the_figures_of_the_map_count) {
  const auto run = recording_of(synthetic_run());
  const auto regions = region_views(run.mesh, run.info.target_regions);
  const auto page_with = [&](const HoleMap& map) {
    return report_html(run, regions, find_moments(run.frames), {{}, "no driver"}, &map).value();
  };
  EXPECT_EQ(page_with(synthetic_map()).find("Needles are in place"), std::string::npos);
  EXPECT_EQ(page_with(synthetic_map()).find("Tip off the planned tissue"), std::string::npos);
  const std::string page = page_with(synthetic_map_beside_needles());
  expect_says(page, {"Needles are in place in the holes B4, F4", "mm from its place at rest",
                     "Needle in place, hole B4: it scraped.", "Tip off the planned tissue"});

  auto beside = synthetic_run();
  EXPECT_EQ(page_of(recording_of(beside)).find("Needles were in place"), std::string::npos);
  const HoleMap map = synthetic_map_beside_needles();
  ASSERT_NE(needles_in_place(map), nullptr);
  beside.summary.in_place = *needles_in_place(map);
  const std::string told = page_of(recording_of(beside));
  expect_says(told, {"Needles were in place in the holes B4, F4, and stayed.", "by 2.00 mm before"});
}

TEST(Report, tells_what_happened_from_the_data) {
  auto run = synthetic_run();
  const std::string page = page_of(recording_of(run));
  expect_says(page, {"76.0 mm beyond the entry point", "went through the skin at 7.0 mm under an axial force of 1.10 N",
                     "For the first 4.0 mm the tissue stuck to it",
                     "2.7 mm towards the head, 0.5 mm forwards and 0.2 mm to the patient&#39;s left",
                     "back in its initial shape", "Not a medical device."});
  for (const auto& parameter : run.info.parameters) {
    EXPECT_NE(page.find(html_escaped(parameter.source)), std::string::npos);
  }
  for (const auto& support : run.info.supports) EXPECT_NE(page.find(support), std::string::npos);
  for (const auto& warning : run.info.warnings) EXPECT_EQ(count(page, warning), 1U);

  run.frames.back().displacement[0] = 0.4;
  EXPECT_NE(page_of(recording_of(run)).find("still displaced by up to 0.40 mm"), std::string::npos);
}

TEST(Report, a_run_that_ends_inside_the_tissue_is_told_as_such) {
  auto run = synthetic_run();
  run.summary.events.resize(5);  // up to the entry into the prostate
  std::erase_if(run.frames, [](const Frame& f) { return f.time_s > 3; });
  std::erase_if(run.steps, [](const Step& s) { return s.time_s > 3; });
  const auto recording = recording_of(run);
  std::string story;
  for (const auto& p : tell_what_happened(recording, find_moments(recording.frames))) story += p + "\n";
  EXPECT_EQ(story.find("drawn"), std::string::npos);
  EXPECT_NE(story.find("entered the prostate"), std::string::npos);
}

TEST(Report, directions_are_words_of_the_patient_frame) {
  EXPECT_EQ(describe_shift({1, 0, 0}), "1.0 mm to the patient's left");
  EXPECT_EQ(describe_shift({-1, 0, 0}), "1.0 mm to the patient's right");
  EXPECT_EQ(describe_shift({0, 2, -3}), "3.0 mm towards the feet and 2.0 mm backwards");
  EXPECT_EQ(describe_shift({0.01, 0, -0.02}), "less than 0.05 mm in any direction");
}

TEST(Report, tells_how_far_the_tip_lies_from_its_planned_place) {
  auto run = synthetic_run();
  const auto says = [&](const char* text) { return page_of(recording_of(run)).find(text) != std::string::npos; };
  EXPECT_TRUE(
      says("the tip was off its target by 2.2 mm (2.1 mm towards the feet, 0.4 mm to "
           "the patient"));
  run.summary.tip_error_mm.reset();
  EXPECT_FALSE(says("off its target by"));
}

TEST(Report, tells_how_the_gland_moved_in_anatomical_words) {
  auto run = synthetic_run();
  const std::string page = page_of(recording_of(run));
  expect_says(page,
              {"broke through its surface, the prostate as a whole had moved by 1.84 mm superior, 0.31 mm anterior and "
               "0.12 mm left",
               "it was back", "<td>sagittal</td><td class=\"number\">1.250</td><td>base to anterior</td>",
               "<td>coronal</td><td class=\"number\">-0.500</td><td>base to the right</td>", "id=\"gland-depth\""});
  const auto data = data_of(recording_of(run));
  const auto si = numbers<float>(data["gland"]["SI_mm"]);
  ASSERT_EQ(si.size(), run.steps.size());
  for (std::size_t k = 0; k < si.size(); ++k)
    EXPECT_FLOAT_EQ(si[k], static_cast<float>(run.summary.gland_path[k].shift_mm.z()));

  run.summary.gland_path.clear();
  EXPECT_TRUE(data_of(recording_of(run))["gland"].is_null());
  EXPECT_EQ(page_of(recording_of(run)).find("id=\"gland-depth\""), std::string::npos);
  run.summary.gland.reset();
  EXPECT_EQ(page_of(recording_of(run)).find("How the gland moved"), std::string::npos);
}

TEST(Report, loads_nothing_from_anywhere) {
  const std::string page = page_of(recording_of(synthetic_run()));
  EXPECT_NE(page.find("Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; style-src "
                      "'unsafe-inline'; img-src data: blob:\""),
            std::string::npos);
  const std::string visible = markup(page);
  expect_silent(visible, {"http:", "https:", "<link", "<iframe"});
  const std::string style = between(page, "<style>", "</style>");
  expect_silent(style, {"@import", "url("});
  EXPECT_EQ(page.find("<script src"), std::string::npos);
  EXPECT_EQ(page.find("{{"), page.find("{{", page.find("report-data")));  // no placeholder is left before the scripts
}

TEST(Report, text_from_the_user_cannot_break_the_page) {
  auto run = synthetic_run();
  const std::string evil = "</script><script>alert('x')</script><!-- \" & {{title}}";
  run.info.scenario_name = evil;
  run.info.scenario_text = evil;
  run.info.method = evil;
  run.info.supports = {evil};
  run.info.warnings = {evil};
  run.info.parameters = {{evil, evil, evil, evil}};
  run.summary.events[0].region = evil;
  run.mesh.regions[0] = evil;
  const std::string page = page_of(recording_of(run));
  EXPECT_EQ(count(page, "<script"), 2U);  // the data and the program
  EXPECT_EQ(count(page, "</script"), 2U);
  EXPECT_EQ(count(page, "<!--"), 0U);
  EXPECT_EQ(page.find("alert('x')"), page.find("alert('x')", page.find("report-data")));
  const auto data = nlohmann::json::parse(between(page, "id=\"report-data\">", "</script>"));
  EXPECT_EQ(data["surface"]["regions"][0]["name"], evil);
}

TEST(Report, the_first_thing_that_is_punctured_is_the_skin_whatever_lies_under_it) {
  for (const char* region : {"body", "subcutaneous_fat", "levator"}) {
    auto run = synthetic_run();
    for (auto& event : run.summary.events) {
      if (event.kind == EventKind::puncture) event.region = region;
    }
    EXPECT_EQ(data_of(recording_of(run))["events"][1]["label"], "Went through the skin") << region;
  }
}

TEST(Report, its_data_are_those_of_the_run) {
  const auto run = synthetic_run();
  const auto data = data_of(recording_of(run));
  const auto axial = numbers<float>(data["steps"]["axial_N"]);
  const auto time = numbers<float>(data["steps"]["time_s"]);
  ASSERT_EQ(axial.size(), run.steps.size());
  for (std::size_t k = 0; k < axial.size(); ++k) {
    EXPECT_FLOAT_EQ(axial[k], static_cast<float>(run.steps[k].force_axial_N));
    EXPECT_FLOAT_EQ(time[k], static_cast<float>(run.steps[k].time_s));
  }
  ASSERT_EQ(data["frames"].size(), run.frames.size());
  EXPECT_EQ(data["frames"][data["first_frame"].get<std::size_t>()]["label"], "Deepest");
  EXPECT_EQ(data["events"].size(), run.summary.events.size());
  EXPECT_EQ(data["events"][1]["label"], "Went through the skin");

  // Every surface node is a mesh node with the same displacement, up to half a step of the scale.
  const auto points = numbers<float>(data["surface"]["points_mm"]);
  const double scale = data["displacement_scale_mm"];
  for (std::size_t f = 0; f < run.frames.size(); ++f) {
    const auto u = numbers<std::int16_t>(data["frames"][f]["displacement"]);
    ASSERT_EQ(u.size(), points.size());
    for (std::size_t p = 0; p < points.size(); p += 3 * 41) {
      const Vec3 place(points[p], points[p + 1], points[p + 2]);
      const auto node = std::min_element(
          run.mesh.nodes.begin(), run.mesh.nodes.end(),
          [&](const Vec3& a, const Vec3& b) { return (a - place).squaredNorm() < (b - place).squaredNorm(); });
      EXPECT_LT((*node - place).norm(), 1e-4);
      const auto n = static_cast<Eigen::Index>(node - run.mesh.nodes.begin());
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(u[p + static_cast<std::size_t>(k)] * scale, run.frames[f].displacement[3 * n + k], 0.501 * scale);
      }
    }
  }
  std::size_t steps = 0;
  for (const auto& n : data["histogram"]["counts"]) steps += n.get<std::size_t>();
  EXPECT_EQ(steps, run.steps.size());
}

TEST(Report, stays_small_for_three_thousand_nodes_and_sixty_frames) {
  const auto run = synthetic_run({{14, 12, 15}, 0.001, 49});
  ASSERT_GE(run.mesh.node_count(), 3000);
  ASSERT_EQ(run.frames.size(), 60U);
  EXPECT_LT(page_of(recording_of(run)).size(), 5U << 20U);  // eleven pictures add about 2 MB
}

TEST(Report, long_runs_are_thinned_but_keep_labelled_frames_and_force_peaks) {
  auto run = synthetic_run({{6, 6, 6}, 0.0001, 1});
  ASSERT_GT(run.steps.size(), 80000U);
  run.steps[41234].force_axial_N = 9.5;
  const Frame regular = run.frames[1].label.empty() ? run.frames[1] : run.frames[2];
  while (run.frames.size() < 6000) run.frames.insert(run.frames.end() - 1, regular);
  const auto data = data_of(recording_of(run));
  const auto axial = numbers<float>(data["steps"]["axial_N"]);
  EXPECT_LE(axial.size(), 40000U);
  EXPECT_EQ(*std::max_element(axial.begin(), axial.end()), 9.5F);
  EXPECT_LT(data["frames"].size(), 6000U);
  for (const Frame& frame : run.frames) {
    if (frame.label.empty()) continue;
    const auto has = [&](const nlohmann::json& f) { return f["label"] == readable_name(frame.label); };
    EXPECT_TRUE(std::any_of(data["frames"].begin(), data["frames"].end(), has)) << frame.label;
  }
}

TEST(Report, tissue_parameters_are_one_line_per_region_with_unit_and_source) {
  const std::vector<ParameterRow> rows{{"tissue.prostate.young_kPa", "40", "kPa", "Shoji 2018"},
                                       {"tissue.prostate.cutting_N", "0.25", "N", "scenario"},
                                       {"tissue.pubic_arch", "held", "", "bone"},
                                       {"tissue.body.young_kPa", "60", "kPa", "stated"},
                                       {"tissue.element", "p1", "", "scenario"},
                                       {"needle.length_mm", "200", "mm", "scenario"}};
  const std::string html = parameter_tables(rows);
  EXPECT_EQ(count(html, "<tr>"), 2U + 5U);  // two header rows, three tissues, two rows for all tissue
  expect_says(
      html, {"<code>young_<wbr>kPa</code><br>[kPa]",
             "<td>Prostate</td><td class=\"number\">40</td><td class=\"number\">0.25</td>",
             "<code>young_kPa</code>: Shoji 2018",
             "<td>Pubic arch</td><td colspan=\"2\">held</td><td class=\"source\">bone</td>",
             "<td>Body</td><td class=\"number\">60</td><td class=\"number\">–</td>", "<code>needle.length_mm</code>"});
}

TEST(ReportText, numbers_stay_with_their_units) {
  EXPECT_EQ(html_prose("0.42 N at 3 mm, 5 seconds & 3 mmHg"), "0.42&nbsp;N at 3&nbsp;mm, 5 seconds &amp; 3 mmHg");
}

TEST(ReportText, base64_follows_rfc_4648) {
  const auto encode = [](std::string_view text) { return base64(std::as_bytes(std::span(text))); };
  EXPECT_EQ(encode(""), "");
  EXPECT_EQ(encode("f"), "Zg==");
  EXPECT_EQ(encode("fo"), "Zm8=");
  EXPECT_EQ(encode("foo"), "Zm9v");
  EXPECT_EQ(encode("foobar"), "Zm9vYmFy");
  EXPECT_EQ(encode("\xff\xfe\xfd"), "//79");
}

TEST(ReportText, scripts_cannot_end_their_element) {
  EXPECT_EQ(script_safe("a=\"</SCRIPT>\"; b='<!--'"), "a=\"<\\/SCRIPT>\"; b='<\\!--'");
  EXPECT_EQ(script_safe("if (a<b) c"), "if (a<b) c");
  EXPECT_EQ(json_script_safe("{\"a\":\"</script>\"}"), "{\"a\":\"\\u003c/script>\"}");
}

TEST(RegionViews, a_face_between_two_regions_belongs_to_the_inner_one) {
  const auto run = synthetic_run();
  const auto views = region_views(run.mesh, run.info.target_regions);
  ASSERT_EQ(views.size(), run.mesh.regions.size());
  EXPECT_TRUE(views[0].background);
  EXPECT_EQ(views[0].name, "body");
  for (const auto& view : views) {
    EXPECT_EQ(view.target, view.name == "prostate");
    for (const auto& t : view.triangles) {
      const auto on_outside = [&](Index n) {
        const Vec3& x = run.mesh.nodes[static_cast<std::size_t>(n)];
        return std::abs(x.x()) > 59.99 || std::abs(x.y()) > 49.99 || x.z() < 0.01 || x.z() > 119.99;
      };
      if (view.background) {
        EXPECT_TRUE(on_outside(t[0]) && on_outside(t[1]) && on_outside(t[2]));
      }
    }
  }
  for (std::size_t a = 1; a < views.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) EXPECT_NE(views[a].colour, views[b].colour);
  }
}

TEST(RegionViews, names_are_written_for_people_and_bones_look_alike) {
  EXPECT_EQ(readable_name("pubic_arch"), "Pubic arch");
  EXPECT_EQ(readable_name("ptv"), "PTV");
  auto run = synthetic_run();
  run.mesh.regions = {"body", "ptv", "bladder", "rectum", "femur_left", "femur_right"};
  const auto views = region_views(run.mesh, std::vector{1});
  EXPECT_EQ(views[4].colour, views[5].colour);
  EXPECT_NE(views[1].colour, views[2].colour);
}

TEST(RegionViews, surfaces_point_outward) {
  const auto run = synthetic_run();
  for (const auto& view : region_views(run.mesh, run.info.target_regions)) {
    if (view.name != "prostate") continue;
    double volume = 0;
    for (const auto& t : view.triangles) {
      const auto at = [&](int k) -> const Vec3& {
        return run.mesh.nodes[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])];
      };
      volume += at(0).dot(at(1).cross(at(2))) / 6;
    }
    double expected = 0;
    for (Index t = 0; t < run.mesh.tet_count(); ++t) {
      if (run.mesh.tet_region[static_cast<std::size_t>(t)] == view.region) expected += tet_volume(run.mesh, t);
    }
    EXPECT_NEAR(volume, expected, 1e-6 * expected);
  }
}
