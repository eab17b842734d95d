// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "ras.hpp"
#include "tracked_device.hpp"

#include <chrono>
#include <cstdint>
#include <map>
#include <set>
#include <string>

namespace stylet::igtl {

using ConnectionId = std::uint64_t;  ///< 0: none

/// Decides which connection moves the handle and whether its poses are usable. One connection at a time has the handle:
/// the first that sends its pose, until it ends or has sent none for a second. Otherwise two senders would move the
/// needle back and forth. A pose is invalid if it is no rigid motion, or while the last STATUS of any name from its
/// connection is not OK.
class PoseInput {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kSilent{1};
  static constexpr std::size_t kComplaints = 16;  ///< most names with a bad STATUS that are stored per connection

  explicit PoseInput(std::string name) : name_(std::move(name)) {}

  [[nodiscard]] const std::string& name() const { return name_; }

  /// Sets the channel that receives the poses. It gets nothing until the next message.
  void feed(std::shared_ptr<PoseChannel> channel) { channel_ = std::move(channel); }

  enum class Heard {
    used,
    no_rigid_motion,
    sender_not_ok,  ///< the last STATUS of its sender, under some name, is not OK
    of_other        ///< another connection has the handle
  };
  Heard hear_pose(ConnectionId from, const RasMatrix& matrix, Clock::time_point now);
  void hear_status(ConnectionId from, const std::string& name, std::uint16_t code);
  void closed(ConnectionId connection);

  struct Counts {
    std::int64_t poses = 0;      ///< usable poses
    std::int64_t unusable = 0;   ///< poses that were no rigid motion, or whose sender was not OK
    std::int64_t of_others = 0;  ///< poses from a connection that does not have the handle
  };
  [[nodiscard]] const Counts& counts() const { return counts_; }
  [[nodiscard]] bool tracked() const { return tracked_; }

 private:
  void write(const TrackedPose& pose);

  std::string name_;
  std::shared_ptr<PoseChannel> channel_;
  ConnectionId owner_ = 0;
  Clock::time_point heard_;
  bool tracked_ = false;  ///< the last pose written was valid
  std::map<ConnectionId, std::set<std::string>> complaints_;
  Counts counts_;
};

}  // namespace stylet::igtl
