// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <cassert>
#include <vector>

namespace stylet {

/// Which node has which slot of a table: numbers only, no data.
class NodeSlots {
 public:
  explicit NodeSlots(Index nodes) : slot_(static_cast<std::size_t>(nodes), kNone) {}

  /// Slot of a node; negative: it has none.
  [[nodiscard]] Index slot(Index node) const { return slot_[static_cast<std::size_t>(node)]; }
  /// Node in a slot, −1 where it is free.
  [[nodiscard]] Index node(Index slot) const { return node_[static_cast<std::size_t>(slot)]; }
  [[nodiscard]] bool has(Index node) const { return slot(node) >= 0; }

  /// Slots there are, free ones included.
  [[nodiscard]] Index count() const { return static_cast<Index>(node_.size()); }
  /// Makes free slots at the end. Allocates.
  void resize(Index slots) { node_.resize(static_cast<std::size_t>(slots), kNone); }

  void occupy(Index slot, Index node) {
    assert(this->node(slot) == kNone && this->slot(node) == kNone);
    node_[static_cast<std::size_t>(slot)] = node;
    slot_[static_cast<std::size_t>(node)] = slot;
  }
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
