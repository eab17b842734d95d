// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/target_motion.hpp"

#include <algorithm>
#include <limits>
#include <span>

namespace stylet {

namespace {

using Accuracy = VolumeResponse::Accuracy;

/// The finest accuracy that takes seconds. docs/theory/near_field_evidence.md gives the remaining differences between
/// meshes.
Accuracy affordable(Index nodes) {
  constexpr Index halved = 700;
  constexpr Index quadratic = 5000;
  return nodes <= halved      ? Accuracy::quadratic_halved
         : nodes <= quadratic ? Accuracy::quadratic
                              : Accuracy::of_the_tissue;
}

bool same_mesh(const TetMesh& a, const TetMesh& b) {
  return &a == &b || (a.nodes == b.nodes && a.tets == b.tets && a.tet_region == b.tet_region);
}

}  // namespace

Result<TargetMotion> TargetMotion::of(const Model& model, const Progress& progress) {
  auto response =
      VolumeResponse::solve(model.tissue(), model.target_regions(), affordable(model.mesh().node_count()), progress);
  if (!response) return response.error();
  return TargetMotion(model, std::make_shared<const VolumeResponse>(std::move(*response)));
}

std::optional<TargetMotion> TargetMotion::shared_with(const Model& other) const {
  // The factor of the tissue orders the nodes of the needle's way last, so its rounding errors depend on the way.
  if (affordable(other.mesh().node_count()) == Accuracy::of_the_tissue) return std::nullopt;
  if (other.supports().nodes != model_->supports().nodes || other.target_regions() != model_->target_regions() ||
      other.tissue().materials() != model_->tissue().materials() || !same_mesh(other.mesh(), model_->mesh()))
    return std::nullopt;
  return TargetMotion(other, response_);
}

TargetMotion::Moment TargetMotion::now(const Insertion& insertion) {
  std::size_t count = insertion.tissue_forces(forces_);
  if (count > forces_.size()) {
    forces_.resize(count);
    count = insertion.tissue_forces(forces_);
  }
  Moment moment;
  moment.at_rest = count == 0;
  for (const TissueForce& load : std::span(forces_).first(count)) response_->add(load.at, load.force, moment.motion);
  moment.motion = response_->finite(moment.motion);
  for (const auto third : {VolumeMotion::superior, VolumeMotion::middle, VolumeMotion::inferior}) {
    if (!response_->has(third)) moment.motion.third_mm[third].setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return moment;
}

TargetShift TargetMotion::shift(const Insertion& insertion) {
  TargetShift shift;
  shift.centroid_mm = now(insertion).motion.shift_mm;
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
