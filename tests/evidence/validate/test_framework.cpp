// SPDX-License-Identifier: GPL-3.0-or-later
// A validation with invented rows: rows that pass, are missed, are skipped or crash are all reported.
#include "stylet/evidence/validate/context.hpp"
#include "stylet/evidence/validate/validation.hpp"
#include "support/says.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <unistd.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

using namespace stylet;
using namespace stylet::test;
using namespace stylet::validate;
namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

RowSpec row(const std::string& id, Accepted accepted, std::function<Result<Finding>(Context&)> measure) {
  return {id, Group::analysis, "claim of " + id, "a <reference>", "N", accepted, true, std::move(measure)};
}

Finding found(double value) {
  Finding finding;
  finding.value = value;
  finding.note = "how it was measured.";
  finding.why_missed = "the known reason.";
  return finding;
}

std::vector<RowSpec> made_up_rows() {
  std::vector<RowSpec> rows{
      row("passes", Accepted::between(1.0, 2.0),
          [](Context&) -> Result<Finding> {
            Finding finding = found(1.5);
            finding.plot = {.x_label = "depth [mm]", .y_label = "force, \"axial\" [N]"};
            finding.plot.curves.push_back({.label = "ours", .x = {0, 1, 2}, .y = {0, 0.5, 1.5}});
            finding.plot.curves.push_back(
                {.label = "theirs", .x = {0, 2}, .y = {0, 1.4}, .kind = Curve::Kind::reference});
            return finding;
          }),
      row("misses", Accepted::at_most(1.0), [](Context&) -> Result<Finding> { return found(1.5); }),
      row("skips", Accepted::at_most(1.0),
          [](Context& context) -> Result<Finding> { return Finding::skip(context.no_data("some/file.csv")); }),
      row("informs", Accepted::information(), [](Context&) -> Result<Finding> { return found(7.0); }),
      row("fails", Accepted::at_most(1.0),
          [](Context&) -> Result<Finding> { return failure("a place", "it broke", "Mend it"); }),
      row("throws", Accepted::at_most(1.0), [](Context&) -> Result<Finding> { throw std::runtime_error("thrown"); }),
  };
  rows.push_back(row("long_one", Accepted::at_most(1.0), [](Context&) -> Result<Finding> { return found(0.5); }));
  rows.back().quick = false;
  return rows;
}

Validation made_up(ValidateOptions options = {}) {
  options.data = "/nowhere";
  options.command = "stylet validate <&>";
  auto validation = validate::validate(made_up_rows(), options);
  EXPECT_TRUE(validation.ok());
  return std::move(validation).value();
}

const Row& row_of(const Validation& validation, const std::string& id) {
  for (const Row& r : validation.rows)
    if (r.spec.id == id) return r;
  throw std::runtime_error("no row " + id);
}

std::string text_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

}  // namespace

TEST(Accepted, holds_between_its_bounds_and_never_for_what_is_no_number) {
  EXPECT_TRUE(Accepted::between(1, 2).holds(1.0));
  EXPECT_TRUE(Accepted::between(1, 2).holds(2.0));
  EXPECT_FALSE(Accepted::between(1, 2).holds(2.001));
  EXPECT_FALSE(Accepted::at_least(1).holds(0.999));
  EXPECT_FALSE(Accepted::at_most(1).holds(std::nan("")));
  EXPECT_FALSE(Accepted::information().any());
  EXPECT_EQ(Accepted::at_most(1e-10).text(), "≤ 1e-10");
}

TEST(Validation, every_row_gets_its_verdict_and_none_stops_the_others) {
  const Validation v = made_up();
  ASSERT_EQ(v.rows.size(), 7u);
  EXPECT_EQ(row_of(v, "passes").verdict, Verdict::pass);
  EXPECT_EQ(row_of(v, "misses").verdict, Verdict::missed);
  EXPECT_EQ(row_of(v, "skips").verdict, Verdict::skipped);
  EXPECT_EQ(row_of(v, "informs").verdict, Verdict::information);
  EXPECT_EQ(row_of(v, "fails").verdict, Verdict::crashed);
  EXPECT_EQ(row_of(v, "throws").verdict, Verdict::crashed);
  EXPECT_EQ(row_of(v, "long_one").verdict, Verdict::pass);
  EXPECT_EQ(v.count(Verdict::crashed), 2);
  // A missed row gives the reason; a row that passes does not.
  EXPECT_NE(row_of(v, "misses").note().find("the known reason"), std::string::npos);
  EXPECT_EQ(row_of(v, "passes").note().find("the known reason"), std::string::npos);
  EXPECT_NE(row_of(v, "skips").note().find("/nowhere/some/file.csv"), std::string::npos);
  EXPECT_NE(row_of(v, "fails").note().find("it broke"), std::string::npos);
  EXPECT_EQ(row_of(v, "throws").note().find("thrown"), std::string::npos) << "an exception has no words for a user";
  EXPECT_FALSE(row_of(v, "throws").note().empty());
}

TEST(Validation, quick_leaves_long_rows_out_unless_they_are_named) {
  EXPECT_EQ(made_up({.quick = true}).rows.size(), 6u);
  const Validation named = made_up({.quick = true, .only = {"long_one", "passes"}});
  ASSERT_EQ(named.rows.size(), 2u);
  EXPECT_EQ(named.rows[0].spec.id, "passes");  // in the order of the table
}

TEST(Validation, an_unknown_row_is_an_input_error_with_the_nearest_name) {
  const auto refused = validate::validate(made_up_rows(), {.only = {"passses"}});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::input);
  EXPECT_NE(refused.error().message().find("'passes'"), std::string::npos) << refused.error().message();
}

TEST(Validation, json_has_the_promised_keys_and_null_where_nothing_was_judged) {
  const Json json = Json::parse(validation_json(made_up()));
  EXPECT_EQ(json["passed"], 2);
  EXPECT_EQ(json["missed"], 1);
  EXPECT_EQ(json["skipped"], 1);
  EXPECT_EQ(json["crashed"], 2);
  ASSERT_EQ(json["rows"].size(), 7u);
  for (const Json& r : json["rows"]) {
    for (const char* key : {"id", "claim", "reference", "value", "unit", "tolerance", "pass", "note", "group",
                            "verdict", "skipped", "seconds", "curves", "csv"})
      EXPECT_TRUE(r.contains(key)) << key;
  }
  EXPECT_EQ(json["rows"][0]["pass"], true);
  EXPECT_EQ(json["rows"][0]["csv"], "passes.csv");
  EXPECT_EQ(json["rows"][1]["pass"], false);
  EXPECT_EQ(json["rows"][1]["value"], 1.5);
  EXPECT_TRUE(json["rows"][2]["pass"].is_null());
  EXPECT_TRUE(json["rows"][2]["value"].is_null());
  EXPECT_TRUE(json["rows"][3]["pass"].is_null());
}

TEST(Validation, the_page_shows_misses_at_the_top_and_in_their_row) {
  const auto page = validation_page(made_up());
  ASSERT_TRUE(page.ok()) << page.error().message();
  expect_says(*page,
              {"2 of 3 judged claims pass, 1 is MISSED.", "<a href=\"#misses\">claim of misses</a>", "<i>✗</i>MISSED",
               "the known reason.", "<i>–</i>skipped", "<i>!</i>crashed", "id=\"plot-passes\"", "a &lt;reference&gt;"});
  EXPECT_EQ(page->find("{{"), std::string::npos) << "an unfilled slot";
  EXPECT_EQ(page->find("http://"), std::string::npos) << "self-contained";
}

TEST(Validation, the_folder_holds_page_numbers_and_every_curve) {
  const fs::path folder = fs::temp_directory_path() / ("stylet-validate-" + std::to_string(::getpid()));
  fs::remove_all(folder);
  ASSERT_TRUE(write_validation(made_up(), folder / "out").ok());
  EXPECT_TRUE(fs::exists(folder / "out" / "validate.html"));
  EXPECT_EQ(text_of(folder / "out" / "validate.json").front(), '{');
  EXPECT_EQ(text_of(folder / "out" / "passes.csv"),
            "curve,\"depth [mm]\",\"force, \"\"axial\"\" [N]\"\n\"ours\",0,0\n\"ours\",1,0.5\n\"ours\",2,1.5\n"
            "\"theirs\",0,0\n\"theirs\",2,1.4\n");
  EXPECT_FALSE(fs::exists(folder / "out" / "misses.csv"));
  fs::remove_all(folder);
}
