// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/implant/needle_load.hpp"
#include "stylet/implant/needle_record.hpp"
#include "stylet/implant/seed_history.hpp"
#include "stylet/sim/gland_motion.hpp"
#include "stylet/sim/model.hpp"

#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// The history of one needle of an implant.
struct NeedleHistory {
  std::string name;                    ///< as in NeedleLoad
  Vec3 entry_mm = Vec3::Zero();        ///< [mm] LPS, skin point on its line
  Vec3 direction = Vec3::UnitZ();      ///< unit vector LPS
  double depth_mm = 0.0;               ///< largest base depth, from the skin
  double peak_force_N = 0.0;           ///< largest axial force on the hand
  double deflection_mm = 0.0;          ///< largest distance of the tip from the straight line
  Vec3 gland_shift_mm = Vec3::Zero();  ///< LPS, the gland's largest mean shift; NaN without a gland
  std::vector<Event> events;
  long steps = 0;
  double seconds = 0.0;  ///< processor time of the steps
  NeedleRecord record;   ///< each of its steps, and its shapes
};

/// A simulated implant.
struct ImplantHistory {
  std::vector<NeedleHistory> needles;      ///< in the order in which they were inserted
  std::vector<NeedleHistory> stabilising;  ///< in the order in which they were inserted, as in the first group
  std::vector<SeedHistory> seeds;          ///< in the order of the plan
  std::vector<std::string> warnings;       ///< sentences for the user: harms, seeds that could not be followed
  int nodes = 0;                           ///< of the mesh
  /// Mean shift of the gland [mm] LPS when the dwell positions are seen at planning, and at delivery. Empty for a
  /// permanent implant and without a gland.
  std::optional<Vec3> gland_at_planning_mm, gland_at_delivery_mm;
  double compile_s = 0.0;  ///< wall-clock time to compile the models of all needles, summed over threads
};

/// Simulates an implant: stabilising needles go in and stay; those of the plan go in, drop their seeds and come out,
/// one by one or in groups (Scenario::procedure). Groups do not feel each other's tracks. A seed belongs to the
/// material point where it was dropped, found with the needle's near field; with all needles out this point goes back
/// to where it was, and takes the seed along (docs/theory/implant.md).
/// Catheters of a temporary implant go in one after the other and all stay. After procedure.pause_s their dwell
/// positions are seen at planning, and after procedure.planning_to_delivery_s at delivery.
/// @param scenario tissue, needle and procedure; its insertions are not used
/// @param mesh the patient's tetrahedra
/// @param seed_length_mm length of a seed's capsule
/// @param where name of the scenario in messages
/// Errors: those of Model::compile(); a needle that misses the patient or is too short; catheters with a coupling that
/// holds one needle only.
Result<ImplantHistory> simulate_implant(const Scenario& scenario, const TetMesh& mesh,
                                        const std::vector<NeedleLoad>& needles, double seed_length_mm,
                                        const std::string& where, const Progress& progress = {});

}  // namespace stylet
