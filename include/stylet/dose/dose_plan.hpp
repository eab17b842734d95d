// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace stylet {

/// How long the sources of a plan stay.
enum class Implant {
  permanent,  ///< seeds stay until they have decayed (LDR)
  temporary   ///< one source dwells at each place for a time (HDR, PDR)
};
const char* to_string(Implant implant);  ///< "permanent", "temporary"

/// A seed of a permanent implant, or one place where the source of a temporary implant dwells.
struct PlannedSource {
  Vec3 at_mm = Vec3::Zero();  ///< [mm] LPS, centre of the source
  Vec3 axis = Vec3::UnitZ();  ///< unit vector along the source; +z where the plan says nothing
  bool has_axis = false;      ///< whether the plan says the axis
  double strength_U = 0.0;    ///< air-kerma strength [U = µGy m²/h], > 0
  double dwell_s = 0.0;       ///< time [s] at this place, ≥ 0; only for temporary implants
  double over_s = 0.0;        ///< time [s] from the first to the last moment here, with pauses; 0: dwell_s
  std::size_t kind = 0;       ///< number of its kind (source_kind())
  std::string needle;         ///< hole of the template or name of the channel; may be empty
};

/// One kind of source, as a plan states it.
struct SourceKind {
  std::string id;                   ///< name in the plan: the source's number (300A,0212), or its model; may be empty
  std::string source_model;         ///< name of a source model (known_sources()); empty: the plan names none
  std::string isotope;              ///< such as "I-125"; may be empty
  double half_life_days = 0.0;      ///< [d] as the plan says; 0: it does not say
  double source_length_mm = 0.0;    ///< length of the active part [mm]; 0: the plan does not say
  double source_diameter_mm = 0.0;  ///< diameter of the active part [mm]; 0: the plan does not say
  std::string strength_date;        ///< date, and time where there is one, of the strength, as in the file
};

/// A channel of a DICOM plan of a temporary implant, as the file describes it.
struct ChannelSays {
  std::string where;                                          ///< setup and number of the channel, for messages
  double total_s = std::numeric_limits<double>::quiet_NaN();  ///< its time [s] (300A,0286); NaN: the file has none
  double final_weight = 0.0;  ///< final cumulative time weight (300A,02C8); 0: the file has none
  double weights = 0.0;       ///< sum of the weights of its places
  int points = 0;             ///< number of control points in the file
  int points_said = 0;        ///< number that the file announces (300A,0110); 0: it does not say
  int pulses = 1;             ///< number of pulses (300A,028A); 0: the file has none
  bool shielded = false;      ///< whether it has shields (300A,02B0)
};

/// The statements of a plan's file besides its sources, for the rules of plan_rules.hpp.
struct PlanSays {
  bool is_dicom = false;               ///< whether the file is a DICOM RTPLAN
  std::string type, technique;         ///< (300A,0202) and (300A,0200); may be empty
  std::string today;                   ///< date of the computation, YYYYMMDD; empty: dates are not compared with it
  int fractions = 0;                   ///< number of fractions; 0: the file does not say
  std::vector<double> prescriptions;   ///< [Gy] all prescribed doses to targets (300A,0026)
  std::vector<double> setup_doses;     ///< [Gy] different doses of the setups (300A,00A4)
  std::vector<double> total_kermas;    ///< [µGy at 1 m] of the setups (300A,0250), above 0
  std::vector<std::string> unused;     ///< sources with a strength to which no channel refers
  std::vector<ChannelSays> channels;   ///< of temporary implants
  double longest_channel_s = 0.0;      ///< [s] longest time of a channel
  double dwell_of_permanent_s = 0.0;   ///< [s] sum of dwell times that a permanent implant has in a text file
  std::size_t without_dwell_time = 0;  ///< sources of a temporary implant without a dwell time in a text file
  std::size_t repeated = 0;            ///< seeds that stood again at the same place and were counted once
  bool has_beams = false;              ///< whether the plan has external beams, too
  std::vector<std::string> ignored;    ///< entries of the file that nothing uses
};

/// A plan of brachytherapy sources, as a file describes it.
struct DosePlan {
  std::string file;                      ///< file from which the plan was read
  std::string uid;                       ///< UID of the DICOM plan (0008,0018); may be empty
  std::string label;                     ///< the plan's label; may be empty
  Implant implant = Implant::permanent;  ///< permanent or temporary
  std::string frame_of_reference;        ///< UID of the DICOM frame of reference; may be empty
  std::string source_model;              ///< name of a source model (known_sources()); empty: the plan names none
  std::string isotope;                   ///< such as "I-125"; may be empty
  double half_life_days = 0.0;           ///< [d] as the plan says; 0: it does not say
  double source_length_mm = 0.0;         ///< length of the active part [mm] as the plan says; 0: it does not say
  double source_diameter_mm = 0.0;       ///< diameter of the active part [mm]; 0: the plan does not say
  std::string strength_date;             ///< date, and time where there is one, of the strength, as in the file
  std::string plan_date;                 ///< date, and time where there is one, of the plan, as in the file
  double prescription_Gy = 0.0;          ///< prescribed dose [Gy]; 0: the plan does not say
  std::string source_id;                 ///< of the kind of source that isotope, half-life, … above describe
  std::vector<SourceKind> more_kinds;    ///< further kinds: PlannedSource::kind k ≥ 1 is more_kinds[k − 1]
  std::vector<PlannedSource> sources;    ///< at least one
  PlanSays says;                         ///< other statements of the file
  std::vector<std::string> notes;        ///< sentences for the user: what the reader decided or left out
};

/// Number of kinds of source of a plan, at least 1.
[[nodiscard]] inline std::size_t kind_count(const DosePlan& plan) { return 1 + plan.more_kinds.size(); }

/// A kind of source, as the plan states it. @param kind 0 … kind_count() − 1
[[nodiscard]] inline SourceKind source_kind(const DosePlan& plan, std::size_t kind) {
  if (kind > 0) return plan.more_kinds.at(kind - 1);
  return {plan.source_id,        plan.source_model,       plan.isotope,      plan.half_life_days,
          plan.source_length_mm, plan.source_diameter_mm, plan.strength_date};
}

}  // namespace stylet
