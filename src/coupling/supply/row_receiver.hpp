// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/supply/parcel.hpp"

namespace stylet {

/// The step's side of a ComplianceSupply: brings what a parcel holds into the store and the near field.
class RowReceiver {
 public:
  /// @param nodes number of displacement nodes
  /// @param store null where parcels have no rows, @param kernel null where they have no rows of the near field
  RowReceiver(Index nodes, std::shared_ptr<ComplianceStore> store, std::shared_ptr<MeshKernel> kernel);

  /// Gives up the slots that the parcel asks for, unless the user's points need their nodes, and takes over the rows
  /// that it brings. What was there before goes into the parcel. Wait-free; does not allocate, free or solve.
  void receive(SupplyParcel& parcel, const ContactCompliance& user) noexcept;

 private:
  std::shared_ptr<ComplianceStore> store_;
  std::shared_ptr<MeshKernel> kernel_;
  std::vector<unsigned> stamps_;  ///< (displacement nodes) equal to stamp_ where the user's points need the node
  unsigned stamp_ = 0;
};

}  // namespace stylet
