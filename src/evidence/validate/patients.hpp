// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/evidence/validate/context.hpp"

#include <map>
#include <optional>
#include <string>
#include <tuple>

namespace stylet::validate {

enum class PatientCase { demo, mask };

/// The settings of an insertion that differ from the demo.
struct PatientRun {
  double speed_mm_per_s = 20.0;
  bool creeps = true;                ///< false: elastic tissue, for comparison when the speed is varied
  std::optional<double> depth_mm{};  ///< unset: to the far end of the gland
  double bevel_deg = 20.0;
  std::string hole{};  ///< empty: the hole 15 mm to the left

  bool operator<(const PatientRun& other) const { return key() < other.key(); }
  [[nodiscard]] std::tuple<double, bool, std::optional<double>, double, std::string> key() const {
    return {speed_mm_per_s, creeps, depth_mm, bevel_deg, hole};
  }
};

/// Insertions into patients with all defaults, each simulated once. A needle goes in 15 mm to the left of the gland's
/// axis and stays there. The functions throw Failed.
class Patients {
 public:
  static constexpr const char* kMask = "msd_prostate_masks/prostate_00.nii.gz";

  /// Whether the data of a patient are available.
  static bool is_there(const Context& context, PatientCase patient);
  std::shared_ptr<const RecordedRun> run(Context& context, PatientCase patient, const PatientRun& how);

 private:
  TetMesh mesh(Context& context, PatientCase patient);

  std::optional<TetMesh> mask_;
  std::map<std::pair<PatientCase, PatientRun>, std::shared_ptr<const RecordedRun>> runs_;
};

/// Stiffness of the gland's seat [N/mm], without creep: a force along the patient's axis (z), spread evenly over the
/// gland, divided by the gland's mean displacement along this axis.
double seat_N_per_mm(const Model& model);

}  // namespace stylet::validate
