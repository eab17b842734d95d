// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/supply/parcel.hpp"

namespace stylet {

/// The step's side of a ComplianceSupply: puts the contents of a parcel into the store and the mesh kernel.
class RowReceiver {
 public:
  /// @param nodes number of displacement nodes
  /// @param store null where parcels have no rows for it @param kernel null where parcels have no rows for it
  RowReceiver(Index nodes, std::shared_ptr<ComplianceStore> store, std::shared_ptr<MeshKernel> kernel);

  /// Gives up the slots that the parcel requests, unless the user's points need their nodes, and takes over the
  /// parcel's rows. Previous rows go into the parcel. Wait-free; does not allocate, free or solve.
  void receive(SupplyParcel& parcel, const ContactCompliance& user) noexcept;

 private:
  std::shared_ptr<ComplianceStore> store_;
  std::shared_ptr<MeshKernel> kernel_;
  std::vector<unsigned> stamps_;  ///< (displacement nodes) equal to stamp_ where a point of the user needs the node
  unsigned stamp_ = 0;
};

}  // namespace stylet
