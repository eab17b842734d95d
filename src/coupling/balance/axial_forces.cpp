// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/axial_forces.hpp"

#include <algorithm>
#include <utility>

namespace stylet {

AxialForces::AxialForces(int grips, int most_own)
    : t_(static_cast<std::size_t>(grips), Vec3::UnitZ()),
      force_(VecX::Zero(dense::column_length(grips))),
      own_(MatX::Zero(force_.size(), 3 * static_cast<Eigen::Index>(most_own))),
      others_(MatX::Zero(force_.size(), 2)),
      slid_(MatX::Zero(force_.size(), grips)),
      knows_(t_.size(), 0),
      now_(VecX::Zero(RestingMatrix::most_rows(grips))) {}

// NOLINTBEGIN(performance-unnecessary-value-param): views

void AxialForces::take(std::span<const Mat3> frames, const Eigen::Ref<const VecX>& forces) {
  for (std::size_t grip = 0; grip < t_.size(); ++grip) {
    t_[grip] = frames[grip].col(2);
    const auto row = static_cast<Eigen::Index>(grip);
    force_[row] = t_[grip].dot(forces.segment<3>(3 * row));
  }
}

/// Writes the forces of a solved column along the needles.
void AxialForces::write(const Eigen::Ref<const VecX>& z, const RestingMatrix& matrix, Eigen::Ref<VecX> along) {
  auto now = now_.head(matrix.contact_rows());
  matrix.forces(z, now);
  for (std::size_t grip = 0; grip < t_.size(); ++grip) {
    const auto row = static_cast<Eigen::Index>(grip);
    along[row] = t_[grip].dot(now.segment<3>(3 * row));
  }
}

void AxialForces::take_columns(const RestingGrips& grips, const Eigen::Ref<const MatX>& others) {
  const RestingMatrix& matrix = grips.matrix();
  const auto W = grips.held().solved(0, matrix.rows());
  for (Eigen::Index k = 0; k < W.cols(); ++k) write(W.col(k), matrix, own_.col(k));
  for (Eigen::Index k = 0; k < 2; ++k) write(others.col(k), matrix, others_.col(k));
  std::fill(knows_.begin(), knows_.end(), char{0});
}

// NOLINTEND(performance-unnecessary-value-param)

void AxialForces::know(int grip, RestingGrips& grips) {
  grips.sliding().know(grip, grips.matrix());  // B itself may have the yield of a contact that slides
  if (std::exchange(knows_[static_cast<std::size_t>(grip)], char{1}) != 0) return;
  write(grips.sliding().column(grip, grips.matrix()), grips.matrix(), slid_.col(grip));
}

}  // namespace stylet
