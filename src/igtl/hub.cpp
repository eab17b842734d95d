// SPDX-License-Identifier: GPL-3.0-or-later
#include "hub.hpp"

#include "stylet/core/printable.hpp"
#include "stylet/core/secret.hpp"

#include <fmt/format.h>

namespace stylet::igtl {

Hub::Hub(const LinkSettings& settings)
    : settings_(settings), input_(cut_name(settings.input)), probe_(cut_name(settings.probe_input)) {}

void Hub::add(Connection::Socket socket, std::function<void()> on_end, Trust trust) {
  const ConnectionId id = ++last_id_;
  auto connection =
      std::make_shared<Connection>(std::move(socket),
                                   Connection::Events{
                                       .message = [this, id](const Incoming& m) { hear(id, m); },
                                       .closed =
                                           [this, id, on_end = std::move(on_end)](const std::optional<Error>& garbage) {
                                             ended(id, garbage);
                                             if (on_end) on_end();
                                           },
                                   },
                                   settings_.checksums);
  connections_.emplace(id, connection);
  if (trust == Trust::stranger) {
    strangers_.emplace(id, Connection::Clock::now());
  } else {
    welcome(*connection);
  }
  connection->start();
}

void Hub::welcome(Connection& connection) {
  ++counted_.connected;
  for (std::size_t k = 0; k < Connection::kContents; ++k)
    if (greeting_[k]) offer(connection, static_cast<Connection::Content>(k), greeting_[k]);
}

std::string Hub::why_not(Trust trust) const {
  if (trust == Trust::stranger && token_.empty())
    return "a connection of another user or from another machine was refused, since there is no token";
  if (trust == Trust::stranger && strangers_.size() >= kMostStrangers)
    return "too many connections have not given the token, so another one was refused";
  if (known() >= static_cast<std::size_t>(settings_.max_connections))
    return "there are max_connections connections already, so another one was refused";
  return {};
}

/// Only the token counts; programs may send other things before it.
void Hub::hear_stranger(ConnectionId from, const Incoming& message) {
  if (message.kind != Incoming::Kind::token || !is_same_secret(message.text, token_)) return;
  const auto connection = connections_.find(from);
  if (connection == connections_.end() || known() >= static_cast<std::size_t>(settings_.max_connections)) return;
  strangers_.erase(from);
  welcome(*connection->second);
}

/// Poses of the probe go to the probe alone; the state of a sender concerns both.
void Hub::hear(ConnectionId from, const Incoming& message) {
  if (strangers_.contains(from)) return hear_stranger(from, message);
  const auto now = PoseInput::Clock::now();
  const bool of_probe = message.kind == Incoming::Kind::pose && message.name == probe_.name();
  if (of_probe || message.kind == Incoming::Kind::status) probe_.hear(from, message, now);
  if (!of_probe) input_.hear(from, message, now);
  const bool used = of_probe || (message.kind == Incoming::Kind::pose && message.name == input_.name());
  const bool named = message.name == input_.name() || message.name == probe_.name();
  const bool has_pose = named || message.type == "TRANSFORM" || message.type == "POSITION" || message.type == "TDATA" ||
                        message.type == "QTDATA";
  if (!used && has_pose && message.kind != Incoming::Kind::status)
    counted_.unused = fmt::format("{} '{}'", message.type, printable_name(message.name));
}

void Hub::turn_away(const std::string& why) {
  ++counted_.turned_away;
  counted_.problem = why;
}

void Hub::ended(ConnectionId id, const std::optional<Error>& garbage) {
  input_.closed(id);
  probe_.closed(id);
  connections_.erase(id);
  strangers_.erase(id);
  if (!garbage) return;
  ++counted_.garbage;
  counted_.problem = fmt::format("a connection was closed because it sent {}. {}", garbage->what, garbage->cure);
}

void Hub::offer(Connection& to, Connection::Content content, const Connection::Shared& bytes) {
  ++counted_.sent;
  if (!to.offer(content, bytes)) ++counted_.dropped;
}

void Hub::send(Connection::Content content, const Connection::Shared& bytes) {
  for (const auto& [id, connection] : connections_)
    if (!strangers_.contains(id)) offer(*connection, content, bytes);
}

void Hub::give_up(Connection::Clock::time_point now) {
  const std::chrono::duration<double> limit(settings_.give_up_s);
  std::vector<std::shared_ptr<Connection>> stuck;
  for (const auto& [id, connection] : connections_) {
    Connection::Clock::time_point since;
    if (connection->sending_since(since) && now - since > limit) stuck.push_back(connection);
  }
  std::vector<std::shared_ptr<Connection>> silent;
  for (const auto& [id, since] : strangers_)
    if (now - since > kTokenTime) silent.push_back(connections_.at(id));
  for (const auto& connection : silent) {
    turn_away("a connection of another user or from another machine was closed, since it has not given the token");
    connection->close();
  }
  for (const auto& connection : stuck) {
    ++counted_.given_up;
    counted_.problem = "a connection accepted no data for longer than give_up_s and was closed";
    connection->close();
  }
}

void Hub::close() {
  while (!connections_.empty()) std::shared_ptr<Connection>(connections_.begin()->second)->close();
}

void Hub::set_port(int port) {
  counted_.port = port;
  show_state();
}

void Hub::show_state() {
  const PoseInput::Counts& c = input_.counts();
  counted_.connections = static_cast<int>(known());
  counted_.tracked = input_.tracked();
  counted_.poses = c.poses;
  counted_.unusable = c.unusable;
  counted_.of_others = c.of_others;
  counted_.other_messages = c.other_messages;
  counted_.probe_poses = probe_.counts().poses;
  const std::scoped_lock lock(mutex_);
  shown_ = counted_;
}

LinkState Hub::state() const {
  const std::scoped_lock lock(mutex_);
  return shown_;
}

}  // namespace stylet::igtl
