// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformed_slice.hpp"

namespace stylet {

void DeformedSlice::place(const UltrasoundBeams& beams, const Eigen::Matrix3Xf& displacement) {
  Mat3 to_plane;
  to_plane.row(0) = beams.across.transpose();
  to_plane.row(1) = beams.ahead.transpose();
  to_plane.row(2) = beams.normal().transpose();
  const Vec3 origin = to_plane * beams.origin_mm;
  for (Index node = 0; node < mesh_->node_count(); ++node) {
    const Vec3 x = mesh_->nodes[static_cast<std::size_t>(node)] + displacement.col(node).cast<double>();
    places_.col(node) = to_plane * x - origin;
    above_[static_cast<std::size_t>(node)] = places_(2, node) > 0.0 ? 1 : 0;
  }
  for (std::size_t line = 0; line < starts_.size(); ++line) {
    starts_[line] = beams.start_mm(static_cast<double>(line));
    ways_[line] = beams.direction(static_cast<double>(line));
  }
}

DeformedSlice::Lines DeformedSlice::lines_of(const UltrasoundBeams& beams, const std::array<Index, 4>& corners) const {
  double low = 1e30, high = -1e30;
  bool behind = false;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b) {
      const Vec3 p = places_.col(corners[a]), q = places_.col(corners[b]);
      if ((p.z() > 0.0) == (q.z() > 0.0)) continue;
      const double t = p.z() / (p.z() - q.z());
      const Eigen::Vector2d at = ((1.0 - t) * p + t * q).head<2>();
      behind = behind || at.y() < 0.0;
      const double line = beams.locate(at).line;
      low = std::min(low, line);
      high = std::max(high, line);
    }
  }
  // A section on both sides of the half line opposite to `ahead` is seen from a sector under all angles.
  if (beams.sector && behind && (high - low) * beams.step > std::numbers::pi) return {0, beams.lines - 1};
  return {std::max(0, static_cast<int>(std::ceil(low))), std::min(beams.lines - 1, static_cast<int>(std::floor(high)))};
}

Vec4 DeformedSlice::weights(Index tet, const Eigen::Vector2d& in_plane) const {
  const auto& corners = mesh_->tets[static_cast<std::size_t>(tet)];
  const Vec3 p0 = places_.col(corners[0]);
  Mat3 edges;
  for (int k = 0; k < 3; ++k) edges.col(k) = places_.col(corners[static_cast<std::size_t>(k) + 1]) - p0;
  Vec4 weights;
  weights.tail<3>() = edges.inverse() * (Vec3(in_plane.x(), in_plane.y(), 0.0) - p0);
  weights[0] = 1.0 - weights.tail<3>().sum();
  return weights;
}

Mat3 DeformedSlice::undeformed_by_deformed(const UltrasoundBeams& beams, Index tet) const {
  const auto& corners = mesh_->tets[static_cast<std::size_t>(tet)];
  Mat3 before, after, to_plane;
  for (int k = 0; k < 3; ++k) {
    const Index corner = corners[static_cast<std::size_t>(k) + 1];
    before.col(k) = mesh_->nodes[static_cast<std::size_t>(corner)] - mesh_->nodes[static_cast<std::size_t>(corners[0])];
    after.col(k) = places_.col(corner) - places_.col(corners[0]);
  }
  to_plane.row(0) = beams.across.transpose();
  to_plane.row(1) = beams.ahead.transpose();
  to_plane.row(2) = beams.normal().transpose();
  return before * after.inverse() * to_plane;
}

}  // namespace stylet
