// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "console.hpp"

#include "stylet/geom/contours.hpp"
#include "stylet/geom/label_image.hpp"
#include "stylet/geom/quality.hpp"
#include "stylet/geom/surface.hpp"
#include "stylet/geom/tet_mesh.hpp"
#include "stylet/io/model_file.hpp"
#include "stylet/io/recording_io.hpp"

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace stylet::cli {

/// What is in something a user brought, for machines and for people.
struct Description {
  Json json;
  std::string text;
  std::vector<std::string> warnings{};  ///< what is wrong with it though it can be used
};

Description describe(const ContourSet& contours);
Description describe(const LabelImage& image);
Description describe(const TetMesh& mesh);
Description describe(const std::vector<Surface>& surfaces);
Description describe(const RunRecording& run);
Description describe(const ModelFile& file);

/// Keys that every description of a mesh shares: nodes, tets, dihedral_deg, edge_mm, radius_ratio_min.
Json quality_json(const MeshQuality& quality);

/// {"min": [x, y, z], "max": [x, y, z]} [mm] LPS; null for an empty box.
Json extent_json(const Eigen::AlignedBox3d& box);
/// "51 × 39 × 48" [mm], or "-" for an empty box.
std::string extent_text(const Eigen::AlignedBox3d& box);

}  // namespace stylet::cli
