// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/supply/parcel.hpp"

namespace stylet {

/// The worker's own record of the store and the mesh kernel, which it must not read while steps are running: which
/// nodes have rows, which slots are free, and which slots the worker has filled and may request back. It is read from
/// store and kernel once, and then updated from the parcels.
class RowLedger {
 public:
  /// @param nodes number of displacement nodes
  explicit RowLedger(Index nodes);

  /// Reads which node has which slot, and provides free slots: the free slots and the slots in use that were filled
  /// through this ledger are together `spare_nodes`. The store must not be changing. Allocates.
  void read(ComplianceStore& store, Index spare_nodes);
  /// Reads which nodes have rows in the mesh kernel, which must not be changing.
  void read(const MeshKernel& kernel);

  [[nodiscard]] bool has_row(Index node) const { return slots_.has(node); }
  [[nodiscard]] bool has_kernel_row(Index node) const { return has_kernel_[static_cast<std::size_t>(node)] != 0; }
  [[nodiscard]] const NodeSlots& slots() const { return slots_; }
  /// Number of slots for which rows may be made.
  [[nodiscard]] std::size_t free_slots() const { return free_.size(); }
  /// The free slots for the next `count` rows, to be passed to record().
  [[nodiscard]] std::span<const Index> next_slots(std::size_t count) const { return std::span(free_).last(count); }

  /// Begins a round; refusals are valid for a number of rounds.
  void begin_round() { ++round_; }
  /// Records the step's answer: a slot that was given up is free; a slot that was refused is not requested again for
  /// some rounds.
  void note(const SupplyParcel::Leaver& answer);
  /// Slots that may be requested: filled through this ledger, not refused recently, and with nodes that are not wanted.
  /// @param wanted nodes that the needle needs
  [[nodiscard]] std::vector<Index> dispensable(std::span<const Index> wanted) const;
  /// Records rows as made. If memory runs out, nothing has changed.
  /// @param rows rows in next_slots() @param kernel_nodes nodes for which rows of the mesh kernel were made
  void record(std::span<const ComplianceRow> rows, std::span<const Index> kernel_nodes);

 private:
  void find_free(const NodeSlots& slots, std::size_t most);

  NodeSlots slots_;
  std::vector<char> has_kernel_;         ///< (displacement nodes)
  std::vector<Index> free_;              ///< free slots
  std::vector<Index> own_;               ///< slots that were filled through this ledger
  std::vector<unsigned> refused_until_;  ///< (displacement nodes) round from which on the node's slot may be requested
                                         ///< again
  unsigned round_ = 0;
};

}  // namespace stylet
