// SPDX-License-Identifier: GPL-3.0-or-later
#include "grip_matrix.hpp"

#include "core/dense_cholesky.hpp"
#include "core/dense_kernels.hpp"
#include "core/dense_lu.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace stylet {

namespace {

/// A change of D by less than this part of it goes into the next iteration's error instead.
constexpr double kNoChange = 1e-3;

/// What D gives sideways because its direction is an old one, over what the contact gives way there.
constexpr double kTurned = 0.1;

/// The last contacts, next to the tip, grow hard, or soft again when the needle is withdrawn.
constexpr int kNextToTip = 3;

/// Contacts that were appended keep three rows among those that change, also when they have come of age.
constexpr int kMostAppended = 8;

bool differs(double now, double then) { return std::abs(now - then) > kNoChange * std::max(now, then); }

/// Two directions square to t, and t.
Mat3 frame_along(const Vec3& t) {
  const Vec3 helper = std::abs(t.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
  Mat3 frame;
  frame.col(0) = t.cross(helper).normalized();
  frame.col(1) = t.cross(frame.col(0));
  frame.col(2) = t;
  return frame;
}

double component(const Yield& yield, int k) { return k == 2 ? yield.axial : yield.lateral; }

}  // namespace

GripMatrix::GripMatrix(int grips)
    : place_(3 * static_cast<std::size_t>(grips)),
      frames_(static_cast<std::size_t>(grips), Mat3::Identity()),
      yields_(static_cast<std::size_t>(grips)),
      own_(static_cast<std::size_t>(grips)),
      pivots_(2 * static_cast<std::size_t>(grips)) {
  const Eigen::Index n = 3 * static_cast<Eigen::Index>(grips);
  const Eigen::Index s = 2 * static_cast<Eigen::Index>(grips);
  springs_.reserve(static_cast<std::size_t>(grips));
  flexibility_.reserve(static_cast<std::size_t>(grips));
  factor_ = MatX::Zero(dense::column_length(n + s), n + s);
  changing_ = MatX::Zero(dense::column_length(n), n);
  by_springs_ = MatX::Zero(n, s);
  left_ = MatX::Zero(s, s);
  work_ = MatX::Zero(n + s, kMostColumns);
  sum_ = turned_ = MatX::Zero(n, 3);
}

void GripMatrix::take_springs(std::span<const LentSpring> springs) {
  springs_.clear();
  flexibility_.clear();
  for (std::size_t g = 0; g < springs.size(); ++g) {
    if (!(springs[g].stiffness > 0.0)) continue;
    Spring spring{.grip = static_cast<int>(g)};
    spring.E = frame_along(springs[g].along).leftCols<2>();
    spring.local.noalias() = frames_[g].transpose() * spring.E;
    springs_.push_back(spring);
    flexibility_.push_back(1.0 / springs[g].stiffness);
  }
}

/// Gives every row its place. Those that stay have no D.
void GripMatrix::order(std::span<const Yield> yields) {
  const auto will_change = [&](int g) {
    return g >= grips_ - kNextToTip || yields[static_cast<std::size_t>(g)].lateral > 0.0;
  };
  staying_ = 0;
  for (int g = 0; g < grips_; ++g) {
    for (int k = 0; k < 2 && !will_change(g); ++k) place(g, k) = staying_++;
  }
  Eigen::Index next = staying_ + spring_rows();
  for (int g = 0; g < grips_; ++g) {
    for (int k = will_change(g) ? 0 : 2; k < 3; ++k) place(g, k) = next++;
  }
}

/// P + N among the contacts, without D.
void GripMatrix::fill_contacts(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N) {
  for (int h = 0; h < grips_; ++h) {
    const Eigen::Index down = grip_rows() - 3 * h;
    auto both = sum_.topRows(down);
    both.noalias() = A.block(3 * h, 3 * h, down, 3) + N.block(3 * h, 3 * h, down, 3);
    auto columns = turned_.topRows(down);
    columns.noalias() = both.lazyProduct(frame(h));
    for (int g = h; g < grips_; ++g) {
      const Mat3 block = frame(g).transpose() * columns.middleRows<3>(3 * (g - h));
      if (g == h) own_[static_cast<std::size_t>(h)] = block.trace() / 3.0;
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) lower(place(g, i), place(h, j)) = block(i, j);
      }
    }
  }
}

/// P E and Eᵀ P E − K⁻¹, without D.
void GripMatrix::fill_springs(const Eigen::Ref<const MatX>& A) {
  for (std::size_t s = 0; s < springs_.size(); ++s) {
    const Spring& spring = springs_[s];
    const Eigen::Index at = staying_ + 2 * static_cast<Eigen::Index>(s);
    auto columns = turned_.leftCols<2>().topRows(grip_rows());
    columns.noalias() = A.middleCols<3>(3 * spring.grip).lazyProduct(spring.E);
    for (int g = 0; g < grips_; ++g) {
      const Eigen::Matrix<double, 3, 2> block = frame(g).transpose() * columns.middleRows<3>(3 * g);
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 2; ++j) lower(place(g, i), at + j) = block(i, j);
      }
    }
    for (std::size_t r = s; r < springs_.size(); ++r) {
      const Spring& other = springs_[r];
      factor_.block<2, 2>(staying_ + 2 * static_cast<Eigen::Index>(r), at).noalias() =
          other.E.transpose() * columns.middleRows<3>(3 * other.grip);
    }
    factor_.block<2, 2>(at, at).diagonal().array() -= flexibility_[s];
  }
}

bool GripMatrix::factorise(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N,
                           std::span<const LentSpring> springs, std::span<const Yield> yields) {
  fill(A, N, springs, yields);
  return factorise_filled();
}

void GripMatrix::fill(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N,
                      std::span<const LentSpring> springs, std::span<const Yield> yields) {
  grips_ = static_cast<int>(A.rows() / 3);
  std::copy(yields.begin(), yields.end(), yields_.begin());
  for (int g = 0; g < grips_; ++g)
    frames_[static_cast<std::size_t>(g)] = frame_along(yields[static_cast<std::size_t>(g)].along);
  take_springs(springs);
  order(yields);
  fill_contacts(A, N);
  fill_springs(A);
  appended_ = 0;
  current_ = false;
  current_before_ = 0;
}

bool GripMatrix::factorise_filled() { return dense::factorise_first(factor_.topLeftCorner(rows(), rows()), staying_); }

bool GripMatrix::append(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N, const Yield& yield) {
  assert(A.rows() == grip_rows() + 3 && N.rows() == grip_rows() + 3);
  if (appended_ == kMostAppended) return false;
  ++appended_;
  current_ = false;
  current_before_ = 0;
  const int last = grips_++;
  const auto l = static_cast<std::size_t>(last);
  frames_[l] = frame_along(yield.along);
  yields_[l] = yield;
  const Eigen::Index at = rows() - 3;
  for (int k = 0; k < 3; ++k) place(last, k) = at + k;

  // Its columns of B in the order of the rows, as far as they are there; then as L has them; then what is left.
  auto columns = work_.topLeftCorner(rows(), 3);
  auto turned = turned_.topRows(grip_rows());
  turned.noalias() = A.middleCols<3>(3 * last).lazyProduct(frame(last));
  for (std::size_t s = 0; s < springs_.size(); ++s)
    columns.middleRows<2>(staying_ + 2 * static_cast<Eigen::Index>(s)).noalias() =
        springs_[s].E.transpose() * turned.middleRows<3>(3 * springs_[s].grip);
  turned.noalias() += N.middleCols<3>(3 * last).lazyProduct(frame(last));
  for (int g = 0; g < grips_; ++g) {
    const Mat3 block = frame(g).transpose() * turned.middleRows<3>(3 * g);
    for (int i = 0; i < 3; ++i) columns.row(place(g, i)) = block.row(i);
  }
  own_[l] = columns.bottomRows<3>().trace() / 3.0;
  auto in_L = columns.topRows(staying_);
  dense::solve_lower(factor_.topLeftCorner(staying_, staying_), 0, in_L);
  factor_.block(at, 0, 3, staying_) = in_L.transpose();
  auto rest = columns.bottomRows(rows() - staying_);
  dense::subtract_product(rest, factor_.block(staying_, 0, rows() - staying_, staying_), in_L);
  factor_.block(at, staying_, 3, rows() - staying_) = rest.transpose();
  return true;
}

bool GripMatrix::keep_first(int grips) {
  assert(grips <= grips_);
  for (int g = grips; g < grips_; ++g) {
    if (stays(g, 0)) return false;
  }
  if (!springs_.empty() && springs_.back().grip >= grips) return false;
  current_ = current_ && grips == grips_;
  if (!current_) current_before_ = 0;
  grips_ = grips;
  return true;
}

bool GripMatrix::change(std::span<const Yield> yields) {
  for (int g = 0; g < grips_; ++g) {
    const Yield& now = yields[static_cast<std::size_t>(g)];
    Yield& then = yields_[static_cast<std::size_t>(g)];
    const double sideways = std::abs(now.axial - now.lateral) * (now.along - then.along).norm();
    if (sideways > kTurned * (own_[static_cast<std::size_t>(g)] + now.lateral)) return false;
    if (differs(now.lateral, then.lateral)) {
      if (stays(g, 0)) return false;
      then.lateral = now.lateral;
      outdate(place(g, 0));
    }
    if (differs(now.axial, then.axial)) {
      then.axial = now.axial;
      outdate(place(g, 2));
    }
  }
  if (!current_) current_ = factorise_changing();
  return current_;
}

/// D of a row has changed.
void GripMatrix::outdate(Eigen::Index row) {
  current_ = false;
  current_before_ = std::min(current_before_, row - staying_ - spring_rows());
}

/// Puts D into what is left of the rows that change, and takes them and the springs out.
bool GripMatrix::factorise_changing() {
  ++version_;
  const Eigen::Index c = changing();
  const Eigen::Index s = spring_rows();
  const Eigen::Index first = staying_ + s;
  auto L = changing_.topLeftCorner(c, c);
  const Eigen::Index from = current_before_ / dense::kTile * dense::kTile;
  current_before_ = 0;
  for (Eigen::Index j = from; j < c; ++j) L.col(j).tail(c - j) = factor_.col(first + j).segment(first + j, c - j);
  for (int g = 0; g < grips_; ++g) {
    for (int k = 0; k < 3; ++k) {
      if (stays(g, k)) continue;
      const Eigen::Index i = place(g, k) - first;
      if (i >= from) L(i, i) += component(yields_[static_cast<std::size_t>(g)], k);
    }
  }
  if (!dense::factorise_from(L, from)) return false;
  current_before_ = c;
  if (s == 0) return true;

  auto across = by_springs_.topLeftCorner(c, s);
  across = factor_.block(first, staying_, c, s);
  for (const Spring& spring : springs_) {
    const Eigen::Index at = 2 * (&spring - springs_.data());
    for (int k = 0; k < 3; ++k) {
      if (!stays(spring.grip, k)) across.block<1, 2>(place(spring.grip, k) - first, at) += own(spring, k);
    }
  }
  dense::solve_lower(L, 0, across);
  auto left = left_.topLeftCorner(s, s);
  dense::transposed_product(left, across, across);
  for (Eigen::Index j = 0; j < s; ++j) {
    for (Eigen::Index i = 0; i < s; ++i)
      left(i, j) = factor_(staying_ + std::max(i, j), staying_ + std::min(i, j)) - left(i, j);
  }
  for (const Spring& spring : springs_) {
    const Eigen::Index at = 2 * (&spring - springs_.data());
    for (int k = 0; k < 3; ++k) {
      if (!stays(spring.grip, k))
        left.block<2, 2>(at, at).noalias() += spring.local.row(k).transpose() * own(spring, k);
    }
  }
  return dense::factorise_lu(left, pivots_);
}

/// What D of a contact's direction gives its spring's two.
Eigen::RowVector2d GripMatrix::own(const Spring& spring, int k) const {
  return component(yields_[static_cast<std::size_t>(spring.grip)], k) * spring.local.row(k);
}

void GripMatrix::across(const Eigen::Ref<const VecX>& y, Eigen::Ref<VecX> along) const {
  for (const Spring& spring : springs_)
    along.segment<2>(2 * (&spring - springs_.data())).noalias() = spring.E.transpose() * y.segment<3>(3 * spring.grip);
}

void GripMatrix::add_lent(const Eigen::Ref<const VecX>& f, Eigen::Ref<VecX> y) const {
  for (const Spring& spring : springs_)
    y.segment<3>(3 * spring.grip).noalias() += spring.E * f.segment<2>(2 * (&spring - springs_.data()));
}

// NOLINTBEGIN(performance-unnecessary-value-param): Y is written through the view

void GripMatrix::begin(Eigen::Ref<MatX> Y) {
  auto ordered = work_.topLeftCorner(rows(), Y.cols());
  for (int g = 0; g < grips_; ++g) {
    for (Eigen::Index j = 0; j < Y.cols(); ++j) {
      const Vec3 local = frame(g).transpose() * Y.col(j).segment<3>(3 * g);
      for (int k = 0; k < 3; ++k) ordered(place(g, k), j) = local[k];
    }
  }
  ordered.middleRows(staying_, spring_rows()) = Y.bottomRows(spring_rows());
  const Eigen::Index rest = rows() - staying_;
  dense::solve_lower(factor_.topLeftCorner(staying_, staying_), 0, ordered.topRows(staying_));
  dense::subtract_product(ordered.bottomRows(rest), factor_.block(staying_, 0, rest, staying_),
                          ordered.topRows(staying_));
  Y = ordered;
}

void GripMatrix::finish(Eigen::Ref<MatX> Y) {
  assert(current_);
  const Eigen::Index c = changing();
  const Eigen::Index s = spring_rows();
  const Eigen::Index rest = rows() - staying_;
  const auto L = changing_.topLeftCorner(c, c);
  auto of_changing = Y.bottomRows(c);
  auto of_springs = Y.middleRows(staying_, s);
  auto known = work_.leftCols(Y.cols());
  dense::solve_lower(L, 0, of_changing);
  if (s > 0) {
    const auto across = by_springs_.topLeftCorner(c, s);
    dense::transposed_product(known.topRows(s), across, of_changing);
    of_springs -= known.topRows(s);
    dense::solve_lu(left_.topLeftCorner(s, s), pivots_, of_springs);
    dense::subtract_product(of_changing, across, of_springs);
  }
  dense::solve_upper(L, of_changing);
  dense::transposed_product(known.topRows(staying_), factor_.block(staying_, 0, rest, staying_), Y.bottomRows(rest));
  Y.topRows(staying_) -= known.topRows(staying_);
  dense::solve_upper(factor_.topLeftCorner(staying_, staying_), Y.topRows(staying_));

  auto ordered = work_.topLeftCorner(rows(), Y.cols());
  ordered = Y;
  for (int g = 0; g < grips_; ++g) {
    for (Eigen::Index j = 0; j < Y.cols(); ++j) {
      const Vec3 local(ordered(place(g, 0), j), ordered(place(g, 1), j), ordered(place(g, 2), j));
      Y.col(j).segment<3>(3 * g).noalias() = frame(g) * local;
    }
  }
  Y.bottomRows(s) = ordered.middleRows(staying_, s);
}

// NOLINTEND(performance-unnecessary-value-param)

}  // namespace stylet
