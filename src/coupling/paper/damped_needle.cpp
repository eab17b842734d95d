// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/paper/damped_needle.hpp"

namespace stylet::paper {

DampedNeedle::DampedNeedle(Eigen::Index shape_size, int most_loads)
    : acceleration_(shape_size),
      before_(VecX::Zero(shape_size)),
      after_(before_),
      springs_(static_cast<std::size_t>(most_loads), Mat3::Zero()),
      compliance_(MatX::Zero(3 * static_cast<Eigen::Index>(most_loads), 3 * static_cast<Eigen::Index>(most_loads))),
      motion_(VecX::Zero(3 * static_cast<Eigen::Index>(most_loads))) {}

void DampedNeedle::bend(Needle& needle, std::span<const PointLoad> loads) {
  const auto size = 3 * static_cast<Eigen::Index>(loads.size());
  needle.linearise(loads, compliance_.topLeftCorner(size, size), motion_.head(size), {springs_.data(), loads.size()});
  before_ = needle.state();
  needle.advance(loads);
  after_ = needle.state();
  acceleration_.accelerate(before_, after_);
  needle.set_state(after_);
}

}  // namespace stylet::paper
