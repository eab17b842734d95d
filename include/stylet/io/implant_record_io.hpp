// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"
#include "stylet/io/implant_results.hpp"

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace stylet {

/// A structure of the patient, for pictures and statistics.
struct RecordedStructure {
  std::string name, region, type;  ///< as in StructureDose
  std::array<int, 3> colour{128, 128, 128};
  double volume_cc = 0.0;
  std::vector<Contour> contours;  ///< [mm] LPS, closed polygons in parallel planes; empty for masks and meshes
  std::vector<Vec3> cloud_mm;     ///< [mm] LPS, points inside
};

/// A dose of an implant.
struct RecordedDose {
  DoseGrid grid;                             ///< its notes and file are not kept
  std::vector<double> dose_Gy;               ///< (k) [Gy] abscissae of the histograms
  std::vector<std::vector<double>> percent;  ///< (structures × k) [%] of the volume with at least this dose
};

/// The content of the run.h5 of an implant: what is needed to draw and count everything again.
struct ImplantRecord {
  std::string version;
  std::string scenario_name;
  std::string scenario_text;  ///< the scenario with all defaults filled in, TOML
  std::string source;         ///< name of the source model
  double prescription_Gy = 0.0;
  double needle_diameter_mm = 0.0;
  double needle_length_mm = 0.0;
  double seed_length_mm = 0.0;
  Implant implant = Implant::permanent;
  TetMesh mesh;
  std::vector<NeedleHistory> needles;      ///< in the order in which they were inserted
  std::vector<NeedleHistory> stabilising;  ///< those without seeds
  std::vector<SeedHistory> seeds;          ///< in the order of the plan
  std::vector<RecordedStructure> structures;
  RecordedDose planned, delivered;
  std::vector<std::string> warnings;
  std::string summary;  ///< the text of summary.json
};

/// Collects the record of an implant.
ImplantRecord implant_record(const ImplantOutcome& outcome);

/// Writes a record as HDF5 (docs/results). The file appears whole or not at all.
/// Errors: the file cannot be written.
Result<> write_implant_record(ImplantRecord record, const std::filesystem::path& path);

/// Reads the run.h5 of an implant. Files of version 2 say whether it is temporary in their summary, and lack the places
/// of dwell positions at planning. Errors: no such file, not an HDF5 file, a recording of an insertion or another file,
/// written by a newer version, damaged.
Result<ImplantRecord> read_implant_record(const std::filesystem::path& path);

/// Whether a file is HDF5 and says that it is the run.h5 of an implant; false for files that cannot be read.
bool is_implant_record(const std::filesystem::path& path);

}  // namespace stylet
