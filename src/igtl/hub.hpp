// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "connection.hpp"
#include "drop_log.hpp"
#include "pose_input.hpp"
#include "stylet/igtl/link.hpp"

#include <map>
#include <mutex>

namespace stylet::igtl {

/// All connections of a link and their counters. All functions except state(), news() and take_commands() must be
/// called in the link's thread.
class Hub {
 public:
  static constexpr std::chrono::seconds kTokenTime{5};
  static constexpr std::size_t kMostStrangers = 4;

  explicit Hub(const LinkSettings& settings);

  /// Whether a connection needs the token: processes of this user on this machine do not.
  enum class Trust { known, stranger };
  /// Takes a connection over. Nothing is sent to a stranger, and nothing that it sends is used, until it has given the
  /// token; it has kTokenTime for that.
  /// @param ended called once when the connection has ended; may be empty
  void add(Connection::Socket socket, std::function<void()> ended, Trust trust = Trust::known);
  /// Why such a connection cannot be taken over, in words; empty if it can.
  [[nodiscard]] std::string why_not(Trust trust) const;
  /// Sets the token that strangers have to give; while it is empty no stranger is taken over.
  void accept_token(std::string token) { token_ = std::move(token); }
  [[nodiscard]] bool empty() const { return connections_.empty(); }
  void turn_away(const std::string& why);

  void send(Connection::Content content, const Connection::Shared& bytes);
  /// Sets the message that every new connection is sent first, for one kind of content.
  void greet_with(Connection::Content content, Connection::Shared bytes) { greeting_.at(content) = std::move(bytes); }
  /// Closes the connections that have accepted no data for longer than give_up_s, and strangers without a token.
  void give_up(Connection::Clock::time_point now);

  /// Sets the channel that receives the handle's poses.
  void feed(std::shared_ptr<PoseChannel> channel) { input_.feed(std::move(channel)); }
  /// Sets the channel that receives the probe's poses.
  void feed_probe(std::shared_ptr<PoseChannel> channel) { probe_.feed(std::move(channel)); }
  /// Sends the answer to a command. @param refused empty: it has been carried out
  void answer(const GivenCommand& command, const std::string& refused);
  /// Closes all connections.
  void close();

  void set_port(int port);
  void set_problem(const std::string& problem) { counted_.problem = problem; }
  /// Copies the current counters to the state that state() returns.
  void show_state();
  [[nodiscard]] LinkState state() const;
  std::vector<Dropped> news() { return drops_.news(DropLog::Clock::now()); }
  std::vector<GivenCommand> take_commands();

 private:
  void offer(Connection& to, Connection::Content content, const Connection::Shared& bytes);
  void hear(ConnectionId from, const Incoming& message);
  void hear_stranger(ConnectionId from, const Incoming& message);
  void hear_poses(ConnectionId from, const Incoming& message);
  std::optional<Refusal> hear_pose(ConnectionId from, PoseInput& input, const ToolPose& pose);
  void hear_command(ConnectionId from, const Incoming& message);
  void refuse(ConnectionId from, const Incoming& message, const Refusal& refusal);
  void leave_out(ConnectionId from, const Incoming& message, const std::string& why, const std::string& cure);
  void drop(const std::string& kind, std::string what, std::string cure, bool is_told_once = false);
  void welcome(Connection& connection);
  void ended(ConnectionId id, const std::optional<Refusal>& why);
  [[nodiscard]] std::size_t known() const { return connections_.size() - strangers_.size(); }

  const LinkSettings& settings_;
  PoseInput input_;
  PoseInput probe_;
  std::map<ConnectionId, std::shared_ptr<Connection>> connections_;
  std::map<ConnectionId, Connection::Clock::time_point> strangers_;  ///< since when they are connected
  std::string token_;
  std::array<Connection::Shared, Connection::kContents> greeting_;
  ConnectionId last_id_ = 0;
  LinkState counted_;
  DropLog drops_;
  mutable std::mutex mutex_;
  LinkState shown_;                     ///< guarded by the mutex
  std::vector<GivenCommand> commands_;  ///< guarded by the mutex: given, and not taken
};

}  // namespace stylet::igtl
