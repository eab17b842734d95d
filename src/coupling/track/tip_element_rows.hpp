// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/tip_element.hpp"
#include "stylet/geom/locator.hpp"

#include <vector>

namespace stylet {

/// The compliances between the nodes of the element that the needle's tip is in and the points that the needle holds,
/// A(node, point) [mm/N] (3×3): displacement of the node per force on the point. Whatever lies in the element is
/// interpolated from its nodes, and so are its compliances: combine() does that without a look at the mesh's
/// compliance.
///
/// Nodes are known by their numbers in the TipElement and keep their rows while the tip goes from element to element.
/// Points count from 1 (0 is the tip itself, which has no column). After construction nothing allocates.
class TipElementRows {
 public:
  /// Compliances with the points 1, 2, … [mm/N], side by side (3 × 3 points).
  using Blocks = Eigen::Map<const Eigen::Matrix<double, 3, Eigen::Dynamic>>;

  /// @param capacity largest number of points
  explicit TipElementRows(int capacity);

  /// The tip is nowhere; no node is known.
  void reset();

  /// The tip has moved. @param shape of the tip at its new place
  /// @return numbers of the nodes that the element before did not have, whose rows have to be written
  std::span<const int> move(const MaterialPoint& at, const Shape& shape);

  [[nodiscard]] const MaterialPoint& at() const { return at_; }  ///< place of the tip; element −1 where it is nowhere
  [[nodiscard]] const TipElement& element() const { return element_; }

  /// A(node, point) [mm/N]. @param number of the node in the element, @param point from 1
  [[nodiscard]] Mat3& row(int number, int point) { return rows_[position(number, point)]; }
  [[nodiscard]] const Mat3& row(int number, int point) const { return rows_[position(number, point)]; }

  /// Σ (weight of a node) × (its row): the compliances with the points 1 … points. Good until the next call.
  [[nodiscard]] Blocks combine(const TipElement::Weights& weights, int points);

 private:
  [[nodiscard]] std::size_t position(int number, int point) const {
    return static_cast<std::size_t>(number * (capacity_ + 1) + point);
  }

  int capacity_;
  MaterialPoint at_;
  TipElement element_;
  std::vector<Mat3> rows_;  ///< (node numbers × points) rows of the nodes, one after the other
  VecX combined_;           ///< (9 × points) blocks of the last combination, one after the other
};

}  // namespace stylet
