// SPDX-License-Identifier: GPL-3.0-or-later
// The examples of plans, sources and goals in docs/formats.md are read as the text says.
#include "io/dose/dose_folder.hpp"
#include "stylet/io/dose_io.hpp"

#include <gtest/gtest.h>

namespace stylet {
namespace {

class DoseDocumentation : public testing_files::InFolder {
 protected:
  /// The example in docs/formats.md that contains a text, as a file.
  [[nodiscard]] std::filesystem::path example(const std::string& with, const std::string& name) const {
    const std::string text = test::content_of(STYLET_SOURCE_DIR "/docs/formats.md");
    const auto at = text.find(with);
    EXPECT_NE(at, std::string::npos) << with;
    const auto begin = text.find('\n', text.rfind("```", at)) + 1;
    return file(name, text.substr(begin, text.find("```", begin) - begin));
  }
};

TEST_F(DoseDocumentation, has_a_plan_whose_seeds_lie_where_the_text_says) {
  const auto plan = test::value_of(read_plan(example("\"stylet-plan\"", "plan.json")));
  ASSERT_EQ(plan.sources.size(), 4U);
  // Hole d3.5 lies 5 mm left and 5 mm posterior of D4, the retraction plane 5 mm inferior of the base plane at z = 40
  // mm. Seeds and spacers alternate, so the seeds are 10 mm and 4.5 + 2 · 5.5 = 15.5 mm apart.
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_LT((plan.sources[k + 1].at_mm - Vec3(5, 10, std::array{35.0, 25.0, 9.5}[k])).norm(), 1e-9) << k;
  EXPECT_EQ(plan.prescription_Gy, 145.0);
}

TEST_F(DoseDocumentation, has_a_source_model_that_can_be_read) {
  const auto source = test::value_of(read_source_model(example("\"stylet-source\"", "source.json")));
  EXPECT_EQ(source.title, "My seed");
}

TEST_F(DoseDocumentation, has_goals_that_can_be_read) {
  const auto goals = test::value_of(read_goals(example("structure,metric,bound,citation\nprostate", "goals.csv")));
  EXPECT_EQ(goals.size(), 2U);
}

}  // namespace
}  // namespace stylet
