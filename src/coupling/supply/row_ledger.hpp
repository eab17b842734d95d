// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/supply/parcel.hpp"

namespace stylet {

/// What a worker knows of the store and the near field, which it must not look at while steps are under way: which
/// nodes have rows, which slots are free, and which ones the worker has filled and may ask back. It is copied from them
/// once and kept right by what parcels bring and take.
class RowLedger {
 public:
  /// @param nodes number of displacement nodes
  explicit RowLedger(Index nodes);

  /// Copies who has which slot, and makes sure that there are free ones: together with those that were filled through
  /// this ledger and are still in use as many as `spare_nodes`. Nobody may be changing the store. Allocates.
  void read(ComplianceStore& store, Index spare_nodes);
  /// Copies which nodes the near field has. Nobody may be changing it.
  void read(const MeshKernel& kernel);

  [[nodiscard]] bool has_row(Index node) const { return slots_.has(node); }
  [[nodiscard]] bool has_kernel_row(Index node) const { return has_kernel_[static_cast<std::size_t>(node)] != 0; }
  [[nodiscard]] const NodeSlots& slots() const { return slots_; }
  /// Slots that rows may be made for.
  [[nodiscard]] std::size_t free_slots() const { return free_.size(); }
  /// The free slots that the next `count` rows are to have, for record().
  [[nodiscard]] std::span<const Index> next_slots(std::size_t count) const { return std::span(free_).last(count); }

  /// A round begins; refusals are remembered for some rounds.
  void begin_round() { ++round_; }
  /// Notes the step's answer: a slot that was given up is free, one that was not is not asked for again so soon.
  void note(const SupplyParcel::Leaver& answer);
  /// Slots that may be asked for: filled through this ledger, not refused lately, and their nodes not wanted.
  /// @param wanted nodes
  [[nodiscard]] std::vector<Index> dispensable(std::span<const Index> wanted) const;
  /// Notes rows as made. If memory runs out nothing has changed.
  /// @param rows in next_slots(), @param kernel_nodes nodes whose rows of the near field were made
  void record(std::span<const ComplianceRow> rows, std::span<const Index> kernel_nodes);

 private:
  void find_free(const NodeSlots& slots, std::size_t most);

  NodeSlots slots_;
  std::vector<char> has_kernel_;         ///< (displacement nodes)
  std::vector<Index> free_;              ///< slots that are free
  std::vector<Index> own_;               ///< slots that were filled through this ledger
  std::vector<unsigned> refused_until_;  ///< (displacement nodes) round after which the node may be asked for again
  unsigned round_ = 0;
};

}  // namespace stylet
