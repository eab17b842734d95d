// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/paper/dense_inverse.hpp"

#include <algorithm>
#include <cmath>

namespace stylet::paper {

MatX full_inverse(const Tissue& tissue, const Progress& progress) {
  constexpr Index batch = 192;
  const Index N = tissue.free_dofs();
  const Index nodes = tissue.mesh().node_count();
  std::vector<Eigen::Index> row_of(static_cast<std::size_t>(N));  // row over all nodes of each degree of freedom
  for (Index node = 0; node < nodes; ++node) {
    const Index first = tissue.first_dof(node);
    if (first < 0) continue;
    for (Index axis = 0; axis < 3; ++axis) row_of[static_cast<std::size_t>(first + axis)] = 3 * node + axis;
  }
  MatX inverse(N, N);
  for (Index begin = 0; begin < N; begin += batch) {
    report(progress, "inverting the stiffness", static_cast<double>(begin) / N);
    const Index count = std::min(batch, N - begin);
    MatX f = MatX::Zero(3 * nodes, count);
    for (Index j = 0; j < count; ++j) f(row_of[static_cast<std::size_t>(begin + j)], j) = 1.0;
    const MatX u = tissue.solve(f);
    for (Index j = 0; j < count; ++j)
      for (Index i = 0; i < N; ++i) inverse(i, begin + j) = u(row_of[static_cast<std::size_t>(i)], j);
  }
  for (Index j = 0; j < N; ++j)
    for (Index i = 0; i < j; ++i) inverse(i, j) = inverse(j, i) = 0.5 * (inverse(i, j) + inverse(j, i));
  report(progress, "inverting the stiffness", 1.0);
  return inverse;
}

DenseInverse::DenseInverse(Engine engine, std::shared_ptr<const MatX> initial, int room)
    : engine_(engine), initial_(std::move(initial)) {
  const Eigen::Index size = initial_->rows() + 3 * room;
  values_.resize(size, size);
  mean_diagonal_ = initial_->rows() > 0 ? initial_->diagonal().mean() : 1.0;
  set_springs(1.0);
  reset();
}

void DenseInverse::reset() {
  dofs_ = settled_ = static_cast<Index>(initial_->rows());
  used() = *initial_;
}

Index DenseInverse::append_node() {
  const Index first = dofs_;
  dofs_ += 3;
  values_.block(first, 0, 3, dofs_).setZero();
  values_.block(0, first, dofs_, 3).setZero();
  if (engine_ == Engine::woodbury) values_.diagonal().segment<3>(first).setConstant(delta_);
  return first;
}

double DenseInverse::change(std::span<const Index> dofs, const MatX& change) {
  if (engine_ == Engine::bcs) {
    update_by_switches<double>(used(), dofs, change, settled_);
    settled_ = dofs_;
    return std::numeric_limits<double>::quiet_NaN();
  }
  MatX without_springs = change;
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (dofs[i] >= settled_) without_springs(k, k) -= 1.0 / delta_;
  }
  const double condition = update_by_woodbury_symmetric(used(), dofs, without_springs);
  if (std::isfinite(condition)) settled_ = dofs_;
  return condition;
}

VecX DenseInverse::operator*(const VecX& f) const {
  return values_.topLeftCorner(dofs_, dofs_).selfadjointView<Eigen::Lower>() * f;
}

double DenseInverse::megabytes() const {
  return static_cast<double>(values_.size() + initial_->size()) * sizeof(double) / 1048576.0;
}

}  // namespace stylet::paper
