// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/resting_creep.hpp"

namespace stylet {

// NOLINTNEXTLINE(performance-unnecessary-value-param): the result is written through its view
void RestingCreep::look(const Contacts& all, Eigen::Ref<VecX> moves) {
  left_ = 1.0;
  const TissueMemory& memory = all.tissue.memory();
  if (!memory.on()) {
    moves.setZero();
    return;
  }
  const ContactCompliance& tissue = all.tissue.compliance();
  const Eigen::Index count = 3 * Eigen::Index{tissue.points()};
  auto forces = forces_.head(count);
  for (int p = 0; p < tissue.points(); ++p) forces.segment<3>(3 * p) = memory.most() * memory.remembered(p);
  forces.head<3>() -= memory.most() * all.tip.force;
  for (const ShaftContact& contact : all.shaft.all())
    forces.segment<3>(3 * contact.point) -= memory.most() * contact.force;
  for (int c = 1; c < all.first_own(); ++c) {
    const auto columns = tissue.wide().block(0, 3 * all.point(c), count, 3);  // or rows: F is symmetric
    moves.segment<3>(3 * c - 3) = columns.transpose().lazyProduct(forces);
  }
}

void RestingCreep::take(const Contacts& all, std::span<const int> own) {
  remembered_.setZero();
  by_forces_.setZero();
  for (int c = 1; c < all.first_own(); ++c) {
    const int point = all.point(c);
    change(all.tissue.compliance(), own, point, all.force(c), all.tissue.memory().remembered(point));
  }
}

void RestingCreep::change(const ContactCompliance& tissue, std::span<const int> own, int point, const Vec3& force,
                          const Vec3& memory) {
  const auto columns = tissue.wide().middleCols<3>(3 * Eigen::Index{point});
  for (std::size_t i = 0; i < own.size(); ++i) {
    const Mat3 F = columns.middleRows<3>(3 * Eigen::Index{own[i]});
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(i) + 3;
    by_forces_.segment<3>(row) += F * force;
    remembered_.segment<3>(row) += F * memory;
  }
}

}  // namespace stylet
