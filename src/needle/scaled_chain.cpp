// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle/scaled_chain.hpp"

#include <cmath>

namespace stylet::beam {

ScaledChain::ScaledChain(const BeamShape& shape)
    : scale_(static_cast<std::size_t>(shape.elements())),
      spin_(MatX::Zero(dof(shape.elements()), 3)),
      shift_(MatX::Zero(dof(shape.elements()), 3)) {
  const Vec3 standard = (shape.element_length() * shape.stiffness()).cwiseSqrt().cwiseInverse();
  for (int e = 0; e < elements(); ++e)
    scale_[static_cast<std::size_t>(e)] = standard / std::sqrt(shape.elastic_weight(e));
}

void ScaledChain::update(const BeamShape& shape) {
  for (int e = 0; e < elements(); ++e) {
    const Mat3 spin = shape.spin(e) * scale(e).asDiagonal();
    const Mat3 shift = shape.shift(e) * scale(e).asDiagonal();
    spin_.middleRows<3>(row(e)) = spin.transpose();
    shift_.middleRows<3>(row(e)) = shift.transpose();
  }
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): the columns are written through the view
void ScaledChain::motion(std::span<const Pull> pulls, const Mat3& base_rotation,
                         Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, 3>> columns) const {
  const Mat3 to_base = base_rotation.transpose();
  columns.setZero();
  for (const Pull& pull : pulls) {
    if (pull.at.element < 0) continue;
    const Eigen::Index i = row(pull.at.element);
    const Eigen::Index below = rows() - i - 3;
    const Mat3 shifted = pull.weight * to_base;
    const Mat3 turned = pull.weight * cross(pull.point) * to_base;
    columns.middleRows<3>(i).noalias() += scale(pull.at.element).asDiagonal() * (pull.jacobian.transpose() * shifted);
    columns.bottomRows(below).noalias() += shift_.bottomRows(below).lazyProduct(shifted);
    columns.bottomRows(below).noalias() += spin_.bottomRows(below).lazyProduct(turned);
  }
}

}  // namespace stylet::beam
