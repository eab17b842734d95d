// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/device.hpp"
#include "stylet/realtime/snapshot.hpp"
#include "stylet/serve/picture.hpp"

#include <memory>
#include <string>

namespace stylet::serve {

/// Another program beside the pages, over a link of its own: it sees a live session and may have the needle. It stays
/// while loops come and go with resets, holes and cases. All calls from the session's thread; they return at once.
class Companion {
 public:
  virtual ~Companion() = default;

  /// What viewers call it.
  [[nodiscard]] virtual std::string name() const = 0;
  /// Moves the needle in the next loop, and not any more in those before; null: the pages move it.
  [[nodiscard]] virtual std::unique_ptr<Device> device() = 0;
  /// Why that device says no pose that can be used, in words.
  [[nodiscard]] virtual std::string why_no_pose() const = 0;

  /// The case that is open, undeformed.
  virtual void show(const Scene& scene) = 0;
  /// What is to be seen now: with every picture for the pages, also while paused; never while there is no loop.
  virtual void show(const Snapshot& snapshot, const DeviceSnapshot& device) = 0;
  /// @param displacement [mm] (3 × n) LPS of the scene's nodes
  virtual void show(const Eigen::Ref<const Eigen::Matrix3Xf>& displacement) = 0;
};

}  // namespace stylet::serve
