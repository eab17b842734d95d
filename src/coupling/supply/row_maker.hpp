// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/nodes_ahead.hpp"
#include "coupling/supply/row_ledger.hpp"

namespace stylet {

/// The worker's side of a ComplianceSupply: finds the nodes that the needle needs next, solves for their rows and puts
/// them into a parcel, and requests slots where none is free.
class RowMaker {
 public:
  using Settings = ComplianceSupply::Settings;
  using Work = ComplianceSupply::Work;

  /// @param store null where no rows are made for it @param kernel null where no rows are made for it
  RowMaker(std::shared_ptr<const Tissue> tissue, std::shared_ptr<ComplianceStore> store,
           std::shared_ptr<MeshKernel> kernel, const Locator& locator);

  /// Reads the state of store and kernel, which must not be changing, because rows may have been added in other ways.
  /// @param parcel may be with either side; rows of an earlier worker that the step has not taken over are lost
  /// @param with_worker whether the step has given the parcel to the worker
  void begin(const Settings& settings, SupplyParcel& parcel, bool with_worker);

  /// Reads the step's answers, and puts rows into the parcel for the wanted nodes that have room, in the order in which
  /// the needle reaches them. May throw when memory or threads run out; the parcel must then be cleared.
  /// @param most largest number of nodes to solve for at once
  /// @param on_own_thread whether steps continue meanwhile, so that the other processor cores are left to them
  /// @return never Work::failed
  [[nodiscard]] Work make(SupplyParcel& parcel, std::size_t most, bool on_own_thread);

 private:
  void note_answers(SupplyParcel& parcel);
  void ask_for_slots(SupplyParcel& parcel, std::size_t count, std::span<const Index> wanted) const;
  [[nodiscard]] bool needs_row(Index node) const {
    return store_ != nullptr && !ledger_.has_row(node) && !tissue_->is_fixed(node);
  }
  [[nodiscard]] bool needs_kernel_row(Index node) const { return kernel_ != nullptr && !ledger_.has_kernel_row(node); }

  std::shared_ptr<const Tissue> tissue_;
  std::shared_ptr<ComplianceStore> store_;  ///< read in begin() only
  std::shared_ptr<MeshKernel> kernel_;      ///< its list of rows is read in begin() only
  Settings settings_;
  NodesAhead ahead_;
  RowLedger ledger_;
};

}  // namespace stylet
