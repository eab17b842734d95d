// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/measure/coupling_bench.hpp"
#include "stylet/measure/demo.hpp"
#include "stylet/measure/recorded_run.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

namespace stylet::validate {

/// What rows may share: options, the shared data, and things too expensive to make twice.
class Context {
 public:
  /// @param data folder of the shared data; need not exist
  Context(bool quick, std::filesystem::path data, Progress progress)
      : quick_(quick), data_(std::move(data)), progress_(std::move(progress)) {}

  [[nodiscard]] bool quick() const { return quick_; }
  [[nodiscard]] const Progress& progress() const { return progress_; }

  /// A file of the shared data, or nothing where it is not there.
  [[nodiscard]] std::optional<std::filesystem::path> data(const std::string& file) const;
  /// "…/shared/data/NAME is not there …": what a row says that is skipped for want of it.
  [[nodiscard]] std::string no_data(const std::string& file) const;

  /// The demo patient, meshed as the demo scenario does it (about 3,000 nodes).
  Result<TetMesh> demo_mesh();
  /// The demo: hole e3.5, in and out at 20 mm/s, with default parameters. Carried out once.
  Result<std::shared_ptr<const measure::RecordedRun>> demo_run();
  /// The demo insertion on meshes of 500 to 10,000 nodes, with the near field and with node addition. Carried out once.
  Result<std::vector<measure::CouplingRow>> demo_on_meshes();

 private:
  bool quick_;
  std::filesystem::path data_;
  Progress progress_;
  std::optional<TetMesh> demo_mesh_;
  std::shared_ptr<const measure::RecordedRun> demo_run_;
  std::vector<measure::CouplingRow> demo_on_meshes_;
};

}  // namespace stylet::validate
