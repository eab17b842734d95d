// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/patient/fit.hpp"

#include <Eigen/Geometry>

namespace stylet::fit {

/// A structure as far as judge_fit() looks at it.
struct Structure {
  std::string name;            ///< as in the file
  std::string region;          ///< canonical name of what it is; empty: not recognised
  bool guessed = false;        ///< it is the gland only because no structure is named so
  bool insisted = false;       ///< the user assigned its region
  double volume_cc = 0.0;      ///< 0: it has no volume, or is not measured
  Eigen::AlignedBox3d box{};   ///< [mm] LPS
  std::vector<Vec3> points{};  ///< [mm] LPS, evenly spread over its volume; empty: not measured
  double step_mm = 0.0;        ///< [mm] widest distance of neighbouring samples in a plane; 0: not sampled in planes
  [[nodiscard]] bool is_measured() const { return !points.empty() && volume_cc > 0.0; }
  [[nodiscard]] Vec3 centre() const;
  /// Usual distance of neighbouring points [mm].
  [[nodiscard]] double spacing_mm() const;
};

/// The structures of a file, with their kind.
struct Structures {
  std::vector<Structure> all;
  std::string kind;       ///< "structure", "label" or "region"
  bool apart = false;     ///< structures cannot overlap: the body is what is left between the organs
  bool has_unit = false;  ///< the file's unit can be set by patient.scale
};

Structures structures_of(const PatientInput& input, const MeshOptions& names);

}  // namespace stylet::fit
