// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/shape.hpp"

#include <algorithm>
#include <optional>
#include <span>

namespace stylet {

/// The element that contains the needle's tip, with a slot number 0 … kMostElementNodes − 1 for each of its nodes. Data
/// of a node can be kept under its number: a node keeps the number while the tip goes through elements that share this
/// node, and consecutive elements share most of their nodes.
class TipElement {
 public:
  TipElement() { reset(); }

  void reset() {
    node_.fill(-1);
    count_ = 0;
  }

  /// Changes to the element of this shape. @return numbers of the nodes that the element before did not have
  std::span<const int> enter(const Shape& shape) {
    std::array<bool, kMostElementNodes> taken{};
    int fresh = 0;
    count_ = shape.count;
    const auto nodes = std::span(shape.node).first(static_cast<std::size_t>(count_));
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto found = std::find(node_.begin(), node_.end(), nodes[i]);
      number_[i] = found == node_.end() ? -1 : static_cast<int>(found - node_.begin());
      if (number_[i] >= 0) taken[static_cast<std::size_t>(number_[i])] = true;
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (number_[i] >= 0) continue;
      const auto free = std::find(taken.begin(), taken.end(), false) - taken.begin();
      taken[static_cast<std::size_t>(free)] = true;
      node_[static_cast<std::size_t>(free)] = nodes[i];
      number_[i] = fresh_[static_cast<std::size_t>(fresh++)] = static_cast<int>(free);
    }
    return std::span(fresh_).first(static_cast<std::size_t>(fresh));
  }

  [[nodiscard]] int count() const { return count_; }
  /// Number of the i-th node of the element.
  [[nodiscard]] int number(int i) const { return number_[static_cast<std::size_t>(i)]; }
  /// One weight for each number.
  using Weights = std::array<double, kMostElementNodes>;
  /// Weights of a shape's nodes by number; empty where the shape has nodes outside this element, or there is no
  /// element.
  [[nodiscard]] std::optional<Weights> weights(const Shape& shape) const {
    if (count_ == 0) return std::nullopt;
    Weights result{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i) {
      if (shape.weight[i] == 0.0) continue;
      const auto numbers = std::span(number_).first(static_cast<std::size_t>(count_));
      const auto found =
          std::find_if(numbers.begin(), numbers.end(), [&](int number) { return node(number) == shape.node[i]; });
      if (found == numbers.end()) return std::nullopt;
      result[static_cast<std::size_t>(*found)] = shape.weight[i];
    }
    return result;
  }

  /// The displacement node that has a number.
  [[nodiscard]] Index node(int number) const { return node_[static_cast<std::size_t>(number)]; }

 private:
  int count_ = 0;
  std::array<Index, kMostElementNodes> node_{};
  std::array<int, kMostElementNodes> number_{};
  std::array<int, kMostElementNodes> fresh_{};
};

}  // namespace stylet
