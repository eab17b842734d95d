// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/grip_rows.hpp"

#include <cassert>

namespace stylet {

namespace {

/// Number of contacts next to the tip whose lateral rows are yielding rows, because these contacts harden while the
/// needle goes in and soften when it is withdrawn. Raised, the matrix is made anew less often, and the part that is
/// factorised in every iteration is larger.
constexpr int kNextToTip = 3;

}  // namespace

GripRows::GripRows(int most_grips)
    : place_(3 * static_cast<std::size_t>(most_grips)),
      frames_(static_cast<std::size_t>(most_grips), Mat3::Identity()) {}

void GripRows::arrange(std::span<const Yield> yields, Eigen::Index spring_rows) {
  grips_ = static_cast<int>(yields.size());
  spring_rows_ = spring_rows;
  const auto yields_across = [&](int g) {
    return g >= grips_ - kNextToTip || yields[static_cast<std::size_t>(g)].lateral > 0.0;
  };
  settled_ = 0;
  for (int g = 0; g < grips_; ++g) {
    frames_[static_cast<std::size_t>(g)] = frame_along(yields[static_cast<std::size_t>(g)].along);
    for (int k = 0; k < 2 && !yields_across(g); ++k) set_place(g, k, settled_++);
  }
  Eigen::Index next = first_yielding();
  for (int g = 0; g < grips_; ++g) {
    for (int k = yields_across(g) ? 0 : 2; k < 3; ++k) set_place(g, k, next++);
  }
}

void GripRows::append(const Vec3& along) {
  const int last = grips_++;
  frames_[static_cast<std::size_t>(last)] = frame_along(along);
  for (int k = 0; k < 3; ++k) set_place(last, k, count() - 3 + k);
}

void GripRows::keep_first(int grips) {
  assert(grips <= grips_ && (grips == grips_ || !settled(grips, 0)));
  grips_ = grips;
}

// NOLINTBEGIN(performance-unnecessary-value-param): the matrices are written through their views

void GripRows::order(const Eigen::Ref<const MatX>& Y, Eigen::Ref<MatX> ordered) const {
  for (int g = 0; g < grips_; ++g) {
    for (Eigen::Index j = 0; j < Y.cols(); ++j) {
      const Vec3 local = frame(g).transpose() * Y.col(j).segment<3>(3 * g);
      for (int k = 0; k < 3; ++k) ordered(place(g, k), j) = local[k];
    }
  }
  ordered.middleRows(settled_, spring_rows_) = Y.bottomRows(spring_rows_);
}

void GripRows::restore(const Eigen::Ref<const MatX>& ordered, Eigen::Ref<MatX> Y) const {
  for (int g = 0; g < grips_; ++g) {
    for (Eigen::Index j = 0; j < Y.cols(); ++j) {
      const Vec3 local(ordered(place(g, 0), j), ordered(place(g, 1), j), ordered(place(g, 2), j));
      Y.col(j).segment<3>(3 * g).noalias() = frame(g) * local;
    }
  }
  Y.bottomRows(spring_rows_) = ordered.middleRows(settled_, spring_rows_);
}

// NOLINTEND(performance-unnecessary-value-param)

}  // namespace stylet
