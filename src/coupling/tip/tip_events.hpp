// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/event.hpp"

#include <array>
#include <limits>
#include <span>

namespace stylet {

/// The events of a step, in their order; those for which there is no room are dropped. Nothing allocates.
class TipEvents {
 public:
  static constexpr std::size_t kMost = 16;

  /// @param force_N axial force of the hand at the event; NaN where it has no meaning
  void add(EventKind kind, int region, double force_N = std::numeric_limits<double>::quiet_NaN()) {
    if (count_ < kMost) event_[count_++] = {kind, region, force_N, passed_};
  }
  /// Says where in the step the next sub-step ends. @param passed 0 … 1
  void begin_sub_step(double passed) { passed_ = passed; }
  void forget() { count_ = 0; }
  [[nodiscard]] std::span<const InsertionEvent> all() const { return {event_.data(), count_}; }

 private:
  std::array<InsertionEvent, kMost> event_;
  std::size_t count_ = 0;
  double passed_ = 1.0;
};

}  // namespace stylet
