// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/shape.hpp"

#include <algorithm>
#include <optional>
#include <span>

namespace stylet {

/// The element the needle's tip is in. What is known of its nodes depends on the element alone, not on where in it the
/// tip is, and the next element has most of them as well: so each node has a number, 0 … kMostElementNodes − 1, under
/// which things can be kept, and keeps it while the tip goes from element to element that have it.
class TipElement {
 public:
  TipElement() { reset(); }

  void reset() {
    node_.fill(-1);
    count_ = 0;
  }

  /// Goes over to the element of this shape. @return the numbers of the nodes that were not in the one before
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
  /// By the numbers of the nodes.
  using Weights = std::array<double, kMostElementNodes>;
  /// What a shape has of each node; nothing where it has others as well, or the tip is nowhere.
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

  /// Displacement node of a number.
  [[nodiscard]] Index node(int number) const { return node_[static_cast<std::size_t>(number)]; }

 private:
  int count_ = 0;
  std::array<Index, kMostElementNodes> node_{};
  std::array<int, kMostElementNodes> number_{};
  std::array<int, kMostElementNodes> fresh_{};
};

}  // namespace stylet
