// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/dose/dose_grid.hpp"
#include "stylet/dose/dose_plan.hpp"
#include "stylet/dose/dose_volume.hpp"
#include "stylet/dose/gamma.hpp"
#include "stylet/dose/goals.hpp"
#include "stylet/dose/patient_record.hpp"
#include "stylet/dose/source_model.hpp"
#include "stylet/dose/strength_age.hpp"
#include "stylet/dose/structure_samples.hpp"
#include "stylet/dose/tg43.hpp"
#include "stylet/geom/contours.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace stylet {

/// A structure whose dose is asked for.
struct DoseStructure {
  std::string name;    ///< as in the file
  std::string region;  ///< region that it is taken as: "prostate" (the target), "urethra", …; empty: another one
  std::string type;    ///< DICOM interpreted type, such as "PTV"; may be empty
  StructureSamples samples;                  ///< points that stand for its volume
  std::array<int, 3> colour{128, 128, 128};  ///< display colour, 0 … 255; grey (128, 128, 128): the file gives none
  std::vector<Contour> contours;  ///< [mm] LPS, closed polygons in parallel planes; empty for masks and meshes
};

/// The dose to one structure.
struct StructureDose {
  std::string name, region, type;            ///< as in DoseStructure
  std::array<int, 3> colour{128, 128, 128};  ///< as in DoseStructure
  DoseVolume dvh;                            ///< of its samples
  double covered_by_grid_percent = 100.0;    ///< share of its volume within the grid that is compared or written
  std::vector<Contour> contours;             ///< as in DoseStructure, for pictures of the structure
  std::vector<Vec3> cloud;  ///< [mm] LPS, at most 4000 of its samples, for pictures of a structure without contours
};

/// A goal with what the plan reaches.
struct JudgedGoal {
  DoseGoal goal;
  std::optional<double> value;  ///< empty: the plan has no such structure, or no prescription
  bool met = false;
};

/// Sentences about figures that some structures do not have because they are too small, such as D2cc of 1.3 cc.
[[nodiscard]] std::vector<std::string> figures_left_out(const std::vector<StructureDose>& structures);

/// How a dose grid from a file compares with the computed dose.
struct DoseComparison {
  std::string file;
  std::size_t points = 0;           ///< number of grid points compared
  double median_ratio = 0.0;        ///< median of computed dose / dose of the file
  double p1 = 0.0;                  ///< 1st percentile of this ratio
  double p99 = 0.0;                 ///< 99th percentile
  std::optional<GammaRates> gamma;  ///< of the same points
  /// Computed dose − dose of the file [Gy] on the points of the file's grid, moved as asked; NaN where the file has
  /// less than the least dose that is compared, or a number that cannot be stored. Points near sources are included.
  DoseGrid difference;
};

/// A file from which a dose was computed.
struct DoseInput {
  std::string role;    ///< what it is: "plan", "structures", …
  std::string path;    ///< file or folder
  std::string sha256;  ///< in hexadecimal; empty: unknown
};

/// A plan with its dose: everything that report, JSON and tables of `stylet dose` say.
struct DoseEvaluation {
  DosePlan plan;
  PatientRecord patient;                  ///< whose plan it is; evaluate_dose() leaves it empty
  StrengthAge strength;                   ///< date of the strengths beside that of the plan, with the decay between
  SourceModel source;                     ///< of the plan's first kind of source
  std::vector<SourceModel> more_sources;  ///< of its further kinds (DosePlan::more_kinds)
  DoseFormalism formalism = DoseFormalism::line2d;
  std::string quantity;          ///< "total dose", "initial dose rate …", what dose_Gy means
  double prescription_Gy = 0.0;  ///< 0: none is known
  std::vector<StructureDose> structures;
  std::vector<JudgedGoal> goals;
  std::vector<Vec3> points;      ///< [mm] LPS
  std::vector<double> point_Gy;  ///< dose at `points`
  DoseGrid grid;                 ///< dose around sources and structures
  std::optional<DoseComparison> comparison;
  std::string computed_on;        ///< date and time; evaluate_dose() leaves it empty
  std::vector<DoseInput> inputs;  ///< files that the results name with their hashes; evaluate_dose() leaves it empty
  std::vector<std::string> assumptions;  ///< sentences: formalism, source, orientations, slabs at the ends
  std::vector<std::string> warnings;     ///< sentences about what the user should look at
};

}  // namespace stylet
