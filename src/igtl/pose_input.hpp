// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "message_reader.hpp"
#include "tracked_device.hpp"

#include <chrono>
#include <map>
#include <set>

namespace stylet::igtl {

using ConnectionId = std::uint64_t;  ///< 0: none

/// Decides whose pose the handle is, and whether it can be used. One connection at a time has the handle: whoever sends
/// its pose first, until it leaves or has been silent for a second; two hands on one needle would tear it to and fro.
/// A pose is invalid when it is no rigid motion, and while the last STATUS under any name of its connection is not OK.
class PoseInput {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kSilent{1};
  static constexpr std::size_t kComplaints = 16;  ///< names with a bad STATUS that are remembered, for each connection

  explicit PoseInput(std::string name) : name_(std::move(name)) {}

  /// Where poses go from now on. It hears of the present state only by the next message.
  void feed(std::shared_ptr<PoseChannel> channel) { channel_ = std::move(channel); }

  void hear(ConnectionId from, const Incoming& message, Clock::time_point now);
  void closed(ConnectionId connection);

  struct Counts {
    std::int64_t poses = 0;           ///< usable
    std::int64_t unusable = 0;        ///< no rigid motion, or its sender was not OK
    std::int64_t of_others = 0;       ///< from a connection that does not have the handle
    std::int64_t other_messages = 0;  ///< other types and names
  };
  [[nodiscard]] const Counts& counts() const { return counts_; }
  [[nodiscard]] bool tracked() const { return tracked_; }

 private:
  void hear_pose(ConnectionId from, const RasMatrix& matrix, Clock::time_point now);
  void hear_status(ConnectionId from, const std::string& name, std::uint16_t code);
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
