// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/target_motion.hpp"

#include <algorithm>

namespace stylet {

namespace {

using Accuracy = MeanDisplacement::Accuracy;

/// The finest that takes seconds. docs/theory/near_field.md §8 has what is left between meshes.
Accuracy affordable(Index nodes) {
  constexpr Index halved = 700;
  constexpr Index quadratic = 5000;
  return nodes <= halved      ? Accuracy::quadratic_halved
         : nodes <= quadratic ? Accuracy::quadratic
                              : Accuracy::of_the_tissue;
}

}  // namespace

Result<TargetMotion> TargetMotion::of(const Model& model, const Progress& progress) {
  auto mean =
      MeanDisplacement::solve(model.tissue(), model.target_regions(), affordable(model.mesh().node_count()), progress);
  if (!mean) return mean.error();
  return TargetMotion(model, std::move(*mean));
}

TargetShift TargetMotion::shift(const Insertion& insertion) const {
  TargetShift shift;
  for (const TissueForce& load : insertion.tissue_forces()) shift.centroid_mm += mean_.per_force(load.at) * load.force;
  const TetMesh& mesh = model_->mesh();
  const std::vector<int>& regions = model_->target_regions();
  const VecX u = insertion.mesh_displacement();
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const int region = mesh.tet_region[static_cast<std::size_t>(t)];
    if (std::find(regions.begin(), regions.end(), region) == regions.end()) continue;
    for (const Index node : mesh.tets[static_cast<std::size_t>(t)])
      shift.largest_mm = std::max(shift.largest_mm, u.segment<3>(3 * Eigen::Index{node}).norm());
  }
  return shift;
}

}  // namespace stylet
