// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "connection.hpp"
#include "pose_input.hpp"
#include "stylet/igtl/link.hpp"

#include <map>
#include <mutex>

namespace stylet::igtl {

/// All connections of a link and their counters. All functions except state() must be called in the link's thread.
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
  /// Closes all connections.
  void close();

  void set_port(int port);
  void set_problem(const std::string& problem) { counted_.problem = problem; }
  /// Copies the current counters to the state that state() returns.
  void show_state();
  [[nodiscard]] LinkState state() const;

 private:
  void offer(Connection& to, Connection::Content content, const Connection::Shared& bytes);
  void hear(ConnectionId from, const Incoming& message);
  void hear_stranger(ConnectionId from, const Incoming& message);
  void welcome(Connection& connection);
  void ended(ConnectionId id, const std::optional<Error>& garbage);
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
  mutable std::mutex mutex_;
  LinkState shown_;  ///< guarded by the mutex
};

}  // namespace stylet::igtl
