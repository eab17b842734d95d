// SPDX-License-Identifier: GPL-3.0-or-later
// Source models, points and goals from files.
#include "io/dose/dose_folder.hpp"
#include "stylet/dose/known_sources.hpp"
#include "stylet/dose/tg43.hpp"
#include "stylet/io/dose_io.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace stylet {
namespace {

using Json = nlohmann::json;

/// A source model as docs/formats.md describes it.
Json json_of(const SourceModel& s) {
  Json values = Json::array();
  for (Eigen::Index i = 0; i < s.F.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < s.F.cols(); ++j)
      row.push_back(std::isnan(s.F(i, j)) ? Json(nullptr) : Json(s.F(i, j)));
    values.push_back(row);
  }
  return {{"format", "stylet-source"},
          {"version", 1},
          {"name", s.name},
          {"title", s.title},
          {"isotope", s.isotope},
          {"citation", s.citation},
          {"half_life_days", s.half_life_days},
          {"dose_rate_constant", s.dose_rate_constant},
          {"active_length_mm", s.active_length_mm},
          {"outer_length_mm", s.outer_length_mm},
          {"outer_diameter_mm", s.outer_diameter_mm},
          {"g", {{"r_mm", s.g_r_mm}, {"g_L", s.g}}},
          {"F", {{"r_mm", s.F_r_mm}, {"theta_deg", s.F_theta_deg}, {"values", values}}}};
}

class SourceFile : public testing_files::InFolder {
 protected:
  void expect_error(const Json& json, const std::string& part) const {
    testing_files::expect_refused(read_source_model(file("source.json", json.dump())), part);
  }
};

TEST_F(SourceFile, gives_the_dose_rate_of_the_same_model_in_the_program) {
  for (const SourceModel& known : known_sources()) {
    const SourceModel source = read_source_model(file("source.json", json_of(known).dump())).value();
    const Tg43 a = Tg43::create(known, DoseFormalism::line2d).value();
    const Tg43 b = Tg43::create(source, DoseFormalism::line2d).value();
    for (const double r : {1.0, 3.3, 12.0, 77.0}) {
      for (const double c : {-0.9, 0.0, 0.4, 1.0}) EXPECT_NEAR(b.rate(r, c) / a.rate(r, c), 1.0, 1e-12) << known.name;
    }
  }
}

TEST_F(SourceFile, names_the_fault_of_a_table) {
  const Json good = json_of(find_source("i125_6711").value());
  Json wrong = good;
  wrong["G"] = 3;
  expect_error(wrong, "'G'");
  wrong = good;
  wrong.erase("F");
  expect_error(wrong, "'F' is missing");
  wrong = good;
  wrong["F"]["values"].erase(0);
  expect_error(wrong, "one row for each angle");
  wrong = good;
  wrong["F"]["values"][3].push_back(1.0);
  expect_error(wrong, "row 4");
  wrong = good;
  wrong["dose_rate_constant"] = -1;
  expect_error(wrong, "source.json");
  wrong = good;
  wrong["half_life_days"] = "59 days";
  expect_error(wrong, "'half_life_days'");
}

TEST_F(SourceFile, with_radii_in_cm_is_told_so) {
  Json json = json_of(find_source("i125_6711").value());
  for (auto& r : json["g"]["r_mm"]) r = r.get<double>() / 10.0;
  expect_error(json, "in cm");
}

class DoseTables : public testing_files::InFolder {};

TEST_F(DoseTables, have_points_in_their_order) {
  const auto points = read_points(file("points.csv", "name,z_mm,y_mm,x_mm\na,3,2,1\n\"b, c\",6,5,4\n")).value();
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0], Vec3(1, 2, 3));
  EXPECT_EQ(points[1], Vec3(4, 5, 6));
  EXPECT_FALSE(read_points(file("bad.csv", "x_mm,y_mm\n1,2\n")).ok());
  EXPECT_FALSE(read_points(file("bad2.csv", "x_mm,y_mm,z_mm\n1,2,inf\n")).ok());
  EXPECT_FALSE(read_points(folder / "absent.csv").ok());
}

TEST_F(DoseTables, have_goals_with_bounds_and_citations) {
  const auto goals = read_goals(file("goals.csv",
                                     "structure,metric,bound,citation\nprostate,D90_percent,>=90,ours\n"
                                     "rectum,D2cc_Gy,<145,\"a, b\"\n"))
                         .value();
  ASSERT_EQ(goals.size(), 2U);
  EXPECT_TRUE(goals[0].at_least);
  EXPECT_EQ(goals[0].bound, 90.0);
  EXPECT_FALSE(goals[1].at_least);
  EXPECT_EQ(goals[1].citation, "a, b");
  EXPECT_FALSE(read_goals(file("bad.csv", "structure,metric,bound,citation\nprostate,D90,>=90,x\n")).ok());
  EXPECT_FALSE(read_goals(file("bad2.csv", "structure,metric,bound,citation\nprostate,D90_Gy,90,x\n")).ok());
  EXPECT_FALSE(read_goals(file("bad3.csv", "structure,metric,citation\nprostate,D90_Gy,x\n")).ok());
}

}  // namespace
}  // namespace stylet
