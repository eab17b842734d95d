// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/supply/row_receiver.hpp"

namespace stylet {

RowReceiver::RowReceiver(Index nodes, std::shared_ptr<ComplianceStore> store, std::shared_ptr<MeshKernel> kernel)
    : store_(std::move(store)), kernel_(std::move(kernel)), stamps_(static_cast<std::size_t>(nodes), 0) {}

void RowReceiver::receive(SupplyParcel& parcel, const ContactCompliance& user) noexcept {
  if (!parcel.leavers.empty()) {
    user.mark_nodes(stamps_, ++stamp_);
    for (SupplyParcel::Leaver& leaver : parcel.leavers) {
      leaver.left = stamps_[static_cast<std::size_t>(leaver.node)] != stamp_;
      if (!leaver.left) continue;
      store_->release(leaver.slot, leaver.row);
      if (kernel_) kernel_->exchange(leaver.node, leaver.kernel);
    }
  }
  for (ComplianceRow& row : parcel.rows) store_->take(row);
  for (SupplyParcel::KernelRow& fresh : parcel.kernel_rows) kernel_->exchange(fresh.node, fresh.row);
}

}  // namespace stylet
