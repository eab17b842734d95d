// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"
#include "stylet/geom/contours.hpp"
#include "stylet/geom/label_image.hpp"
#include "stylet/geom/tet_mesh.hpp"

#include <vector>

namespace stylet {

/// Points that stand for the volume of a structure.
struct StructureSamples {
  std::vector<Vec3> points;        ///< [mm] LPS
  std::vector<double> volume_mm3;  ///< volume that each point stands for
  [[nodiscard]] double volume_cc() const;
};

/// Samples a structure given by contours: the slabs of its slices (structure_slices()).
/// @param step_mm [mm] > 0, largest distance of neighbouring samples
/// Errors: those of structure_slices(), a step that is not above 0, more than 100 million samples.
Result<StructureSamples> sample_structure(const Roi& roi, double step_mm);

/// Samples a structure given by a label of a mask: each voxel is divided into equal parts.
/// @param label number of the label @param step_mm [mm] > 0, largest distance of neighbouring samples
/// Errors: no voxel has this label, a step that is not above 0, more than 100 million samples.
Result<StructureSamples> sample_structure(const LabelImage& image, int label, double step_mm);

/// Samples a region of a mesh: each tetrahedron is divided into equal parts, whose number is about that of the cubes of
/// the step that fill it, whatever its shape.
/// @param region index of the region in TetMesh::regions @param step_mm [mm] > 0, distance of neighbouring samples in a
/// tetrahedron of good shape; in a flat one up to three times as much
/// Errors: no tetrahedron has this region, a step that is not above 0, more than 100 million samples.
Result<StructureSamples> sample_structure(const TetMesh& mesh, int region, double step_mm);

/// Distance of samples [mm] for a structure of this volume: 0.5 mm, 0.25 mm below 2 cc, and for large structures so
/// much that there are about four million samples.
[[nodiscard]] double sampling_step_mm(double volume_cc);

}  // namespace stylet
