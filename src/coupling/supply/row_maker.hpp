// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/nodes_ahead.hpp"
#include "coupling/supply/row_ledger.hpp"

namespace stylet {

/// The worker's side of a ComplianceSupply: finds what a needle is about to need, solves for it and puts it into a
/// parcel, and asks for slots where none is free.
class RowMaker {
 public:
  using Settings = ComplianceSupply::Settings;
  using Work = ComplianceSupply::Work;

  /// @param store null where no rows are to be made, @param kernel null where none of the near field are
  RowMaker(std::shared_ptr<const Tissue> tissue, std::shared_ptr<ComplianceStore> store,
           std::shared_ptr<MeshKernel> kernel, const Locator& locator);

  /// Takes note of store and near field as they are, which nobody may be changing: rows may have come by other ways.
  /// @param parcel wherever it is; what an earlier worker made for it and the step has not taken is lost
  /// @param with_worker whether the step has given the parcel to the worker
  void begin(const Settings& settings, SupplyParcel& parcel, bool with_worker);

  /// Takes in the step's answers, and puts rows for as many nodes into the parcel as are wanted and have room, those
  /// first that the needle reaches first. May throw when memory or threads run out; the parcel must be cleared then.
  /// @param most nodes solved for at once
  /// @param on_own_thread whether steps go on meanwhile, to which the other processor cores are left
  /// @return not Work::failed
  [[nodiscard]] Work make(SupplyParcel& parcel, std::size_t most, bool on_own_thread);

 private:
  void note_answers(SupplyParcel& parcel);
  void ask_for_slots(SupplyParcel& parcel, std::size_t count, std::span<const Index> wanted) const;
  [[nodiscard]] bool needs_row(Index node) const {
    return store_ != nullptr && !ledger_.has_row(node) && !tissue_->is_fixed(node);
  }
  [[nodiscard]] bool needs_kernel_row(Index node) const { return kernel_ != nullptr && !ledger_.has_kernel_row(node); }

  std::shared_ptr<const Tissue> tissue_;
  std::shared_ptr<ComplianceStore> store_;  ///< looked at in begin() only
  std::shared_ptr<MeshKernel> kernel_;      ///< which rows it has is looked at in begin() only
  Settings settings_;
  NodesAhead ahead_;
  RowLedger ledger_;
};

}  // namespace stylet
