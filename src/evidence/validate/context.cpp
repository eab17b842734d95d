// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/evidence/validate/context.hpp"

#include <fmt/format.h>

namespace stylet::validate {
namespace fs = std::filesystem;

std::optional<fs::path> Context::data(const std::string& file) const {
  const fs::path path = data_ / file;
  std::error_code code;
  if (!fs::is_regular_file(path, code)) return std::nullopt;
  return path;
}

std::string Context::no_data(const std::string& file) const {
  return fmt::format(
      "{} does not exist. Name the folder of the shared data with --data or the environment variable "
      "STYLET_SHARED_DATA.",
      (data_ / file).string());
}

Result<TetMesh> Context::demo_mesh() {
  if (!demo_mesh_) {
    auto meshed = measure::mesh_demo(measure::demo_scenario().mesh.nodes, progress_);
    if (!meshed) return meshed.error();
    demo_mesh_ = std::move(meshed->mesh);
  }
  return *demo_mesh_;
}

Result<std::shared_ptr<const RecordedRun>> Context::demo_run() {
  if (!demo_run_) {
    Scenario scenario = measure::demo_scenario();
    scenario.output.frames_per_s = 0.0;
    const auto mesh = demo_mesh();
    if (!mesh) return mesh.error();
    const auto model = Model::compile(scenario, *mesh, "the demo", {}, progress_);
    if (!model) return model.error();
    auto recorded = record_run(*model, targets_, progress_);
    if (!recorded) return recorded.error();
    demo_run_ = std::make_shared<const RecordedRun>(std::move(*recorded));
  }
  return demo_run_;
}

Result<std::vector<DemoOnMesh>> Context::demo_on_meshes() {
  if (demo_on_meshes_.empty()) {
    auto rows = validate::demo_on_meshes(10000, progress_);
    if (!rows) return rows.error();
    demo_on_meshes_ = std::move(*rows);
  }
  return demo_on_meshes_;
}

}  // namespace stylet::validate
