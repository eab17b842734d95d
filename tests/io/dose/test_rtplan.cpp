// SPDX-License-Identifier: GPL-3.0-or-later
// Plans as planning systems write them, with each of their known oddities.
#include "io/dose/dose_folder.hpp"
#include "io/dose/rtplan_files.hpp"
#include "stylet/dose/known_sources.hpp"
#include "stylet/io/dose_io.hpp"
#include "support/says.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

namespace stylet {
namespace {

namespace fs = std::filesystem;
using testing_files::Point;
using testing_files::put;
using testing_files::RtplanFile;

constexpr double kDay_s = 86400.0;
constexpr double kPermanent_s = 59.4 * kDay_s / 0.693147180559945;  // T½ / ln 2 of I-125

class Rtplan : public testing_files::InFolder {
 protected:
  [[nodiscard]] static RtplanFile seeds() { return {"LDR", "PERMANENT", "I-125", 59.4, "0.5"}; }
  [[nodiscard]] static RtplanFile hdr() { return {"HDR", "INTERSTITIAL", "Ir-192", 73.83, "40000"}; }

  /// Adds a setup with a seed.
  static DcmItem& add_seed(RtplanFile& plan, const Vec3& at, int setup = 1, int source = 1) {
    return RtplanFile::channel(plan.setup("UNDEFINED", setup), 1, kPermanent_s, 1.0, {{at, 0.0}, {at, 1.0}}, source);
  }

  Result<DosePlan> read(RtplanFile& plan) { return read_plan(plan.save(folder / "plan.dcm")); }
  void expect_error(RtplanFile& plan, const std::string& part) { testing_files::expect_refused(read(plan), part); }
};

bool says(const DosePlan& plan, const std::string& part) {
  return std::any_of(plan.notes.begin(), plan.notes.end(),
                     [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

TEST_F(Rtplan, has_one_setup_for_each_seed_in_any_order_and_an_undefined_one_without_channels) {
  RtplanFile plan = seeds();
  plan.setup("UNDEFINED", 99);
  for (const int k : {3, 1, 2}) {
    const Vec3 at(k, -2.0 * k, 10.0 * k);
    RtplanFile::channel(plan.setup("VAGINAL", k), 1, kPermanent_s, 1.0, {{at, 0.0}, {at, 1.0}});
  }
  const DosePlan read_back = read(plan).value();
  ASSERT_EQ(read_back.sources.size(), 3U);
  EXPECT_EQ(read_back.implant, Implant::permanent);
  EXPECT_EQ(read_back.sources[0].at_mm, Vec3(3, -6, 30));
  EXPECT_EQ(read_back.sources[0].strength_U, 0.5);
  EXPECT_EQ(read_back.frame_of_reference, "1.2.3");
  EXPECT_EQ(read_back.isotope, "I-125");
  EXPECT_FALSE(read_back.sources[0].has_axis);
}

TEST_F(Rtplan, may_have_a_second_source_that_nothing_uses) {
  RtplanFile plan = seeds();
  plan.source(2, "", 0.0, "0", "18991230");
  add_seed(plan, Vec3(1, 2, 3));
  const DosePlan read_back = read(plan).value();
  EXPECT_EQ(read_back.half_life_days, 59.4);
  EXPECT_EQ(read_back.strength_date, "20240102");
}

// Without an orientation, two more points of weight 0 lie one unit vector away from the seed.
TEST_F(Rtplan, gives_directions_by_points_without_weight_beside_the_seed) {
  RtplanFile plan = seeds();
  const double tilt = 10.0 * 3.14159265358979 / 180.0;
  const std::vector<Vec3> axes{Vec3::UnitZ(), Vec3(std::sin(tilt), 0.0, std::cos(tilt)), -Vec3::UnitZ()};
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const Vec3 at(10.0 * static_cast<double>(k), 0.0, 5.0);
    RtplanFile::channel(plan.setup("UNDEFINED", static_cast<int>(k)), 1, kPermanent_s, 1.0,
                        {{at, 0.0}, {at, 1.0}, {at + axes[k], 0.0}, {at + axes[k], 0.0}});
  }
  const DosePlan read_back = read(plan).value();
  ASSERT_EQ(read_back.sources.size(), 3U) << "marks of direction are no seeds";
  for (std::size_t k = 0; k < axes.size(); ++k) {
    EXPECT_TRUE(read_back.sources[k].has_axis);
    EXPECT_LT((read_back.sources[k].axis - axes[k]).norm(), 1e-4) << "the file has six digits";
  }
}

TEST_F(Rtplan, gives_the_same_seeds_if_the_marks_come_before_or_if_no_point_has_a_weight) {
  for (const int variant : {0, 1, 2}) {
    RtplanFile plan = seeds();
    const Vec3 at(4, 5, 6), mark = at + Vec3::UnitY();
    const std::vector<Point> points = variant == 0 ? std::vector<Point>{{mark, 0.0}, {at, 0.0}, {at, 1.0}}
                                      : variant == 1
                                          ? std::vector<Point>{{at, 0.0}, {at, 0.0}, {mark, 0.0}, {mark, 0.0}}
                                          : std::vector<Point>{{at, 0.0}};
    RtplanFile::channel(plan.setup("UNDEFINED", 1), 1, kPermanent_s, 1.0, points);
    const DosePlan read_back = read(plan).value();
    ASSERT_EQ(read_back.sources.size(), 1U) << variant;
    EXPECT_EQ(read_back.sources[0].at_mm, at) << variant;
    EXPECT_EQ(read_back.sources[0].has_axis, variant != 2);
    if (variant != 2) EXPECT_LT((read_back.sources[0].axis - Vec3::UnitY()).norm(), 1e-5) << variant;
  }
}

TEST_F(Rtplan, takes_the_orientation_where_the_file_has_one) {
  RtplanFile plan = seeds();
  const Vec3 axis = Vec3(1, 2, 3).normalized();
  RtplanFile::channel(plan.setup("UNDEFINED", 1), 1, kPermanent_s, 1.0,
                      {{Vec3::Zero(), 0.0, 2.0 * axis}, {Vec3::Zero(), 1.0, 2.0 * axis}});
  const DosePlan read_back = read(plan).value();
  EXPECT_TRUE(read_back.sources[0].has_axis);
  EXPECT_LT((read_back.sources[0].axis - axis).norm(), 1e-6);
}

TEST_F(Rtplan, does_not_count_twice_what_the_setups_of_a_pre_plan_repeat) {
  RtplanFile plan = seeds();
  DcmItem& all = plan.setup("UNDEFINED", 1);
  for (int k = 0; k < 4; ++k) {
    const Vec3 at(0, 0, 10.0 * k);
    RtplanFile::channel(all, 1, kPermanent_s, 1.0, {{at, 0.0}, {at, 1.0}});
  }
  for (int k = 0; k < 4; ++k) {
    const Vec3 at(0, 0, 10.0 * k);
    RtplanFile::channel(plan.setup("TEMPLATE", k + 2), 1, kPermanent_s, 1.0, {{at, 0.0}, {at, 1.0}});
  }
  const DosePlan read_back = read(plan).value();
  EXPECT_EQ(read_back.sources.size(), 4U);
  EXPECT_TRUE(says(read_back, "4 seeds stand twice"));
}

TEST_F(Rtplan, has_a_seed_for_each_place_of_a_needle_channel) {
  RtplanFile plan = seeds();
  std::vector<Point> points;
  for (int k = 0; k < 5; ++k) {
    points.push_back({Vec3(0, 0, 10.0 * k), 0.2 * k});
    points.push_back({Vec3(0, 0, 10.0 * k), 0.2 * (k + 1)});
  }
  put(RtplanFile::channel(plan.setup("TEMPLATE", 1), 7, kPermanent_s, 1.0, points), DCM_SourceApplicatorID, "d3.5");
  const DosePlan read_back = read(plan).value();
  ASSERT_EQ(read_back.sources.size(), 5U);
  for (const PlannedSource& seed : read_back.sources) {
    EXPECT_EQ(seed.strength_U, 0.5) << "each seed has the whole strength";
    EXPECT_EQ(seed.needle, "d3.5");
  }
}

TEST_F(Rtplan, takes_the_dose_of_the_setup_where_no_prescription_is_given) {
  RtplanFile plan = seeds();
  DcmItem& group = testing_files::new_item(*plan.file.getDataset(), DCM_FractionGroupSequence);
  for (int k = 0; k < 2; ++k)
    put(testing_files::new_item(group, DCM_ReferencedBrachyApplicationSetupSequence), DCM_BrachyApplicationSetupDose,
        "145");
  add_seed(plan, Vec3::Zero());
  EXPECT_EQ(read(plan).value().prescription_Gy, 145.0);
  put(testing_files::new_item(group, DCM_ReferencedBrachyApplicationSetupSequence), DCM_BrachyApplicationSetupDose,
      "20");
  EXPECT_EQ(read(plan).value().prescription_Gy, 0.0) << "setups that differ say nothing";
  EXPECT_TRUE(says(read(plan).value(), "without a prescription"));
  put(testing_files::new_item(*plan.file.getDataset(), DCM_DoseReferenceSequence), DCM_TargetPrescriptionDose, "160");
  EXPECT_EQ(read(plan).value().prescription_Gy, 160.0);
}

TEST_F(Rtplan, of_dwell_times_has_the_time_of_each_place) {
  RtplanFile plan = hdr();
  // 30 s in the channel for a final weight of 100: weights 0, 40, 40, 100.
  RtplanFile::channel(plan.setup("TEMPLATE", 1), 1, 30.0, 100.0,
                      {{Vec3(0, 0, 0), 0.0},
                       {Vec3(0, 0, 0), 40.0},
                       {Vec3(0, 3, 4), 40.0},
                       {Vec3(0, 3, 4), 100.0},
                       {Vec3(0, 6, 8), 100.0},
                       {Vec3(0, 6, 8), 100.0}});
  const DosePlan read_back = read(plan).value();
  EXPECT_EQ(read_back.implant, Implant::temporary);
  ASSERT_EQ(read_back.sources.size(), 2U) << "places without time are left out";
  EXPECT_NEAR(read_back.sources[0].dwell_s, 12.0, 1e-9);
  EXPECT_NEAR(read_back.sources[1].dwell_s, 18.0, 1e-9);
  EXPECT_LT((read_back.sources[0].axis - Vec3(0, -0.6, -0.8)).norm(), 1e-9) << "towards the tip, where it begins";
  EXPECT_TRUE(says(read_back, "orientation"));
}

TEST_F(Rtplan, has_directions_towards_the_tip_also_where_a_channel_ends_there) {
  RtplanFile plan = hdr();
  DcmItem& channel =
      RtplanFile::channel(plan.setup("TEMPLATE", 1), 1, 30.0, 30.0,
                          {{Vec3(0, 0, 0), 0.0}, {Vec3(0, 0, 0), 10.0}, {Vec3(0, 0, 5), 10.0}, {Vec3(0, 0, 5), 30.0}});
  const std::vector<const char*> from_tip{"5", "5", "0", "0"};
  for (unsigned k = 0; k < 4; ++k) {
    DcmItem* point = nullptr;
    ASSERT_TRUE(channel.findOrCreateSequenceItem(DCM_BrachyControlPointSequence, point, static_cast<long>(k)).good());
    put(*point, DCM_ControlPointRelativePosition, from_tip[k]);
  }
  const DosePlan read_back = read(plan).value();
  ASSERT_EQ(read_back.sources.size(), 2U);
  for (const PlannedSource& dwell : read_back.sources) EXPECT_LT((dwell.axis - Vec3::UnitZ()).norm(), 1e-9);
}

TEST_F(Rtplan, of_pulses_has_the_times_of_all_pulses) {
  RtplanFile plan("PDR", "INTERSTITIAL", "Ir-192", 73.83, "4000");
  DcmItem& channel =
      RtplanFile::channel(plan.setup("TEMPLATE", 1), 1, 20.0, 20.0, {{Vec3::Zero(), 0.0}, {Vec3::Zero(), 20.0}});
  put(channel, DCM_NumberOfPulses, "24");
  const DosePlan read_back = read(plan).value();
  ASSERT_EQ(read_back.sources.size(), 1U);
  EXPECT_NEAR(read_back.sources[0].dwell_s, 480.0, 1e-9);
  EXPECT_TRUE(says(read_back, "pulses"));
}

TEST_F(Rtplan, of_several_fractions_has_the_prescription_of_one) {
  RtplanFile plan = hdr();
  RtplanFile::channel(plan.setup("TEMPLATE", 1), 1, 20.0, 20.0, {{Vec3::Zero(), 0.0}, {Vec3::Zero(), 20.0}});
  put(testing_files::new_item(*plan.file.getDataset(), DCM_DoseReferenceSequence), DCM_TargetPrescriptionDose, "27");
  DcmItem& group = testing_files::new_item(*plan.file.getDataset(), DCM_FractionGroupSequence);
  put(group, DCM_NumberOfFractionsPlanned, "2");
  EXPECT_EQ(read(plan).value().prescription_Gy, 27.0) << "nothing says that 27 Gy are the sum";
  EXPECT_TRUE(says(read(plan).value(), "2 fractions"));
  put(testing_files::new_item(group, DCM_ReferencedBrachyApplicationSetupSequence), DCM_BrachyApplicationSetupDose,
      "13.5");
  EXPECT_EQ(read(plan).value().prescription_Gy, 13.5);
}

TEST_F(Rtplan, of_low_dose_rate_has_seeds_that_stay_also_where_their_time_means_nothing) {
  for (const double seconds : {0.0, 1.0, 60.0, 40 * 86400.0, 1e9}) {
    RtplanFile plan("LDR", "", "I-125", 59.4, "0.5");
    RtplanFile::channel(plan.setup("UNDEFINED", 1), 1, seconds, 1.0, {{Vec3::Zero(), 0.0}, {Vec3::Zero(), 1.0}});
    EXPECT_EQ(read(plan).value().implant, Implant::permanent) << seconds;
  }
  RtplanFile plaque("LDR", "", "I-125", 59.4, "4.5");
  RtplanFile::channel(plaque.setup("UNDEFINED", 1), 1, 5 * 86400.0, 1.0, {{Vec3::Zero(), 0.0}, {Vec3::Zero(), 1.0}});
  const DosePlan removed = read(plaque).value();
  EXPECT_EQ(removed.implant, Implant::temporary);
  EXPECT_NEAR(removed.sources.at(0).dwell_s, 5 * 86400.0, 1e-3);
}

TEST_F(Rtplan, says_that_a_seed_comes_again_with_another_strength) {
  RtplanFile plan = seeds();
  plan.source(2, "I-125", 59.4, "0.7");
  add_seed(plan, Vec3::Zero(), 1, 1);
  add_seed(plan, Vec3::Zero(), 2, 2);
  const DosePlan read_back = read(plan).value();
  EXPECT_EQ(read_back.sources.size(), 1U);
  EXPECT_TRUE(says(read_back, "another strength"));
}

TEST_F(Rtplan, has_a_kind_of_source_for_each_isotope_and_not_for_each_strength) {
  RtplanFile plan = seeds();
  plan.source(2, "Pd-103", 16.991, "2");
  plan.source(3, "I-125", 59.4, "0.6");
  plan.source(4, "I-125", 59.4, "0.7");
  for (int k = 1; k < 4; ++k) add_seed(plan, Vec3(0, 0, 10.0 * k), k, k);
  const DosePlan read_back = read(plan).value();
  ASSERT_EQ(kind_count(read_back), 2U);
  EXPECT_EQ(source_kind(read_back, 1).id, "2");
  EXPECT_EQ(source_kind(read_back, 1).isotope, "Pd-103");
  EXPECT_EQ(read_back.sources[1].kind, 1U);
  EXPECT_EQ(read_back.sources[2].kind, 0U);
  EXPECT_EQ(read_back.sources[2].strength_U, 0.6);
  ASSERT_EQ(read_back.says.unused.size(), 1U) << "source 4";
}

TEST_F(Rtplan, keeps_what_it_says_of_its_channels) {
  RtplanFile plan = hdr();
  const std::vector<testing_files::Point> there{{Vec3::Zero(), 0.0}, {Vec3::Zero(), 6.0}};
  put(RtplanFile::channel(plan.setup("TEMPLATE", 1), 1, 6.0, 6.0, there), DCM_ChannelTotalTime, "");
  RtplanFile::channel(plan.setup("TEMPLATE", 2), 2, 6.0, 3.0, there);
  const DosePlan read_back = read(plan).value();
  ASSERT_EQ(read_back.says.channels.size(), 2U);
  EXPECT_TRUE(std::isnan(read_back.says.channels[0].total_s));
  EXPECT_EQ(read_back.says.channels[0].weights, 6.0);
  EXPECT_EQ(read_back.says.channels[1].final_weight, 3.0);
}

TEST_F(Rtplan, may_let_the_weights_start_again_at_each_place) {
  RtplanFile plan = hdr();
  RtplanFile::channel(plan.setup("TEMPLATE", 1), 1, 10.0, 10.0,
                      {{Vec3(0, 0, 0), 0.0}, {Vec3(0, 0, 0), 6.5}, {Vec3(0, 0, 5), 0.0}, {Vec3(0, 0, 5), 3.5}});
  const DosePlan read_back = read(plan).value();
  ASSERT_EQ(read_back.sources.size(), 2U);
  EXPECT_NEAR(read_back.sources[0].dwell_s, 6.5, 1e-9);
  EXPECT_NEAR(read_back.sources[1].dwell_s, 3.5, 1e-9);
}

TEST_F(Rtplan, refuses_weights_that_decrease_or_that_are_missing) {
  RtplanFile falls = hdr();
  RtplanFile::channel(falls.setup("TEMPLATE", 1), 1, 30.0, 1.0,
                      {{Vec3(0, 0, 0), 0.0}, {Vec3(0, 0, 0), 0.6}, {Vec3(0, 0, 5), 0.6}, {Vec3(0, 0, 5), 0.4}});
  expect_error(falls, "less than the one before");
  RtplanFile none = hdr();
  RtplanFile::channel(none.setup("TEMPLATE", 1), 1, 30.0, 0.0, {{Vec3(0, 0, 0), 0.0}, {Vec3(0, 0, 0), 5.0}});
  expect_error(none, "final cumulative time weight");
}

TEST_F(Rtplan, refuses_a_strength_that_is_missing_or_no_number_above_0) {
  for (const char* strength : {"", "0", "-0.5"}) {
    RtplanFile plan("LDR", "PERMANENT", "I-125", 59.4, strength);
    add_seed(plan, Vec3::Zero());
    expect_error(plan, "300A,022A");
  }
  RtplanFile nan("LDR", "PERMANENT", "I-125", 59.4, "nan");
  add_seed(nan, Vec3::Zero());
  expect_error(nan, "'nan'");
}

TEST_F(Rtplan, refuses_a_source_that_the_plan_does_not_have) {
  RtplanFile plan = seeds();
  add_seed(plan, Vec3::Zero(), 1, 5);
  expect_error(plan, "source 5");
}

TEST_F(Rtplan, refuses_a_seed_without_place_or_out_of_reach) {
  RtplanFile lost = seeds();
  DcmItem& channel = add_seed(lost, Vec3::Zero());
  DcmItem* point = nullptr;
  channel.findOrCreateSequenceItem(DCM_BrachyControlPointSequence, point, 1);
  point->findAndDeleteElement(DCM_ControlPoint3DPosition);
  expect_error(lost, "300A,02D4");
  RtplanFile far = seeds();
  add_seed(far, Vec3(1e7, 0, 0));
  EXPECT_FALSE(read(far).ok());
}

TEST_F(Rtplan, tells_external_beams_and_other_files_apart) {
  RtplanFile beams = seeds();
  testing_files::new_item(*beams.file.getDataset(), DCM_BeamSequence);
  expect_error(beams, "external beams");
  RtplanFile empty = seeds();
  empty.setup("UNDEFINED", 1);
  expect_error(empty, "no channel of the plan has a source");
  RtplanFile structures = seeds();
  put(*structures.file.getDataset(), DCM_Modality, "RTSTRUCT");
  put(*structures.file.getDataset(), DCM_SOPClassUID, UID_RTStructureSetStorage);
  expect_error(structures, "RTPLAN is expected");
}

TEST_F(Rtplan, finds_out_whether_seeds_stay_where_the_type_is_missing) {
  RtplanFile plan("", "", "I-125", 59.4, "0.5");
  add_seed(plan, Vec3::Zero());
  EXPECT_EQ(read(plan).value().implant, Implant::permanent);
  RtplanFile other("", "", "Ir-192", 73.83, "40000");
  RtplanFile::channel(other.setup("UNDEFINED", 1), 1, 20.0, 1.0, {{Vec3::Zero(), 0.0}, {Vec3::Zero(), 1.0}});
  expect_error(other, "300A,0202");
}

TEST_F(Rtplan, that_is_cut_off_is_refused_in_words) {
  RtplanFile plan = seeds();
  add_seed(plan, Vec3::Zero());
  const fs::path whole = plan.save(folder / "whole.dcm");
  const std::string text = test::content_of(whole);
  for (const double share : {0.3, 0.6, 0.95}) {
    const Result<DosePlan> result =
        read_plan(file("part.dcm", text.substr(0, static_cast<std::size_t>(share * static_cast<double>(text.size())))));
    ASSERT_FALSE(result.ok()) << share;
    EXPECT_EQ(result.error().kind, ErrorKind::input);
  }
}

/// Distance of each source of one plan from the nearest like it in the other.
double farthest(const DosePlan& a, const DosePlan& b) {
  double most = 0.0;
  for (const PlannedSource& s : a.sources) {
    double nearest = 1e9;
    for (const PlannedSource& t : b.sources) {
      const double apart = (s.at_mm - t.at_mm).norm() + (s.axis - t.axis).norm() +
                           std::abs(s.strength_U / t.strength_U - 1.0) + std::abs(s.dwell_s - t.dwell_s);
      nearest = std::min(nearest, apart);
    }
    most = std::max(most, nearest);
  }
  return most;
}

TEST_F(Rtplan, that_is_written_is_read_again_as_the_same_plan) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-60.0, 60.0), part(-1.0, 1.0);
  for (int round = 0; round < 20; ++round) {
    DosePlan plan;
    plan.implant = round % 2 == 0 ? Implant::permanent : Implant::temporary;
    plan.prescription_Gy = 145.0;
    plan.frame_of_reference = "1.2.840.5";
    plan.label = "random";
    plan.strength_date = round % 4 < 2 ? "" : "20240102 101500";
    for (int k = 0; k < 30; ++k) {
      PlannedSource s;
      s.at_mm = Vec3(place(random), place(random), place(random));
      s.axis = Vec3(part(random), part(random), part(random)).normalized();
      s.has_axis = true;
      s.strength_U = k % 3 == 0 ? 0.4371 : 0.52;
      if (round % 3 > 0) s.needle = "n" + std::to_string(k / 6);
      if (plan.implant == Implant::temporary) {
        s.strength_U = 41234.5;
        s.dwell_s = 0.1 + std::abs(place(random));
      }
      plan.sources.push_back(s);
    }
    const SourceModel source = find_source(plan.implant == Implant::permanent ? "i125_6711" : "ir192_mhdr_v2").value();
    const fs::path path = folder / "written.dcm";
    ASSERT_TRUE(write_rtplan(plan, source, path).ok());
    const DosePlan back = read_plan(path).value();
    ASSERT_EQ(back.sources.size(), plan.sources.size());
    EXPECT_LT(farthest(plan, back), 1e-5);
    EXPECT_LT(farthest(back, plan), 1e-5);
    EXPECT_EQ(back.implant, plan.implant);
    EXPECT_EQ(back.frame_of_reference, plan.frame_of_reference);
    EXPECT_EQ(back.prescription_Gy, 145.0);
    EXPECT_EQ(back.source_model, source.name);
    EXPECT_EQ(back.strength_date, plan.strength_date);
    EXPECT_EQ(back.sources.at(7).needle.empty(), plan.sources.at(7).needle.empty());
    EXPECT_EQ(back.half_life_days, source.half_life_days);
    EXPECT_TRUE(back.notes.empty()) << back.notes.front();
  }
}

/// Output of a program of DCMTK; empty if it is not installed.
std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return text;
  char piece[4096];
  while (std::fgets(piece, sizeof piece, pipe) != nullptr) text += piece;
  return pclose(pipe) == 0 ? text : "FAILED: " + text;
}

TEST_F(Rtplan, that_is_written_is_read_by_the_tools_of_dcmtk) {
  if (std::system("command -v drtdump > /dev/null 2>&1") != 0) GTEST_SKIP() << "drtdump (Debian: dcmtk) is not there";
  DosePlan plan;
  plan.prescription_Gy = 145.0;
  for (int k = 0; k < 3; ++k) {
    PlannedSource seed;
    seed.at_mm = Vec3(1.25, -3.5, 10.0 * k);
    seed.has_axis = true;
    seed.strength_U = 0.5;
    plan.sources.push_back(seed);
  }
  const fs::path path = folder / "written.dcm";
  ASSERT_TRUE(write_rtplan(plan, find_source("i125_6711").value(), path).ok());
  const std::string summary = output_of("drtdump " + path.string());
  test::expect_silent(summary, {"FAILED", "E: ", "W: "});
  const std::string dump = output_of("dcmdump " + path.string());
  EXPECT_EQ(dump.find("E: "), std::string::npos) << dump;
  EXPECT_NE(dump.find("1.25\\-3.5\\20"), std::string::npos) << dump;
}

}  // namespace
}  // namespace stylet
