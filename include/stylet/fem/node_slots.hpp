// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <cassert>
#include <vector>

namespace stylet {

/// Assignment of nodes to the slots of a table: numbers only, no data.
class NodeSlots {
 public:
  explicit NodeSlots(Index nodes) : slot_(static_cast<std::size_t>(nodes), kNone) {}

  /// Slot of a node; negative when the node has none.
  [[nodiscard]] Index slot(Index node) const { return slot_[static_cast<std::size_t>(node)]; }
  /// Node in a slot, −1 when the slot is free.
  [[nodiscard]] Index node(Index slot) const { return node_[static_cast<std::size_t>(slot)]; }
  [[nodiscard]] bool has(Index node) const { return slot(node) >= 0; }

  /// Number of slots, including free ones.
  [[nodiscard]] Index count() const { return static_cast<Index>(node_.size()); }
  /// Changes the number of slots to `slots`; new slots are free. Allocates.
  void resize(Index slots) { node_.resize(static_cast<std::size_t>(slots), kNone); }

  /// Puts a node without a slot into a free slot.
  void occupy(Index slot, Index node) {
    assert(this->node(slot) == kNone && this->slot(node) == kNone);
    node_[static_cast<std::size_t>(slot)] = node;
    slot_[static_cast<std::size_t>(node)] = slot;
  }
  /// Frees an occupied slot.
  void vacate(Index slot) {
    slot_[static_cast<std::size_t>(node(slot))] = kNone;
    node_[static_cast<std::size_t>(slot)] = kNone;
  }

 private:
  static constexpr Index kNone = -1;
  std::vector<Index> slot_;  ///< (nodes)
  std::vector<Index> node_;  ///< (slots)
};

}  // namespace stylet
