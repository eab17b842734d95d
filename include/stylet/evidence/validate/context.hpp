// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/evidence/validate/demo_on_meshes.hpp"
#include "stylet/evidence/validate/recorded_run.hpp"
#include "stylet/measure/demo.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

namespace stylet::validate {

/// Common ground of all rows: the options, the folder of the shared data, and results that are too expensive to compute
/// twice.
class Context {
 public:
  /// @param data folder of the shared data; it need not exist
  Context(bool quick, std::filesystem::path data, Progress progress)
      : quick_(quick), data_(std::move(data)), progress_(std::move(progress)) {}

  [[nodiscard]] bool quick() const { return quick_; }
  [[nodiscard]] const Progress& progress() const { return progress_; }
  /// Cache of target motions for runs of the same patient.
  KnownTargets& targets() { return targets_; }

  /// The path of a file of the shared data; empty if it does not exist.
  [[nodiscard]] std::optional<std::filesystem::path> data(const std::string& file) const;
  /// The reason why a row is skipped if a file of the shared data is missing: a message with its path.
  [[nodiscard]] std::string no_data(const std::string& file) const;

  /// The demo patient, meshed as in the demo scenario (about 3,000 nodes). Meshed once.
  Result<TetMesh> demo_mesh();
  /// The demo insertion: hole e3.5, in and out at 20 mm/s, with default parameters. Simulated once.
  Result<std::shared_ptr<const RecordedRun>> demo_run();
  /// The demo insertion on meshes of 500 to 10,000 nodes, with the near field and with node addition. Simulated once.
  Result<std::vector<DemoOnMesh>> demo_on_meshes();

 private:
  bool quick_;
  std::filesystem::path data_;
  Progress progress_;
  KnownTargets targets_;
  std::optional<TetMesh> demo_mesh_;
  std::shared_ptr<const RecordedRun> demo_run_;
  std::vector<DemoOnMesh> demo_on_meshes_;
};

}  // namespace stylet::validate
