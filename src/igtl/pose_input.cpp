// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose_input.hpp"

namespace stylet::igtl {

void PoseInput::hear(ConnectionId from, const Incoming& message, Clock::time_point now) {
  if (message.kind == Incoming::Kind::status) {
    hear_status(from, message.name, message.code);
  } else if (message.kind == Incoming::Kind::pose && message.name == name_) {
    hear_pose(from, message.matrix, now);
  } else {
    ++counts_.other_messages;
  }
}

void PoseInput::hear_pose(ConnectionId from, const RasMatrix& matrix, Clock::time_point now) {
  if (owner_ != from && owner_ != 0 && now - heard_ < kSilent) {
    ++counts_.of_others;
    return;
  }
  owner_ = from;
  heard_ = now;
  const auto pose = pose_of(matrix);
  if (pose && !complaints_.contains(from)) {
    ++counts_.poses;
    write({true, plain(*pose)});
  } else {
    ++counts_.unusable;
    write({});
  }
}

void PoseInput::hear_status(ConnectionId from, const std::string& name, std::uint16_t code) {
  constexpr std::uint16_t ok = 1;
  if (code == ok) {
    const auto at = complaints_.find(from);
    if (at == complaints_.end()) return;
    at->second.erase(name);
    if (at->second.empty()) complaints_.erase(at);
    return;
  }
  auto& names = complaints_[from];
  if (names.size() < kComplaints) names.insert(name);
  if (from == owner_) write({});
}

void PoseInput::closed(ConnectionId connection) {
  complaints_.erase(connection);
  if (connection != owner_) return;
  owner_ = 0;
  write({});
}

void PoseInput::write(const TrackedPose& pose) {
  tracked_ = pose.valid;
  if (channel_) channel_->write(pose);
}

}  // namespace stylet::igtl
