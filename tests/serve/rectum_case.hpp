// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "serving.hpp"

namespace stylet::test {

/// box_patient() with a rectum behind the gland.
inline TetMesh patient_with_rectum() {
  TetMesh mesh = box_patient();
  mesh.regions.emplace_back("rectum");
  const int rectum = mesh.region_index("rectum");
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Vec3 middle = Vec3::Zero();
    for (const Index node : mesh.tets[t]) middle += 0.25 * mesh.nodes[static_cast<std::size_t>(node)];
    const bool is_gland = mesh.regions[static_cast<std::size_t>(mesh.tet_region[t])] == "prostate";
    if (!is_gland && std::hypot(middle.x(), middle.y() - 28.0) < 9.0) mesh.tet_region[t] = rectum;
  }
  return mesh;
}

inline serve::CaseSource case_with_rectum() {
  return {"with a rectum", [](const Progress& progress) -> Result<serve::LoadedCase> {
            auto model = Model::compile(hole_scenario(), patient_with_rectum(), "case.toml", {}, progress);
            if (!model) return model.error();
            return serve::LoadedCase{*model, {}};
          }};
}

}  // namespace stylet::test
