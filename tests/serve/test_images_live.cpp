// SPDX-License-Identifier: GPL-3.0-or-later
// Ultrasound and X-ray over the live protocol.
#include "rectum_case.hpp"

using namespace stylet;
using namespace stylet::test;

namespace {

serve::CaseSource case_with_probe() {
  return {"with a probe", [](const Progress& progress) -> Result<serve::LoadedCase> {
            Scenario scenario = hole_scenario();
            scenario.probe.kind = ProbeKind::biplane;
            auto model = Model::compile(scenario, patient_with_rectum(), "case.toml", {}, progress);
            if (!model) return model.error();
            return serve::LoadedCase{*model, {}};
          }};
}

/// A page that holds the needle.
struct Imaging {
  Serving serving;
  std::unique_ptr<LiveClient> page = ready_client(serving);

  explicit Imaging(const serve::CaseSource& source)
      : serving([&](serve::ServerSettings& s) { s.session.cases = {source}; }) {
    EXPECT_TRUE(page->take());
  }
};

}  // namespace

TEST(LiveImages, come_while_a_page_looks_at_them) {
  Imaging at(case_with_rectum());
  LiveClient& page = *at.page;
  EXPECT_EQ(page.status["image"]["shown"], "none");
  EXPECT_EQ(page.images, 0u);
  page.command(R"({"do":"image","show":"transverse"})");
  ASSERT_TRUE(page.until([&] { return page.images > 0; }));
  EXPECT_EQ(page.image["modality"], "ultrasound");
  EXPECT_EQ(page.image["array"], "transverse");
  EXPECT_GT(*std::max_element(page.pixels.begin(), page.pixels.end()), 100);
  const double z = page.image["probe"]["depth_mm"];
  // The stepper moves the array.
  page.command(R"({"do":"set","key":"probe.depth_mm","value":)" + std::to_string(z + 5.0) + "}");
  ASSERT_TRUE(page.until([&] { return std::abs(page.image["probe"]["depth_mm"].get<double>() - z - 5.0) < 1e-6; }));
  EXPECT_NEAR(page.image["origin_mm"][2], z + 5.0, 1e-6);
  page.command(R"({"do":"image","show":"sagittal"})");
  ASSERT_TRUE(page.until([&] { return page.image["array"] == "sagittal"; }));
  EXPECT_EQ(page.image["sector_deg"], 0.0);
  page.command(R"({"do":"image","show":"xray"})");
  ASSERT_TRUE(page.until([&] { return page.image["modality"] == "xray"; }));
  page.command(R"({"do":"image","show":"none"})");
  ASSERT_TRUE(page.until([&] { return page.status["image"]["shown"] == "none"; }));
}

TEST(LiveImages, what_cannot_be_is_said_in_words) {
  Imaging at(box_case("without a rectum"));
  LiveClient& page = *at.page;
  page.command(R"({"do":"image","show":"transverse"})");
  ASSERT_TRUE(page.until([&] { return !page.status["image"]["problem"].get<std::string>().empty(); }));
  EXPECT_NE(page.status["image"]["problem"].get<std::string>().find("no rectum"), std::string::npos);
  // X-ray needs no rectum.
  page.command(R"({"do":"image","show":"xray"})");
  ASSERT_TRUE(page.until([&] { return page.images > 0 && page.status["image"]["problem"] == ""; }));
}

TEST(LiveImages, show_the_needle_and_a_replay) {
  Imaging at(case_with_rectum());
  LiveClient& page = *at.page;
  page.command(R"({"do":"image","show":"xray"})");
  ASSERT_TRUE(page.until([&] { return page.images > 0 && page.time_s > 0.1; }));
  page.command(R"({"do":"set","key":"fluoroscopy.photons","value":0})");
  page.command(R"({"do":"set","key":"fluoroscopy.angle_deg","value":1})");
  ASSERT_TRUE(page.until([&] { return page.image["angle_deg"] == 1.0; }));
  const std::vector<unsigned char> without = page.pixels;
  ASSERT_TRUE(page.go_to(28.0F, 100.0F));
  ASSERT_TRUE(page.until([&] {  // the needle is in the picture
    std::size_t darker = 0;
    for (std::size_t k = 0; k < without.size(); ++k) darker += page.pixels[k] + 10 < without[k] ? 1 : 0;
    return darker > 100;
  }));
  const std::string name = page.recording();
  ASSERT_TRUE(page.replay(name));
  page.command(R"({"do":"seek","time_s":1000})");
  const auto live = page.images;
  ASSERT_TRUE(page.until([&] { return page.images > live && page.image["time_s"].get<double>() > 0.0; }));
  page.command(R"({"do":"set","key":"fluoroscopy.angle_deg","value":35})");
  ASSERT_TRUE(page.until([&] { return page.image["angle_deg"] == 35.0; })) << "a replay can be looked at otherwise";
}

TEST(LiveImages, of_a_replay_have_the_probe_where_it_was_and_it_presses) {
  Imaging at(case_with_probe());
  LiveClient& page = *at.page;
  const auto lift = [&](double mm) {
    page.command(R"({"do":"set","key":"probe.lift_mm","value":)" + std::to_string(mm) + "}");
    return page.until([&] { return page.images > 0 && page.image["probe"]["lift_mm"] == mm; });
  };
  page.command(R"({"do":"image","show":"transverse"})");
  ASSERT_TRUE(lift(4.0));
  ASSERT_TRUE(page.go_to(28.0F, 100.0F));
  const double low_s = page.time_s;
  ASSERT_TRUE(page.until([&] { return page.time_s > low_s + 0.2; }));
  ASSERT_TRUE(lift(8.0));
  ASSERT_TRUE(page.until([&] { return page.image["probe"]["force_N"].is_number(); }));
  const double force_N = page.image["probe"]["force_N"];
  EXPECT_GT(force_N, 0.1);
  ASSERT_TRUE(page.go_to(10.0F, 100.0F));
  const std::string name = page.recording();
  ASSERT_TRUE(page.replay(name));
  const auto shows = [&](double mm) {
    return page.until(
        [&] { return page.image["probe"]["lift_mm"] == mm && page.image["probe"]["force_N"].is_number(); });
  };
  page.command(R"({"do":"seek","time_s":)" + std::to_string(low_s) + "}");
  EXPECT_TRUE(shows(4.0));
  page.command(R"({"do":"seek","time_s":1000})");
  EXPECT_TRUE(shows(8.0));
  EXPECT_NEAR(page.image["probe"]["force_N"], force_N, 0.02 * force_N);
  EXPECT_EQ(page.status["image"]["problem"], "");
  // A page looks at the replay with another place of the probe, which does not move the live one.
  ASSERT_TRUE(lift(2.0));
  page.command(R"({"do":"seek","time_s":)" + std::to_string(low_s) + "}");
  ASSERT_TRUE(page.until([&] { return std::abs(page.image["time_s"].get<double>() - low_s) < 1e-3; }));
  EXPECT_EQ(page.image["probe"]["lift_mm"], 2.0);
  ASSERT_TRUE(page.back_to_live());
  EXPECT_TRUE(shows(8.0));
}
