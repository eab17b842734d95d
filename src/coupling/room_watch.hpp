// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/tip/tip_path.hpp"
#include "stylet/coupling/insertion.hpp"

#include <limits>

namespace stylet {

/// Records how much of each capacity was in use, and where the compliance around the tip is complete.
class RoomWatch {
 public:
  RoomWatch(const CouplingSettings& settings, const ComplianceStore& store)
      : store_(store), nodes_at_start_(store.stored_nodes()) {
    uses_.contacts.room = settings.capacity;
    uses_.spare_nodes.room = settings.spare_nodes;
    uses_.tracks.room = Tracks::kRoom;
    uses_.events.room = static_cast<int>(TipEvents::kMost);
  }
  void note(std::size_t contacts, std::size_t tracks) {
    uses_.contacts.note(static_cast<int>(contacts));
    uses_.spare_nodes.note(static_cast<int>(store_.stored_nodes() - nodes_at_start_));
    uses_.tracks.note(static_cast<int>(tracks));
  }
  void note_events(std::size_t events) { uses_.events.note(static_cast<int>(events)); }
  [[nodiscard]] const CapacityUses& uses() const { return uses_; }

  /// Records that the compliance around the tip is complete.
  void complete_at(const Vec3& tip) {
    complete_at_ = tip;
    arrived_ = store_.arrived();
  }
  /// Whether the compliance was complete around a place nearer than `way_mm` to this one, and the store has not changed
  /// since.
  [[nodiscard]] bool is_complete_near(const Vec3& tip, double way_mm) const {
    return store_.arrived() == arrived_ && (tip - complete_at_).norm() < way_mm;
  }
  void forget() { complete_at_.setConstant(std::numeric_limits<double>::infinity()); }

 private:
  const ComplianceStore& store_;
  Index nodes_at_start_;
  CapacityUses uses_;
  Vec3 complete_at_ = Vec3::Constant(std::numeric_limits<double>::infinity());
  std::uint64_t arrived_ = 0;
};

}  // namespace stylet
