// SPDX-License-Identifier: GPL-3.0-or-later
// Events say where the needle is: what surrounds the organs is the skin only for a needle that comes from outside.
#include "stylet/io/event_words.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using stylet::Event;
using enum stylet::EventKind;
using stylet::results::event_labels;

using Words = std::vector<std::string>;

/// A surface breaks, and the tip is in the region behind it.
void breaks_into(std::vector<Event>& events, const std::string& region, double depth_mm) {
  events.push_back({puncture, depth_mm, depth_mm, 2.0, region});
  events.push_back({region_entered, depth_mm, depth_mm, 1.5, region});
}

std::vector<Event> through_the_skin(const std::string& region, double depth_mm = 7.0) {
  std::vector<Event> events{{skin_contact, 0.0, 0.0, 0.0, region}};
  breaks_into(events, region, depth_mm);
  return events;
}

TEST(EventWords, the_skin_is_broken_from_outside_whatever_lies_under_it) {
  for (const char* region : {"body", "subcutaneous_fat", "levator"}) {
    EXPECT_EQ(event_labels(through_the_skin(region)), (Words{"Touched the skin", "Went through the skin", ""}))
        << region;
  }
}

TEST(EventWords, a_needle_that_leaves_an_organ_has_not_met_the_skin) {
  for (const auto& [behind, words] : {std::pair{"body", "Left the prostate"},
                                      std::pair{"periprostatic_fat", "Left the prostate into the periprostatic fat"},
                                      std::pair{"levator", "Left the prostate into the levator"},
                                      std::pair{"bladder", "Left the prostate into the bladder"}}) {
    auto events = through_the_skin("body");
    breaks_into(events, "prostate", 50.0);
    breaks_into(events, behind, 80.0);
    EXPECT_EQ(event_labels(events),
              (Words{"Touched the skin", "Went through the skin", "", "Entered the prostate", "", words, ""}));
  }
}

TEST(EventWords, layers_without_a_membrane_are_said_as_they_are_entered) {
  auto events = through_the_skin("subcutaneous_fat");
  events.push_back({region_entered, 15.0, 15.0, 1.0, "body"});
  events.push_back({region_entered, 35.0, 35.0, 1.0, "levator"});
  breaks_into(events, "rectum", 40.0);
  breaks_into(events, "rectal_lumen", 43.0);
  breaks_into(events, "rectum", 60.0);
  EXPECT_EQ(event_labels(events), (Words{"Touched the skin", "Went through the skin", "", "Left the subcutaneous fat",
                                         "Entered the levator", "Entered the rectum", "", "Entered the rectal lumen",
                                         "", "Left the rectal lumen into the rectum", ""}));
}

TEST(EventWords, tissue_without_a_name_of_an_organ_surrounds_what_is_entered_from_it) {
  auto events = through_the_skin("tissue");
  events.push_back({region_entered, 20.0, 20.0, 1.0, "prostate"});
  events.push_back({region_entered, 30.0, 30.0, 1.0, "tissue"});
  EXPECT_EQ(event_labels(events), (Words{"Touched the tissue", "Entered the tissue", "", "Entered the prostate",
                                         "Left the prostate into the tissue"}));
}

TEST(EventWords, a_needle_that_follows_its_earlier_track_leaves_the_region_at_the_end_of_it) {
  auto events = through_the_skin("body");
  breaks_into(events, "prostate", 50.0);
  events.push_back({withdrawn, 100.0, 0.0, 0.0, ""});
  const auto before = events.size();
  events.push_back({skin_contact, 110.0, 0.0, 0.0, "body"});
  breaks_into(events, "body", 80.0);
  EXPECT_EQ(event_labels(events)[before + 1], "Left the prostate") << "no surface was met on the way";

  events.resize(before);
  events.push_back({skin_contact, 110.0, 2.0, 0.0, "body"});
  breaks_into(events, "body", 9.0);
  EXPECT_EQ(event_labels(events)[before + 1], "Went through the skin") << "beside the earlier track";
}

TEST(EventWords, a_needle_that_came_out_on_the_far_side_meets_the_skin_again) {
  auto events = through_the_skin("body");
  events.push_back({exited, 90.0, 90.0, 0.0, "body"});
  events.push_back({re_entered, 95.0, 95.0, 0.0, "body"});
  breaks_into(events, "body", 99.0);
  EXPECT_EQ(event_labels(events)[5], "Went through the skin");
}

TEST(EventWords, bone_and_the_far_side_are_named) {
  const std::vector<Event> events{{bone_contact, 1.0, 1.0, 1.0, "pubic_arch"}, {exited, 2.0, 2.0, 1.0, "body"}};
  EXPECT_EQ(event_labels(events), (Words{"Met bone (pubic arch)", "Came out on the far side"}));
}

}  // namespace
