// SPDX-License-Identifier: GPL-3.0-or-later
// The tally of a needle's events.
#include "stylet/implant/recorded_implant.hpp"

#include <gtest/gtest.h>

namespace stylet {
namespace {

ImplantTally tally_of(const std::vector<Event>& events, ImplantTally before = {}) {
  TallyOfNeedle needle;
  for (const Event& event : events) needle.add(event, before);
  return before;
}

Event event(EventKind kind, const char* region = "") { return {kind, 0.0, 0.0, 0.0, region}; }

TEST(TallyOfNeedle, counts_the_skin_once_for_each_time_it_breaks) {
  using enum EventKind;
  const Event touch = event(skin_contact, "body"), breaks = event(puncture, "body");
  EXPECT_EQ(tally_of({touch, breaks, event(region_entered, "body"), event(puncture, "prostate")}).skin_punctures, 1)
      << "the capsule is not the skin";
  EXPECT_EQ(tally_of({touch, event(withdrawn)}).skin_punctures, 0) << "it was only touched";
  EXPECT_EQ(tally_of({touch, breaks, event(withdrawn), touch, breaks}).skin_punctures, 2);
  EXPECT_EQ(tally_of({touch, breaks, event(withdrawn), touch, event(puncture, "prostate")}).skin_punctures, 1)
      << "back in its track, and on from there";
}

TEST(TallyOfNeedle, adds_its_harm_to_that_of_the_needles_before) {
  using enum EventKind;
  const ImplantTally all =
      tally_of({event(region_entered, "rectum"), event(region_entered, "prostate"), event(bone_contact, "pubic_arch"),
                event(exited, "body"), event(re_entered, "body")},
               {.skin_punctures = 4, .organ_entries = 1, .bone_contacts = 2, .exits = 0});
  EXPECT_EQ(all, (ImplantTally{.skin_punctures = 4, .organ_entries = 2, .bone_contacts = 3, .exits = 1}));
}

}  // namespace
}  // namespace stylet
