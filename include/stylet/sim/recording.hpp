// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"
#include "stylet/coupling/capacity_use.hpp"
#include "stylet/coupling/contact_compliance.hpp"
#include "stylet/coupling/event.hpp"
#include "stylet/coupling/step.hpp"
#include "stylet/sim/gland_motion.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// An event of a run.
struct Event {
  EventKind kind{};
  double time_s = 0;
  double depth_mm = 0;  ///< base depth at that moment
  double force_N = 0;   ///< axial force of the hand at that moment
  std::string region;   ///< region touched, punctured or entered; empty if the event has none
};

/// A contact, for display.
struct ContactView {
  Vec3 position = Vec3::Zero();  ///< [mm] LPS, position in the deformed tissue
  Vec3 force = Vec3::Zero();     ///< [N] LPS, force of the needle on the tissue
  double s = 0;                  ///< [mm] arc length on the needle, from its base
  bool sticking = true;
  bool tip = false;
};

/// Everything visible at one moment.
struct Frame {
  double time_s = 0;
  double base_depth_mm = 0;
  std::string label;         ///< "before", "skin_contact", "deepest", … or empty for a frame of the regular series
  VecX displacement;         ///< [mm] (3n) LPS, displacement of the mesh's nodes
  std::vector<Vec3> needle;  ///< [mm] LPS centreline from base to tip, evenly sampled
  std::vector<ContactView> contacts;
};

/// A parameter with the value that the run used, for the report.
struct ParameterRow {
  std::string name;  ///< key in the scenario, e.g. "tissue.prostate.young_kPa"
  std::string value;
  std::string unit;
  std::string source;  ///< "scenario", or where the default comes from (citation)
};

/// Description of a run that is known before its first step.
struct RunInfo {
  std::string version;
  std::string scenario_name;
  std::string scenario_text;  ///< the scenario with all defaults filled in, TOML
  std::vector<ParameterRow> parameters;
  std::vector<std::string> supports;  ///< how the tissue is held, in sentences
  std::vector<std::string> warnings;
  std::string method;  ///< coupling method and rule
  double needle_diameter_mm = 0;
  double needle_length_mm = 0;
  std::vector<int> target_regions;  ///< indices of the regions that form the target
  Vec3 entry_mm = Vec3::Zero();     ///< [mm] LPS, entry point of the insertion
  Vec3 direction = Vec3::UnitZ();
};

/// A change of the tissue's mesh during a run.
struct MeshChange {
  double time_s = 0;
  double depth_mm = 0;  ///< base depth at that moment
  RemeshEvent change;
};

/// Displacement of the target.
struct TargetShift {
  Vec3 centroid_mm = Vec3::Zero();  ///< LPS, mean displacement over the target's volume (VolumeMotion)
  double largest_mm = 0.0;  ///< largest displacement of a node of the target, as the mesh represents it: mesh-dependent
};

/// Needles in place before an insertion (Model::staying()), and figures of the insertion that count from the tissue as
/// these needles hold it. Vectors are LPS.
struct NeedlesInPlace {
  std::vector<std::string> holes;  ///< of the needles in place
  std::optional<Vec3> shift_mm;    ///< the gland's shift by them alone, before the insertion; empty without target
  std::optional<Vec3> shift_at_break_mm;  ///< as GlandMotion::shift_at_break_mm, less shift_mm
  std::optional<Vec3> shift_max_mm;       ///< the largest further shift of the gland on the way in
  /// The deepest material point of the track minus the one that is where a rigid straight needle would reach, while the
  /// needles in place hold the tissue; empty where Summary::tip_error_mm is.
  std::optional<Vec3> tip_error_mm;
  std::vector<std::string> remarks;  ///< sentences about the way in of the needles in place
};

/// Results of a run.
struct Summary {
  std::string version;
  std::string scenario;
  Index nodes = 0;
  Index tets = 0;
  Index steps = 0;
  /// Largest absolute values of the three components of the hand's force.
  double peak_axial_N = 0, peak_sagittal_N = 0, peak_lateral_N = 0;
  std::vector<Event> events;
  double tip_deflection_mm = 0;  ///< largest distance of the tip from the straight line of insertion
  /// Tip error at the deepest point: material point of the tip minus the point that a rigid straight needle would reach
  /// in a patient that nothing has moved. LPS; the largest of several insertions; empty if the tip is not in the tissue
  /// at that moment, and in recordings of earlier versions.
  std::optional<Vec3> tip_error_mm;
  /// Of several insertions the one with the largest tip error; empty without needles in place.
  std::optional<NeedlesInPlace> in_place;
  std::vector<TargetShift> target_shifts;  ///< at the deepest point of each insertion; empty without a target
  /// TargetShift::centroid_mm and largest_mm of the insertion with the greatest largest_mm.
  Vec3 target_shift_centroid_mm = Vec3::Zero();
  double target_shift_max_mm = 0;
  std::vector<GlandMotion> gland_motions;  ///< one per insertion; empty without a target
  std::optional<GlandMotion> gland;        ///< the entry of gland_motions for the insertion with target_shift_max_mm
  std::vector<GlandStep> gland_path;       ///< one per step; empty without a target and when read from a file
  /// Largest |sum of the forces of supports and contacts on the tissue| / peak force of the hand, during the run.
  double residual_force_balance = 0;
  /// Largest |sum of their moments about the entry point| / (peak force of the hand × 100 mm).
  double residual_torque_balance = 0;
  /// [µs] Quantiles and largest value of Step::step_us.
  double step_us_p50 = 0, step_us_p99 = 0, step_us_p999 = 0, step_us_max = 0;
  int contacts_max = 0;  ///< largest number of contacts in a step
  CapacityUses capacity;
  /// Condition number of the compliance among the contacts; the largest of all frames.
  double compliance_condition = 1.0;
  struct Blur {
    double smallest_mm = 0, median_mm = 0, largest_mm = 0;
    int nodes = 0;  ///< number of nodes measured; 0 = the coupling method does not correct the near field
  } mesh_blur;      ///< radius over which the mesh smears a point force, along the needle's way
  std::vector<MeshChange> mesh_changes;
  std::vector<std::string> warnings;
};

}  // namespace stylet
