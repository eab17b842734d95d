// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "console.hpp"

#include "stylet/dose/dose_grid.hpp"
#include "stylet/dose/dose_plan.hpp"
#include "stylet/dose/source_model.hpp"
#include "stylet/geom/contours.hpp"
#include "stylet/geom/label_image.hpp"
#include "stylet/geom/quality.hpp"
#include "stylet/geom/surface.hpp"
#include "stylet/geom/tet_mesh.hpp"
#include "stylet/io/implant_record_io.hpp"
#include "stylet/io/model_file.hpp"
#include "stylet/io/recording_io.hpp"

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace stylet::cli {

/// Description of a file's content, as JSON and as text.
struct Description {
  Json json;
  std::string text;
  std::vector<std::string> warnings{};  ///< faults that do not prevent its use
};

Description describe(const ContourSet& contours);
Description describe(const LabelImage& image);
Description describe(const TetMesh& mesh);
Description describe(const std::vector<Surface>& surfaces);
Description describe(const RunRecording& run);
Description describe(const ImplantRecord& record);
Description describe(const ModelFile& file);
Description describe(const DosePlan& plan);
Description describe(const DoseGrid& grid);
Description describe(const SourceModel& source);
/// The source models that the program has.
Description describe_known_sources();

/// The JSON keys common to all descriptions of a mesh: nodes, tets, dihedral_deg, edge_mm, radius_ratio_min, …
Json quality_json(const MeshQuality& quality);

/// {"min": [x, y, z], "max": [x, y, z]} [mm] LPS; null for an empty box.
Json extent_json(const Eigen::AlignedBox3d& box);
/// "51 × 39 × 48" [mm], or "-" for an empty box.
std::string extent_text(const Eigen::AlignedBox3d& box);

}  // namespace stylet::cli
