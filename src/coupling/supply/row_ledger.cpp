// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/supply/row_ledger.hpp"

#include <algorithm>

namespace stylet {
namespace {

/// Number of rounds for which a refused slot is not requested again. Raised, parcels carry fewer requests in vain, and
/// a slot that contacts have left is found later.
constexpr unsigned kRefusedRounds = 100;

}  // namespace

RowLedger::RowLedger(Index nodes)
    : slots_(nodes), has_kernel_(static_cast<std::size_t>(nodes), 0), refused_until_(has_kernel_.size(), 0) {}

void RowLedger::find_free(const NodeSlots& slots, std::size_t most) {
  free_.clear();
  for (Index slot = 0; slot < slots.count() && free_.size() < most; ++slot) {
    if (slots.node(slot) < 0) free_.push_back(slot);
  }
}

void RowLedger::read(ComplianceStore& store, Index spare_nodes) {
  std::erase_if(own_, [&](Index slot) { return store.slots().node(slot) < 0; });
  const auto most = static_cast<std::size_t>(spare_nodes);
  const std::size_t room = most - std::min(own_.size(), most);
  find_free(store.slots(), room);
  if (free_.size() < room) {
    store.reserve(static_cast<Index>(room - free_.size()));
    find_free(store.slots(), room);
  }
  slots_ = store.slots();
}

void RowLedger::read(const MeshKernel& kernel) {
  for (std::size_t node = 0; node < has_kernel_.size(); ++node)
    has_kernel_[node] = kernel.has(static_cast<Index>(node)) ? 1 : 0;
}

void RowLedger::note(const SupplyParcel::Leaver& answer) {
  const auto node = static_cast<std::size_t>(answer.node);
  if (!answer.left) {
    refused_until_[node] = round_ + kRefusedRounds;
    return;
  }
  slots_.vacate(answer.slot);
  has_kernel_[node] = 0;
  free_.push_back(answer.slot);
  own_.erase(std::find(own_.begin(), own_.end(), answer.slot));
}

std::vector<Index> RowLedger::dispensable(std::span<const Index> wanted) const {
  std::vector<Index> result;
  for (const Index slot : own_) {
    const Index node = slots_.node(slot);
    if (refused_until_[static_cast<std::size_t>(node)] > round_) continue;
    if (std::find(wanted.begin(), wanted.end(), node) == wanted.end()) result.push_back(slot);
  }
  return result;
}

void RowLedger::record(std::span<const ComplianceRow> rows, std::span<const Index> kernel_nodes) {
  own_.reserve(own_.size() + rows.size());  // nothing below can fail
  for (const ComplianceRow& row : rows) {
    slots_.occupy(row.slot, row.node);
    own_.push_back(row.slot);
  }
  free_.resize(free_.size() - rows.size());
  for (const Index node : kernel_nodes) has_kernel_[static_cast<std::size_t>(node)] = 1;
}

}  // namespace stylet
