// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/compliance_store.hpp"

#include <cassert>
#include <span>
#include <vector>

namespace stylet {

/// Forces on base nodes in three directions at once: one 3×3 block for each node, whose columns are forces.
struct NodeLoads {
  std::span<const Index> nodes;  ///< displacement nodes, each once
  std::span<const Mat3> blocks;  ///< (nodes)
};

/// The observables of a needle track, and their displacements by loads through the base mesh's compliance K⁻¹.
///
/// An observable is a place whose displacement may be needed: the needle's tip, a node of the tip's element, a point,
/// or a vertex of a split element. Each is interpolated from base nodes by a shape. Number 0 is the tip, and the
/// numbers from kTipNodes on are the nodes of its element; their shapes can be set at any time. The other observables,
/// from kFirstFree on, are added one after the other and stay.
///
/// Many of these share nodes. So load() computes the displacement of each of their nodes once, and at() interpolates
/// it. After construction nothing allocates.
class TrackObservables {
 public:
  static constexpr int kTip = 0;
  static constexpr int kTipNodes = 1;
  static constexpr int kFirstFree = kTipNodes + kMostElementNodes;

  /// @param store compliance of the base mesh; must hold every node of every shape and load
  /// @param capacity largest number of added observables
  /// @param most_loads largest number of nodes in a load
  TrackObservables(std::shared_ptr<const ComplianceStore> store, int capacity, int most_loads);

  /// Removes all observables; the tip and the nodes of its element have no shape.
  void reset();

  /// Adds an observable. @param vertex number of the base node that it stands for, −1: none
  /// @return its number
  int add(const Shape& shape, Index vertex = -1);
  /// Removes the observable that was added last.
  void remove_last();
  /// Sets the shape of the tip or of a node of its element. @param observable less than kFirstFree
  void set(int observable, const Shape& shape) { observables_[static_cast<std::size_t>(observable)].shape = shape; }

  [[nodiscard]] int count() const { return static_cast<int>(observables_.size()); }
  [[nodiscard]] const Shape& shape(int observable) const {
    return observables_[static_cast<std::size_t>(observable)].shape;
  }
  /// Number of the observable that stands for a base node; −1: none.
  [[nodiscard]] int find(Index vertex) const;

  /// Compliance of the base mesh between two observables [mm/N] (3×3): displacement of a per force on b.
  [[nodiscard]] Mat3 compliance(int a, int b) const;
  /// Displacement of any observable under forces on base nodes [mm/N × unit of the load] (3×3).
  [[nodiscard]] Mat3 moved_by(const NodeLoads& loads, int observable);

  /// Computes the displacement of all nodes in use under forces on base nodes, for at().
  void load(const NodeLoads& loads);
  /// Computes the displacement of all nodes in use under a unit force on an observable [mm/N], for at().
  void load(int observable);
  /// Displacement of an observable under the last load() [mm/N × unit of the load] (3×3).
  /// @param observable an added observable, from before that load()
  [[nodiscard]] Mat3 at(int observable) const;

  /// Writes `stamp` to each displacement node of a shape.
  /// @param stamps (displacement nodes)
  void mark_nodes(std::span<unsigned> stamps, unsigned stamp) const;

 private:
  struct Observable {
    Shape shape;                   ///< on the base nodes
    std::size_t nodes_before = 0;  ///< length of nodes_ before this observable was added
    std::array<int, kMostElementNodes>
        number{};  ///< positions of the shape's nodes in nodes_; not of those set at will
  };
  [[nodiscard]] Mat3 node_moved_by(const NodeLoads& loads, Index node);

  std::shared_ptr<const ComplianceStore> store_;
  std::vector<Observable> observables_;
  std::vector<Index> vertex_of_;  ///< (observables) base node that the observable stands for, −1: none
  std::vector<Index> nodes_;      ///< base nodes that the added observables are interpolated from, each once
  std::vector<Mat3> field_;       ///< (nodes_) displacement of each node under the last load()
  std::vector<Mat3> blocks_;      ///< (nodes of a load) work space: blocks of the store
};

}  // namespace stylet
