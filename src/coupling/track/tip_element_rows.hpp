// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/tip_element.hpp"
#include "stylet/geom/locator.hpp"

#include <vector>

namespace stylet {

/// The compliances between the nodes of the tip's element and the points, A(node, point) [mm/N] (3×3): displacement of
/// the node per force on the point. The displacement of any place in the element is interpolated from the element's
/// nodes, and so is its compliance: combine() interpolates it without reading the store.
///
/// Nodes have their numbers from TipElement and keep their rows while the tip goes through elements that share them.
/// Points count from 1; 0 is the tip, which has no column. After construction nothing allocates.
class TipElementRows {
 public:
  /// Compliances with the points 1, 2, … [mm/N], side by side (3 × 3 points).
  using Blocks = Eigen::Map<const Eigen::Matrix<double, 3, Eigen::Dynamic>>;

  /// @param capacity largest number of points
  explicit TipElementRows(int capacity);

  /// Removes the tip and all rows.
  void reset();

  /// Moves the tip. @param shape interpolation of the tip at its new place
  /// @return numbers of the nodes that the element before did not have; their rows have to be written
  std::span<const int> move(const MaterialPoint& at, const Shape& shape);

  [[nodiscard]] const MaterialPoint& at() const { return at_; }  ///< place of the tip; element −1: none
  [[nodiscard]] const TipElement& element() const { return element_; }

  /// A(node, point) [mm/N]. @param number of the node in the element, @param point from 1
  [[nodiscard]] Mat3& row(int number, int point) { return rows_[position(number, point)]; }
  [[nodiscard]] const Mat3& row(int number, int point) const { return rows_[position(number, point)]; }

  /// Σ (weight of a node) × (its row): the compliances with the points 1 … points. Valid until the next call.
  [[nodiscard]] Blocks combine(const TipElement::Weights& weights, int points);

  /// The same for one point.
  [[nodiscard]] Mat3 combine_one(const TipElement::Weights& weights, int point) const;

 private:
  [[nodiscard]] std::size_t position(int number, int point) const {
    return static_cast<std::size_t>(number * (capacity_ + 1) + point);
  }

  int capacity_;
  MaterialPoint at_;
  TipElement element_;
  std::vector<Mat3> rows_;  ///< (node numbers × points)
  VecX combined_;           ///< (9 × points) blocks of the last combine()
};

}  // namespace stylet
