// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/track/track_observables.hpp"

#include <vector>

namespace stylet {

/// A vertex on the border of a split, and the coupling of its displacement with the split's hat.
struct Border {
  int vertex = 0;         ///< number of the vertex among the observables
  Mat3 k = Mat3::Zero();  ///< k_jp = a(φ_j, b_p) [N/mm]
};

/// The borders of all splits. An added node p has a hat b_p. The vertices j of the elements that the node splits are
/// its border, where the energy couples the hat with the displacement of the base mesh: k_jp = a(φ_j, b_p). A node
/// inside an element has no border. Vertices may be interpolated from base nodes, so each border also gives loads on
/// base nodes.
///
/// Splits are numbered in the order of begin(). A split must be complete before the next one begins, and never changes
/// afterwards. No call after construction allocates.
class SplitBorders {
 public:
  static constexpr int kMostVertices = 5;  ///< largest number of vertices of a border: two elements that share a face
  static constexpr int kMostLoads = kMostVertices * kMostElementNodes;  ///< largest number of base nodes with loads of
                                                                        ///< one border

  /// @param capacity largest number of splits
  explicit SplitBorders(int capacity);

  /// Forgets all splits.
  void reset();

  /// Begins the next split, which has no border yet.
  void begin();
  /// Adds k [N/mm] to the coupling between a vertex and the hat of the last split.
  /// @param vertex number of the vertex among the observables
  void add(int vertex, const Mat3& k);
  /// Adds the load k [N/mm] on a vertex of the last split, distributed over the base nodes from which the vertex is
  /// interpolated.
  void add_loads(const Shape& vertex, const Mat3& k);

  [[nodiscard]] int count() const { return static_cast<int>(splits_.size()); }
  /// Border of a split, each vertex once, in the order of add().
  [[nodiscard]] std::span<const Border> border(int split) const {
    return splits_[static_cast<std::size_t>(split)].border.of(borders_);
  }
  /// Loads of a split on base nodes [N/mm], each node once: Σ_j (weight of the node at vertex j) k_jp.
  [[nodiscard]] NodeLoads loads(int split) const {
    const Range& range = splits_[static_cast<std::size_t>(split)].loads;
    return {range.of(load_nodes_), range.of(loads_)};
  }

 private:
  /// The part of a list that belongs to one split.
  struct Range {
    std::size_t first = 0;
    std::size_t count = 0;
    template <class T>
    [[nodiscard]] std::span<T> of(std::vector<T>& all) const {
      return std::span(all).subspan(first, count);
    }
    template <class T>
    [[nodiscard]] std::span<const T> of(const std::vector<T>& all) const {
      return std::span(all).subspan(first, count);
    }
  };
  struct Split {
    Range border;
    Range loads;
  };

  std::vector<Split> splits_;
  std::vector<Border> borders_;    ///< of all splits, one after the other
  std::vector<Index> load_nodes_;  ///< loaded base nodes of all splits, one after the other
  std::vector<Mat3> loads_;        ///< (load_nodes_) [N/mm]
};

}  // namespace stylet
