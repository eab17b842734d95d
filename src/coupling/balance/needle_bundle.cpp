// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/balance/needle_bundle.hpp"

#include "core/largest.hpp"

#include <algorithm>

namespace stylet {

NeedleBundle::NeedleBundle(Needle& moving, std::span<const AtRest> at_rest, int most_own) : moving_(moving) {
  Eigen::Index dofs = moving.state().size();
  for (const AtRest& rest : at_rest) {
    const Eigen::Index rows = 3 * static_cast<Eigen::Index>(rest.contacts);
    resting_.push_back({rest.needle, first_own_, rest.contacts, MatX::Zero(rows, rows)});
    first_own_ += rest.contacts;
    dofs += rest.needle->state().size();
  }
  const Eigen::Index rows = 3 * static_cast<Eigen::Index>(most_own);
  loads_.reserve(static_cast<std::size_t>(most_own));
  springs_.reserve(static_cast<std::size_t>(most_own));
  compliance_ = prepared_ = MatX::Zero(rows, rows);
  motion_ = VecX::Zero(rows);
  state_ = VecX::Zero(dofs);
}

/// The loads on the needle that the hand moves.
std::span<const PointLoad> NeedleBundle::own(std::span<const PointLoad> loads) {
  loads_.assign(1, loads.front());
  const auto shaft = loads.subspan(static_cast<std::size_t>(first_own_));
  loads_.insert(loads_.end(), shaft.begin(), shaft.end());
  return loads_;
}

std::span<const Mat3> NeedleBundle::own_springs(std::span<const Mat3> springs) {
  if (springs.empty()) return {};
  springs_.assign(1, springs.front());
  const auto shaft = springs.subspan(static_cast<std::size_t>(first_own_));
  springs_.insert(springs_.end(), shaft.begin(), shaft.end());
  return springs_;
}

// NOLINTBEGIN(performance-unnecessary-value-param): the results are written through their views

/// Writes the own compliance to its place among that of all needles.
void NeedleBundle::write_own(const Eigen::Ref<const MatX>& from, Eigen::Ref<MatX> to) const {
  const Eigen::Index shaft = from.cols() - 3;
  to.topLeftCorner<3, 3>() = from.topLeftCorner<3, 3>();
  to.bottomLeftCorner(shaft, 3) = from.bottomLeftCorner(shaft, 3);
  to.topRightCorner(3, shaft) = from.topRightCorner(3, shaft);
  to.bottomRightCorner(shaft, shaft) = from.bottomRightCorner(shaft, shaft);
}

/// Writes the compliance of the needles at rest.
void NeedleBundle::write_resting(Eigen::Ref<MatX> to) const {
  for (const Resting& rest : resting_) {
    const Eigen::Index at = 3 * static_cast<Eigen::Index>(rest.first);
    to.block(at, at, rest.block.rows(), rest.block.cols()) = rest.block;
  }
}

void NeedleBundle::write_own_motion(Eigen::Index rows, Eigen::Ref<VecX> to) const {
  to.head<3>() = motion_.head<3>();
  to.tail(rows - 3) = motion_.segment(3, rows - 3);
}

bool NeedleBundle::linearise(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free,
                             std::span<const Mat3> springs, Indefinite otherwise) {
  const auto mine = own(loads);
  const Eigen::Index rows = 3 * static_cast<Eigen::Index>(mine.size());
  auto own_compliance = compliance_.topLeftCorner(rows, rows);
  bool stable = moving_.linearise(mine, own_compliance, motion_.head(rows), own_springs(springs), otherwise);
  if (!stable && otherwise == Indefinite::give_up) return false;
  for (Resting& rest : resting_) {
    const auto first = static_cast<std::size_t>(rest.first);
    const auto count = static_cast<std::size_t>(rest.count);
    if (keeps_resting_ && rest.needle->relax(loads.subspan(first, count), free.segment(3 * rest.first, 3 * rest.count)))
      continue;
    const auto lent = springs.empty() ? springs : springs.subspan(first, count);
    const bool rests = rest.needle->linearise(loads.subspan(first, count), rest.block,
                                              free.segment(3 * rest.first, 3 * rest.count), lent, otherwise);
    if (!rests && otherwise == Indefinite::give_up) return false;
    stable = stable && rests;
  }
  write_own(own_compliance, compliance);
  write_resting(compliance);
  write_own_motion(rows, free);
  return stable;
}

bool NeedleBundle::relax(std::span<const PointLoad> loads, Eigen::Ref<VecX> free) {
  const auto mine = own(loads);
  const Eigen::Index rows = 3 * static_cast<Eigen::Index>(mine.size());
  if (!moving_.relax(mine, motion_.head(rows))) return false;
  for (const Resting& rest : resting_) {
    const auto part = loads.subspan(static_cast<std::size_t>(rest.first), static_cast<std::size_t>(rest.count));
    if (!rest.needle->relax(part, free.segment(3 * rest.first, 3 * rest.count))) return false;
  }
  write_own_motion(rows, free);
  return true;
}

bool NeedleBundle::relax_resting(std::span<const PointLoad> loads, Eigen::Ref<VecX> free,
                                 std::span<const Mat3> springs) {
  bool fit = true;
  for (Resting& rest : resting_) {
    const auto first = static_cast<std::size_t>(rest.first);
    const auto count = static_cast<std::size_t>(rest.count);
    const auto part = loads.subspan(first, count);
    auto motion = free.segment(3 * rest.first, 3 * rest.count);
    if (rest.needle->relax(part, motion)) continue;
    fit = false;
    const auto lent = springs.empty() ? springs : springs.subspan(first, count);
    rest.needle->linearise(part, rest.block, motion, lent, Indefinite::shift);
  }
  return fit;
}

bool NeedleBundle::append(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance) {
  const auto mine = own(loads);
  const Eigen::Index rows = 3 * static_cast<Eigen::Index>(mine.size());
  if (!moving_.append(mine, compliance_.topLeftCorner(3, rows))) return false;
  compliance.leftCols<3>() = compliance_.topLeftCorner<3, 3>();
  compliance.middleCols(3, resting_rows()).setZero();
  compliance.rightCols(rows - 3) = compliance_.block(0, 3, 3, rows - 3);
  return true;
}

bool NeedleBundle::prepare(std::span<const PointLoad> loads, std::span<const Mat3> springs, Indefinite otherwise) {
  const auto mine = own(loads);
  prepared_count_ = static_cast<int>(mine.size());
  return moving_.prepare(mine, own_springs(springs), otherwise);
}

bool NeedleBundle::prepared_compliance(Eigen::Ref<MatX> compliance) {
  const Eigen::Index rows = 3 * static_cast<Eigen::Index>(prepared_count_);
  auto own_compliance = prepared_.topLeftCorner(rows, rows);
  if (!moving_.prepared_compliance(own_compliance)) return false;
  write_own(own_compliance, compliance);
  write_resting(compliance);
  return true;
}

// NOLINTEND(performance-unnecessary-value-param)

void NeedleBundle::advance(std::span<const PointLoad> loads) {
  moving_.advance(own(loads));
  advance_resting(loads);
}

void NeedleBundle::advance_resting(std::span<const PointLoad> loads) {
  for (const Resting& rest : resting_)
    rest.needle->advance(loads.subspan(static_cast<std::size_t>(rest.first), static_cast<std::size_t>(rest.count)));
}

double NeedleBundle::residual(std::span<const PointLoad> loads) {
  return larger_or_nan(residual_of_moving(loads), residual_of_resting(loads));
}

double NeedleBundle::residual_of_resting(std::span<const PointLoad> loads) const {
  double largest = 0.0;
  for (const Resting& rest : resting_) {
    const auto part = loads.subspan(static_cast<std::size_t>(rest.first), static_cast<std::size_t>(rest.count));
    largest = larger_or_nan(largest, rest.needle->residual(part));
  }
  return largest;
}

double NeedleBundle::energy() const {
  double sum = moving_.energy();
  for (const Resting& rest : resting_) sum += rest.needle->energy();
  return sum;
}

Eigen::Ref<const VecX> NeedleBundle::state() const {
  Eigen::Index at = moving_.state().size();
  state_.head(at) = moving_.state();
  for (const Resting& rest : resting_) {
    const Eigen::Index size = rest.needle->state().size();
    state_.segment(at, size) = rest.needle->state();
    at += size;
  }
  return state_;
}

void NeedleBundle::set_state(const Eigen::Ref<const VecX>& state) {
  Eigen::Index at = moving_.state().size();
  moving_.set_state(state.head(at));
  for (const Resting& rest : resting_) {
    const Eigen::Index size = rest.needle->state().size();
    rest.needle->set_state(state.segment(at, size));
    at += size;
  }
}

}  // namespace stylet
