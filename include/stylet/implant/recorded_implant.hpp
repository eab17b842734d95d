// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/implant/seed_history.hpp"
#include "stylet/sim/recording.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// How often the needles of an implant have broken the skin, and how often they have harmed the patient.
struct ImplantTally {
  int skin_punctures = 0;
  int organ_entries = 0;  ///< of organs that a needle harms (harmed_by_needle())
  int bone_contacts = 0;
  int exits = 0;  ///< through the far side of the patient

  bool operator==(const ImplantTally&) const = default;
};

/// Counts the events of one needle.
class TallyOfNeedle {
 public:
  /// Adds an event to a tally. The events have to come in their order.
  void add(const Event& event, ImplantTally& tally);

 private:
  std::string touched_;  ///< region whose surface the tip has touched from outside; empty once it has broken
};

/// The plan of seeds that a recorded insertion belongs to. All places are in LPS [mm].
struct RecordedPlan {
  struct Needle {
    std::string name;                ///< at most 64 bytes are recorded
    std::string hole;                ///< hole of the template on its line; empty: there is none
    Vec3 entry_mm = Vec3::Zero();    ///< skin point on its line
    Vec3 direction = Vec3::UnitZ();  ///< unit vector, towards the tip
    double depth_mm = 0.0;           ///< depth of the base at which the tip is at its planned place
  };
  struct Seed {
    std::size_t number = 0;  ///< its position in DosePlan::sources
    std::size_t needle = 0;  ///< number of its needle in `needles`
    Vec3 planned_mm = Vec3::Zero();
    Vec3 axis = Vec3::UnitZ();   ///< unit vector, towards the tip of its needle
    double drop_depth_mm = 0.0;  ///< depth of the base at which it is pushed out at its planned place
  };
  std::vector<Needle> needles;  ///< in the order of the procedure
  std::vector<Seed> seeds;      ///< needle by needle, from the tip on
  int current = -1;             ///< the needle of this recording; −1: one beside the plan
  double seed_length_mm = 0.0;
  double seed_diameter_mm = 0.0;
  double prescription_Gy = 0.0;  ///< 0: none is known
  std::string source;            ///< name of the source model
  std::string implant;           ///< name of the implant: that of the recording of its first needle
  ImplantTally before;           ///< of the needles before that of this recording
};

/// One change of the seeds in the tissue, at a moment of a recording.
struct SeedAct {
  enum class Kind : std::int8_t {
    earlier,     ///< an earlier needle had dropped the seed before the recording began
    dropped,     ///< the needle of the recording dropped it
    taken_back,  ///< the seed that was added last was taken out again
    settled      ///< the seed rests elsewhere than when it was dropped, because its strand has grown or become shorter
  };
  Kind kind = Kind::dropped;
  double time_s = 0.0;  ///< [s] simulated time of the recording
  SeedHistory seed;     ///< SeedHistory::needle is a number in RecordedPlan::needles
};
/// "earlier", "dropped", "taken_back", "settled"
const char* to_string(SeedAct::Kind kind);

/// The dose of the target after some acts, as it was computed when they happened.
struct RecordedScore {
  static constexpr std::int64_t kOfPlan = -1;
  std::int64_t acts = 0;      ///< number of the acts before it; kOfPlan: it is the dose of the plan
  std::int64_t seeds = 0;     ///< number of seeds that it counts
  double d90_Gy = 0.0;        ///< dose that 90 % of the target receive
  double d90_percent = 0.0;   ///< the same in percent of the prescribed dose; NaN without one
  double v100_percent = 0.0;  ///< share of the target that receives the prescribed dose; NaN without one
};

/// The plan, the acts and the doses of an implant in a recording of the live page.
struct RecordedImplant {
  RecordedPlan plan;
  std::vector<SeedAct> acts;  ///< in the order in which they happened
  std::vector<RecordedScore> doses;

  /// Number of acts up to a moment, this moment included.
  [[nodiscard]] std::size_t acts_until(double time_s) const;
  /// The seeds in the tissue after the first `count` acts, in the order in which they were dropped: for each the number
  /// of the act that says where it rests.
  [[nodiscard]] std::vector<std::size_t> acts_of_seeds(std::size_t count) const;
  /// These seeds.
  [[nodiscard]] std::vector<SeedHistory> seeds_after(std::size_t count) const;
  /// The dose after `acts` acts, or of the plan; empty if it was not computed before the next act.
  [[nodiscard]] std::optional<RecordedScore> dose_after(std::int64_t acts) const;
};

}  // namespace stylet
