// SPDX-License-Identifier: GPL-3.0-or-later
#include "material_shift.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

MaterialShift::MaterialShift(const TetMesh& mesh, int lines, int samples)
    : mesh_(&mesh),
      field_(mesh),
      columns_(samples / kSampleStep + 2),
      grid_(Eigen::Matrix3Xf::Zero(3, static_cast<Eigen::Index>(lines / 2 + 2) * columns_)),
      touched_(static_cast<std::size_t>(lines / 2 + 2)) {}

void MaterialShift::compute(const UltrasoundBeams& beams, const Moment& moment, const DeformedSlice& slice) {
  std::fill(touched_.begin(), touched_.end(), Range{});
  if (moment.forces.empty()) return;
  field_.set(moment.forces);
  // Along the needle, which lies along the sagittal array, the field is smooth.
  line_step_ = beams.sector ? 2 : 6;
  grid_.setZero();
  const auto fill = [&](const BeamSpan& span) {
    if (span.line % line_step_ != 0) return;
    const double spacing = kSampleStep * beams.sample_mm;
    const int first = static_cast<int>(std::ceil(span.from_mm / spacing));
    const int last = static_cast<int>(std::floor(span.to_mm / spacing));
    const int row = span.line / line_step_;
    for (int k = first; k <= last; ++k) {
      const Vec4 weights = span.weights + k * spacing * span.slopes;
      const Vec3 x = span.undeformed_mm + k * spacing * span.course;
      const Vec3 shift = solve(beams, slice, span.tet, weights, x);
      if (shift.isZero()) continue;
      grid_.col(static_cast<Eigen::Index>(row) * columns_ + k) = shift.cast<float>();
      Range& touched = touched_[static_cast<std::size_t>(row)];
      touched =
          touched.first > touched.last ? Range{k, k} : Range{std::min(touched.first, k), std::max(touched.last, k)};
    }
  };
  slice.cut(beams, fill, [&](Index tet) { return field_.reaches(tet); });
}

/// Solves X + u(X) = x for the undeformed place X near the one that the mesh gives, by fixed-point iteration.
Vec3 MaterialShift::solve(const UltrasoundBeams& beams, const DeformedSlice& slice, Index tet, const Vec4& weights,
                          const Vec3& x) {
  if (field_.beside_mesh(tet, weights, x).isZero()) return Vec3::Zero();
  const Eigen::Matrix<double, 3, 4> gradients = barycentric_gradients(*mesh_, tet);
  const Mat3 back = slice.undeformed_by_deformed(beams, tet);
  Vec3 shift = Vec3::Zero();
  constexpr int kIterations = 5;
  constexpr double kClose_mm = 0.03;
  for (int k = 0; k < kIterations; ++k) {
    const Vec4 there = weights + gradients.transpose() * shift;
    const Vec3 next = -back * field_.beside_mesh(tet, there, x + shift);
    const bool done = (next - shift).squaredNorm() < kClose_mm * kClose_mm;
    shift = next;
    if (done) break;
  }
  return shift;
}

bool MaterialShift::touches(int line, int from, int to) const {
  const auto row = static_cast<std::size_t>(line / line_step_);
  const int low = from / kSampleStep, high = to / kSampleStep + 1;
  const auto meets = [&](const Range& range) {
    return range.first <= high && range.last >= low && range.first <= range.last;
  };
  return meets(touched_[row]) || meets(touched_[row + 1]);
}

Eigen::Vector3f MaterialShift::at(int line, int sample) const {
  const int row = line / line_step_, column = sample / kSampleStep;
  const float across = static_cast<float>(line % line_step_) / static_cast<float>(line_step_);
  const float along = static_cast<float>(sample % kSampleStep) / static_cast<float>(kSampleStep);
  const Eigen::Index at = static_cast<Eigen::Index>(row) * columns_ + column;
  const Eigen::Vector3f near = (1.0F - along) * grid_.col(at) + along * grid_.col(at + 1);
  const Eigen::Vector3f far = (1.0F - along) * grid_.col(at + columns_) + along * grid_.col(at + columns_ + 1);
  return (1.0F - across) * near + across * far;
}

}  // namespace stylet
