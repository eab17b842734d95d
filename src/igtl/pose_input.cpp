// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose_input.hpp"

namespace stylet::igtl {

PoseInput::Heard PoseInput::hear_pose(ConnectionId from, const RasMatrix& matrix, Clock::time_point now) {
  if (owner_ != from && owner_ != 0 && now - heard_ < kSilent) {
    ++counts_.of_others;
    return Heard::of_other;
  }
  owner_ = from;
  heard_ = now;
  const auto pose = pose_of(matrix);
  if (pose && !complaints_.contains(from)) {
    ++counts_.poses;
    write({true, plain(*pose)});
    return Heard::used;
  }
  ++counts_.unusable;
  write({});
  return pose ? Heard::sender_not_ok : Heard::no_rigid_motion;
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
