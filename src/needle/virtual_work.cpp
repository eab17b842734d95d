// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle/virtual_work.hpp"

#include "needle/resultant.hpp"

#include <algorithm>

namespace stylet::beam {

VirtualWork::VirtualWork(int elements)
    : work_(static_cast<std::size_t>(elements)), first_(static_cast<std::size_t>(elements)) {}

void VirtualWork::reserve(Eigen::Index loads) {
  loads_.reserve(static_cast<std::size_t>(loads));
  pulls_.reserve(static_cast<std::size_t>(AxisCurve::kReach * loads));
  next_.reserve(static_cast<std::size_t>(AxisCurve::kReach * loads));
}

std::span<const Vec3> VirtualWork::of(const BeamShape& shape, const Mat3& base_rotation,
                                      std::span<const PointLoad> loads) {
  if (is_known(shape, base_rotation, loads)) return work_;
  revision_ = shape.revision();
  rotation_ = base_rotation;
  loads_.assign(loads.begin(), loads.end());
  sort_pulls(shape, base_rotation, loads);
  Resultant beyond;
  for (int e = shape.elements() - 1; e >= 0; --e) {
    Vec3 work = shape.shift(e).transpose() * beyond.force + shape.spin(e).transpose() * beyond.moment();
    for (int i = first_[static_cast<std::size_t>(e)]; i >= 0; i = next_[static_cast<std::size_t>(i)]) {
      const Pull& pull = pulls_[static_cast<std::size_t>(i)];
      work.noalias() += pull.jacobian.transpose() * pull.force;
      beyond.add(pull);
    }
    work_[static_cast<std::size_t>(e)] = work;
  }
  return work_;
}

bool VirtualWork::is_known(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads) const {
  const auto same = [](const PointLoad& a, const PointLoad& b) { return a.s == b.s && a.force == b.force; };
  return revision_ == shape.revision() && rotation_ == base_rotation &&
         std::equal(loads.begin(), loads.end(), loads_.begin(), loads_.end(), same);
}

void VirtualWork::sort_pulls(const BeamShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads) {
  pulls_.clear();
  next_.clear();
  std::fill(first_.begin(), first_.end(), -1);
  for (const PointLoad& load : loads) {
    const Pulls pulls = shape.pulls(load.s, base_rotation.transpose() * load.force);
    for (int i = 0; i < pulls.count; ++i) {
      const Pull& pull = pulls.pull[static_cast<std::size_t>(i)];
      if (pull.at.element < 0) continue;
      int& first = first_[static_cast<std::size_t>(pull.at.element)];
      next_.push_back(first);
      first = static_cast<int>(pulls_.size());
      pulls_.push_back(pull);
    }
  }
}

}  // namespace stylet::beam
