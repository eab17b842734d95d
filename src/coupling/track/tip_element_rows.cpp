// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/track/tip_element_rows.hpp"

namespace stylet {

TipElementRows::TipElementRows(int capacity)
    : capacity_(capacity),
      rows_(static_cast<std::size_t>(kMostElementNodes * (capacity + 1))),
      combined_(VecX::Zero(9 * static_cast<Eigen::Index>(capacity))) {}

void TipElementRows::reset() {
  at_ = {};
  element_.reset();
}

std::span<const int> TipElementRows::move(const MaterialPoint& at, const Shape& shape) {
  const bool other = at.tet != at_.tet;
  at_ = at;
  return other ? element_.enter(shape) : std::span<const int>();
}

TipElementRows::Blocks TipElementRows::combine(const TipElement::Weights& weights, int points) {
  // The blocks of one node lie one after the other, so that the row is one long vector.
  const Eigen::Index size = 9 * static_cast<Eigen::Index>(points);
  auto sum = combined_.head(size);
  sum.setZero();
  for (int i = 0; i < element_.count(); ++i) {
    const int number = element_.number(i);
    sum += weights[static_cast<std::size_t>(number)] * Eigen::Map<const VecX>(row(number, 1).data(), size);
  }
  return {combined_.data(), 3, 3 * static_cast<Eigen::Index>(points)};
}

Mat3 TipElementRows::combine_one(const TipElement::Weights& weights, int point) const {
  Mat3 sum = Mat3::Zero();
  for (int i = 0; i < element_.count(); ++i) {
    const int number = element_.number(i);
    sum += weights[static_cast<std::size_t>(number)] * row(number, point);
  }
  return sum;
}

}  // namespace stylet
