// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/supply/row_maker.hpp"

#include "stylet/core/parallel.hpp"

#include <algorithm>

namespace stylet {

RowMaker::RowMaker(std::shared_ptr<const Tissue> tissue, std::shared_ptr<ComplianceStore> store,
                   std::shared_ptr<MeshKernel> kernel, const Locator& locator)
    : tissue_(std::move(tissue)),
      store_(std::move(store)),
      kernel_(std::move(kernel)),
      ahead_(tissue_, locator),
      ledger_(tissue_->displacement_nodes()) {}

void RowMaker::begin(const Settings& settings, SupplyParcel& parcel, bool with_worker) {
  settings_ = settings;
  if (with_worker) {
    note_answers(parcel);
  } else if (!parcel.rows.empty()) {
    parcel.rows.clear();
    parcel.kernel_rows.clear();
  }
  if (kernel_) ledger_.read(*kernel_);
  if (store_) ledger_.read(*store_, settings_.spare_nodes);
}

void RowMaker::note_answers(SupplyParcel& parcel) {
  for (const SupplyParcel::Leaver& leaver : parcel.leavers) ledger_.note(leaver);
  parcel.clear();
}

/// Requests the slots whose nodes are furthest from the tip.
void RowMaker::ask_for_slots(SupplyParcel& parcel, std::size_t count, std::span<const Index> wanted) const {
  const NodeSlots& slots = ledger_.slots();
  std::vector<std::pair<double, Index>> far;  // −(distance from the tip)² [mm²], slot
  for (const Index slot : ledger_.dispensable(wanted))
    far.emplace_back(-(tissue_->node_position(slots.node(slot)) - parcel.needle.tip).squaredNorm(), slot);
  count = std::min(count, far.size());
  std::partial_sort(far.begin(), far.begin() + static_cast<std::ptrdiff_t>(count), far.end());
  for (std::size_t k = 0; k < count; ++k)
    parcel.leavers.push_back({slots.node(far[k].second), far[k].second, false, {}, nullptr});
}

RowMaker::Work RowMaker::make(SupplyParcel& parcel, std::size_t most, bool on_own_thread) {
  note_answers(parcel);
  ledger_.begin_round();
  const std::vector<Index>& wanted = ahead_.find(parcel.needle, settings_.radius_mm, settings_.ahead_mm);
  std::vector<Index> rows;
  std::vector<Index> kernel_rows;
  std::size_t without_room = 0;
  for (std::size_t k = 0; k < wanted.size() && std::max(rows.size(), kernel_rows.size()) < most; ++k) {
    const Index node = wanted[k];
    if (needs_row(node)) {
      if (rows.size() == ledger_.free_slots()) {
        if (++without_room == most) break;
        continue;
      }
      rows.push_back(node);
    }
    if (needs_kernel_row(node)) kernel_rows.push_back(node);
  }
  if (without_room > 0) ask_for_slots(parcel, 2 * most, wanted);
  if (rows.empty() && kernel_rows.empty()) {
    if (!parcel.leavers.empty()) return Work::waiting;
    return without_room > 0 ? Work::full : Work::idle;
  }

  if (!rows.empty()) parcel.rows = solve_rows(*tissue_, ledger_.slots(), rows, ledger_.next_slots(rows.size()));
  parcel.kernel_rows.resize(kernel_rows.size());
  const auto make = [&](std::size_t k) { parcel.kernel_rows[k] = {kernel_rows[k], kernel_->make_row(kernel_rows[k])}; };
  if (on_own_thread) {
    for (std::size_t k = 0; k < kernel_rows.size(); ++k) make(k);
  } else {
    for_each_in_parallel(kernel_rows.size(), make);
  }
  ledger_.record(parcel.rows, kernel_rows);
  return Work::done;
}

}  // namespace stylet
