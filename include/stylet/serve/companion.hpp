// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/device.hpp"
#include "stylet/realtime/snapshot.hpp"
#include "stylet/serve/image_picture.hpp"
#include "stylet/serve/picture.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace stylet::serve {

/// A command in words, or in the JSON of docs/live_protocol.md.
struct GivenCommand {
  std::string text;
  /// Tells the program that has given it why it is refused; empty: it has been carried out. Is to be called once.
  std::function<void(const std::optional<Notice>& refused)> answer;
};

/// Another program that is connected besides the pages, for example over OpenIGTLink: it is shown a live session and
/// may move the needle and the probe. It stays connected when a reset, another hole or another case starts a new
/// real-time loop. The session's thread makes all calls; each must return at once.
class Companion {
 public:
  virtual ~Companion() = default;

  /// Its name on the page.
  [[nodiscard]] virtual std::string name() const = 0;
  /// A device that moves the needle in the next loop; devices of earlier loops give no more poses. Null: the pages move
  /// the needle.
  [[nodiscard]] virtual std::unique_ptr<Device> device() = 0;
  /// Why the device gives no usable pose, in words.
  [[nodiscard]] virtual std::string why_no_pose() const = 0;
  /// The words about messages that it has not used, which are due now on the terminal and on the pages, in
  /// sentences without their full stops.
  virtual std::vector<Notice> news() { return {}; }
  /// How many messages and connections it has not used.
  [[nodiscard]] virtual std::int64_t not_used() const { return 0; }
  /// The commands that it has been given since the last call.
  virtual std::vector<GivenCommand> take_commands() { return {}; }

  /// Receives the open case, undeformed.
  virtual void show(const Scene& scene) = 0;
  /// Receives the state of the loop. Called with every picture for the pages, also while paused, and never while there
  /// is no loop.
  virtual void show(const Snapshot& snapshot, const DeviceSnapshot& device) = 0;
  /// Receives the displacement of the scene's points.
  /// @param displacement [mm] (3 × n) LPS
  virtual void show(const Eigen::Ref<const Eigen::Matrix3Xf>& displacement) = 0;

  /// Whether ultrasound and X-ray pictures are to be made for it now, also while no page looks at one.
  [[nodiscard]] virtual bool wants_images() const { return false; }
  /// Receives a picture, LiveImage::in_patient included.
  virtual void show(const LiveImage& /*image*/) {}
  /// The pose (LPS, local axes as ProbePlace::axes) to which it moves the probe; empty: the pages move the probe.
  [[nodiscard]] virtual std::optional<Pose> probe_pose() { return {}; }
};

}  // namespace stylet::serve
