// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/lent_springs.hpp"

#include "coupling/balance/yield.hpp"

namespace stylet {

LentSprings::LentSprings(int most_grips) { springs_.reserve(static_cast<std::size_t>(most_grips)); }

void LentSprings::take(std::span<const LentSpring> springs) {
  springs_.clear();
  for (std::size_t g = 0; g < springs.size(); ++g) {
    if (!(springs[g].stiffness > 0.0)) continue;
    springs_.push_back({static_cast<int>(g), frame_along(springs[g].along).leftCols<2>(), 1.0 / springs[g].stiffness});
  }
}

void LentSprings::across(const Eigen::Ref<const VecX>& y, Eigen::Ref<VecX> along) const {
  for (const Spring& spring : springs_)
    along.segment<2>(2 * (&spring - springs_.data())).noalias() =
        spring.directions.transpose() * y.segment<3>(3 * spring.grip);
}

void LentSprings::add_forces(const Eigen::Ref<const VecX>& f, Eigen::Ref<VecX> y) const {
  for (const Spring& spring : springs_)
    y.segment<3>(3 * spring.grip).noalias() += spring.directions * f.segment<2>(2 * (&spring - springs_.data()));
}

}  // namespace stylet
