// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

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
  std::string needle;         ///< hole of the template or name of the channel; may be empty
};

/// A plan of brachytherapy sources, as a file describes it.
struct DosePlan {
  std::string file;                      ///< file from which the plan was read
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
  std::vector<PlannedSource> sources;    ///< at least one
  std::vector<std::string> notes;        ///< sentences for the user: what the reader decided or left out
};

}  // namespace stylet
