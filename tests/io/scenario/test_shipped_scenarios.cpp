// SPDX-License-Identifier: GPL-3.0-or-later
#include "support.hpp"

#include "stylet/phantom/phantom.hpp"

#include <algorithm>

using namespace stylet;
using namespace stylet::test;

namespace {

const std::filesystem::path kSource = STYLET_SOURCE_DIR;

std::vector<std::filesystem::path> shipped() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kSource / "scenarios")) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  return files;
}

const Roi& structure(const ContourSet& patient, const std::string& name) {
  return *std::find_if(patient.rois.begin(), patient.rois.end(), [&](const Roi& roi) { return roi.name == name; });
}

/// Whether a point is inside a contour, by the even–odd rule.
bool inside(const Contour& contour, double x, double y) {
  bool in = false;
  for (std::size_t i = 0, j = contour.points.size() - 1; i < contour.points.size(); j = i++) {
    const Vec3& a = contour.points[i];
    const Vec3& b = contour.points[j];
    if ((a.y() > y) != (b.y() > y) && x < (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()) + a.x()) in = !in;
  }
  return in;
}

/// Heights of the slices in which a line along z lies inside the structure.
std::vector<double> heights_inside(const Roi& roi, double x, double y) {
  std::vector<double> heights;
  for (const Contour& contour : roi.contours) {
    if (inside(contour, x, y)) heights.push_back(contour.points.front().z());
  }
  return heights;
}

/// Distance in the slices between a line along z and the structure's outline [mm].
double clearance(const Roi& roi, double x, double y) {
  double nearest = 1e9;
  for (const Contour& contour : roi.contours) {
    for (const Vec3& point : contour.points) nearest = std::min(nearest, std::hypot(point.x() - x, point.y() - y));
  }
  return nearest;
}

}  // namespace

TEST(ShippedScenarios, are_read_without_complaint) {
  EXPECT_GE(shipped().size(), 3U);
  for (const auto& file : shipped()) {
    const auto scenario = read_scenario(file);
    EXPECT_TRUE(scenario.ok()) << scenario.error().message();
  }
}

TEST(ShippedScenarios, stay_complete_when_their_comments_are_taken_away) {
  const Folder folder;
  for (const auto& file : shipped()) {
    std::string text;
    std::istringstream stream(content_of(file));
    for (std::string line; std::getline(stream, line);) text += line.starts_with('#') ? "\n" : line + "\n";
    EXPECT_TRUE(read_scenario(write_file(folder / file.filename(), text)).ok()) << file;
  }
}

TEST(ShippedScenarios, show_keys_in_their_comments_that_exist) {
  // A user may remove the # from "# key = value" and "# [table]" in a comment.
  for (const auto& file : shipped()) {
    std::istringstream stream(content_of(file));
    std::string table;
    Scenario scratch;
    for (std::string line; std::getline(stream, line);) {
      const bool comment = line.starts_with("# ");
      const std::string text = comment ? line.substr(2) : line;
      if (text.starts_with("[")) {
        table = text.substr(text.find_first_not_of('['), text.find(']') - text.find_first_not_of('['));
        continue;
      }
      const auto equals = text.find(" = ");
      if (!comment || equals == std::string::npos || text.find(' ') != equals || text.starts_with("\"")) continue;
      const auto& keys = scenario_keys();
      const std::string key = text.substr(0, equals);
      EXPECT_TRUE(std::any_of(keys.begin(), keys.end(),
                              [&](const ScenarioKey& k) {
                                return k.path == table + "." + key || k.path == table + "[]." + key ||
                                       (table.starts_with("tissue.") && k.path == "tissue.<region>." + key);
                              }))
          << file << ": [" << table << "] " << key;
    }
  }
}

TEST(ShippedScenarios, examples_are_ten_lines_or_so_and_name_no_folder_of_anyone) {
  const std::string mask = content_of(kSource / "scenarios/examples/mask.toml");
  EXPECT_LE(std::count(mask.begin(), mask.end(), '\n'), 10);
  for (const auto& file : shipped()) EXPECT_EQ(content_of(file).find("shared"), std::string::npos) << file;
}

TEST(DemoScenario, goes_through_the_gland_and_past_urethra_rectum_and_pubic_arch) {
  const auto scenario = value_of(read_scenario(kSource / "scenarios/demo.toml"));
  ASSERT_EQ(scenario.patient.source, "phantom");
  ASSERT_EQ(scenario.insertions.size(), 1U);
  ASSERT_TRUE(scenario.insertions[0].hole.has_value());
  const auto offset = value_of(scenario.grid.offset_mm(*scenario.insertions[0].hole));

  const ContourSet patient = demo_patient({.seed = 0, .slice_spacing_mm = 1.0});
  const Roi& gland = structure(patient, "Prostate");
  double area = 0.0;
  Vec3 centre = Vec3::Zero();
  for (const Contour& contour : gland.contours) {
    for (std::size_t i = 0, n = contour.points.size(); i < n; ++i) {
      const Vec3& a = contour.points[i];
      const Vec3& b = contour.points[(i + 1) % n];
      const double twice = a.x() * b.y() - b.x() * a.y();
      area += twice / 2;
      centre += twice / 6 * (a + b);
    }
  }
  centre /= area;
  const double x = centre.x() + offset[0];
  const double y = centre.y() - offset[1];

  const auto in_gland = heights_inside(gland, x, y);
  EXPECT_GE(in_gland.size(), 30U) << "mm of gland on the way";
  EXPECT_FALSE(heights_inside(structure(patient, "Body"), x, y).empty());
  for (const char* spared : {"Urethra", "Rectum", "Pubic arch"}) {
    EXPECT_TRUE(heights_inside(structure(patient, spared), x, y).empty()) << spared;
    EXPECT_GT(clearance(structure(patient, spared), x, y), 5.0) << spared << " [mm]";
  }
  const auto in_bladder = heights_inside(structure(patient, "Bladder"), x, y);
  if (!in_bladder.empty()) {
    EXPECT_GT(*std::min_element(in_bladder.begin(), in_bladder.end()),
              *std::max_element(in_gland.begin(), in_gland.end()))
        << "the way ends at the far end of the gland, before the bladder";
  }
}

TEST(ScenarioGuide, shows_the_keys_of_this_version) {
  const std::string guide = content_of(kSource / "docs/scenario.md");
  EXPECT_NE(guide.find("```toml\n" + schema_text() + "```"), std::string::npos)
      << "docs/scenario.md differs from stylet insert --print-schema: run scripts/update_reference";
}
