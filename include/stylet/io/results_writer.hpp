// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/geom/tet_mesh.hpp"
#include "stylet/probe/patient_probe.hpp"
#include "stylet/sim/hole_map.hpp"
#include "stylet/sim/recording.hpp"

#include <filesystem>
#include <memory>

namespace stylet {

/// Writes the result folder of a run. run.h5 grows during the run (SWMR, flushed at least every 0.5 s); summary.json,
/// forces.csv, tissue.pvd with its .vtu files, needle.vtp and report.html are written when the run has finished.
class ResultsWriter {
 public:
  /// @param stress_of function that computes the stress [MPa] (6 × tets) of a displacement [mm] (3n) for the VTU files;
  ///   may be empty
  static Result<std::unique_ptr<ResultsWriter>> open(const std::filesystem::path& folder, const RunInfo& info,
                                                     const TetMesh& mesh,
                                                     std::function<MatX(const VecX&)> stress_of = {});
  ~ResultsWriter();

  Result<> add_step(const Step& step);
  Result<> add_frame(const Frame& frame);
  /// Keeps what the ultrasound probe does; finish() writes it into the report and summary.json.
  void add_probe(const ProbeReport& probe);
  /// Keeps the map of the template's holes; finish() writes it as map.csv.
  void add_map(HoleMap map);
  /// Writes all files. Progress covers the pictures.
  /// @param pictures whether the report has still pictures in addition to its interactive view
  Result<> finish(const Summary& summary, const Progress& progress = {}, bool pictures = true);

 private:
  struct Parts;
  explicit ResultsWriter(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet
