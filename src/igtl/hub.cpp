// SPDX-License-Identifier: GPL-3.0-or-later
#include "hub.hpp"

#include "stylet/core/printable.hpp"
#include "stylet/core/secret.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stylet::igtl {

namespace {

constexpr std::size_t kMostCommands = 16;
constexpr std::size_t kLongestCommand = 1000;  // [bytes]
constexpr std::size_t kLongestAnswer = 2000;   // [bytes]
// The beginnings of answers. A text that begins so is no command, so that two programs do not answer the answers of
// one another without end.
const std::string kDone = "done: ";
const std::string kRefused = "refused: ";
constexpr const char* kPoseTypes = "TRANSFORM, POSITION with a quaternion, TDATA or QTDATA";

/// Names of tools for people; at most some of them.
std::string names_of(const std::vector<ToolPose>& tools) {
  constexpr std::size_t most = 6;
  std::vector<std::string> names;
  for (const ToolPose& tool : tools)
    if (names.size() < most) names.push_back("'" + printable_name(tool.name) + "'");
  if (tools.size() > most) names.emplace_back("…");
  return fmt::format("{}", fmt::join(names, ", "));
}

Refusal refusal_of(PoseInput::Heard heard) {
  if (heard == PoseInput::Heard::no_rigid_motion)
    return {"rigid motion",
            "its matrix is no rigid motion: it has to be finite, with axes of length 1 at right angles, not mirrored",
            "Let the other program send rotation and translation only"};
  if (heard == PoseInput::Heard::sender_not_ok)
    return {"status", "its sender has sent a STATUS that is not OK",
            "Let the sender send STATUS OK under the same name"};
  return {"other sender", "another connection sends this pose already",
          "Let one program send it, or wait a second after the other has stopped"};
}

}  // namespace

Hub::Hub(const LinkSettings& settings)
    : settings_(settings), input_(cut_name(settings.input)), probe_(cut_name(settings.probe_input)) {}

void Hub::add(Connection::Socket socket, std::function<void()> on_end, Trust trust) {
  const ConnectionId id = ++last_id_;
  auto connection =
      std::make_shared<Connection>(std::move(socket),
                                   Connection::Events{
                                       .message = [this, id](const Incoming& m) { hear(id, m); },
                                       .closed =
                                           [this, id, on_end = std::move(on_end)](const std::optional<Refusal>& why) {
                                             ended(id, why);
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
  if (message.kind != Incoming::Kind::text || message.name != kTokenName || !is_same_secret(message.text, token_))
    return;
  const auto connection = connections_.find(from);
  if (connection == connections_.end() || known() >= static_cast<std::size_t>(settings_.max_connections)) return;
  strangers_.erase(from);
  welcome(*connection->second);
}

void Hub::hear(ConnectionId from, const Incoming& message) {
  if (strangers_.contains(from)) return hear_stranger(from, message);
  switch (message.kind) {
    case Incoming::Kind::pose:
      return hear_poses(from, message);
    case Incoming::Kind::status:  // it concerns both poses of its sender
      input_.hear_status(from, message.name, message.code);
      return probe_.hear_status(from, message.name, message.code);
    case Incoming::Kind::text:
      return hear_command(from, message);
    case Incoming::Kind::refused:
      return refuse(from, message, message.refusal);
    case Incoming::Kind::other:
      return leave_out(from, message, "its type is not used",
                       fmt::format("Send poses as {}, and commands as STRING or COMMAND", kPoseTypes));
  }
}

/// The name of a message with one tool stands for the name of the tool too. A message is counted once, whatever is
/// wrong with several of its tools.
void Hub::hear_poses(ConnectionId from, const Incoming& message) {
  bool is_wanted = false;
  std::optional<Refusal> refusal;
  for (const ToolPose& pose : message.poses) {
    for (PoseInput* input : {&input_, &probe_}) {
      const bool is_only = message.poses.size() == 1 && message.name == input->name();
      if (pose.name != input->name() && !is_only) continue;
      is_wanted = true;
      if (auto why = hear_pose(from, *input, pose); why && !refusal) refusal = std::move(why);
    }
  }
  if (refusal) return refuse(from, message, *refusal);
  if (is_wanted) return;
  const bool has_tools = message.type == "TDATA" || message.type == "QTDATA";
  leave_out(from, message,
            has_tools && !message.poses.empty()
                ? fmt::format("no pose with this name or with the name of its tools ({}) is asked for",
                              names_of(message.poses))
                : "no pose with this name is asked for",
            fmt::format("Name it {} for the needle, or {} for the probe", input_.name(), probe_.name()));
}

std::optional<Refusal> Hub::hear_pose(ConnectionId from, PoseInput& input, const ToolPose& pose) {
  if (!pose.matrix)
    return Refusal{"orientation", "it has no orientation: there is no quaternion, or its length is not 1",
                   fmt::format("Send the pose as {}", kPoseTypes)};
  const PoseInput::Heard heard = input.hear_pose(from, *pose.matrix, PoseInput::Clock::now());
  if (heard == PoseInput::Heard::used) return {};
  return refusal_of(heard);
}

/// A COMMAND without text is its name. Programs that need no token may give it nevertheless.
void Hub::hear_command(ConnectionId from, const Incoming& message) {
  if (message.name == kTokenName) return;
  if (message.name != cut_name(settings_.status))
    return leave_out(from, message, "no text with this name is asked for",
                     fmt::format("Name a command {}", cut_name(settings_.status)));
  if (message.text.starts_with(kDone) || message.text.starts_with(kRefused))
    return leave_out(from, message, "it is the answer to a command", "Send commands under this name, and no answers");
  const std::string& text = message.text.empty() ? message.command_name : message.text;
  const GivenCommand given{printable(text), from, message.command_id, message.command_name};
  std::string why;
  if (text.size() > kLongestCommand) {
    why = fmt::format("its text is longer than {} bytes", kLongestCommand);
  } else {
    const std::scoped_lock lock(mutex_);
    if (commands_.size() < kMostCommands) return commands_.push_back(given);
    why = "too many commands are waiting";
  }
  answer(given, why);
  refuse(from, message, {"command", why, "Send fewer and shorter commands, and wait for their answers"});
}

std::vector<GivenCommand> Hub::take_commands() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(commands_, {});
}

void Hub::answer(const GivenCommand& command, const std::string& refused) {
  const auto to = connections_.find(command.connection);
  if (to == connections_.end()) return;
  Bytes bytes;
  const std::string words = (refused.empty() ? kDone + command.text : kRefused + refused).substr(0, kLongestAnswer);
  if (command.command_id) {
    add_answer(bytes, settings_.status, *command.command_id, command.command_name, words);
  } else {
    add_string(bytes, settings_.status, words);
  }
  ++counted_.sent;
  if (!std::shared_ptr<Connection>(to->second)->answer(bytes)) ++counted_.dropped;
}

void Hub::refuse(ConnectionId from, const Incoming& message, const Refusal& refusal) {
  drop(refusal.kind,
       fmt::format("{} '{}' from {} is dropped: {}", message.type, printable_name(message.name),
                   connections_.at(from)->peer(), refusal.why),
       refusal.cure);
}

/// For messages that are right and not asked for. Programs may send any number of them.
void Hub::leave_out(ConnectionId from, const Incoming& message, const std::string& why, const std::string& cure) {
  const std::string subject = fmt::format("{} '{}'", message.type, printable_name(message.name));
  drop(subject, fmt::format("{} from {} is not used: {}", subject, connections_.at(from)->peer(), why), cure, true);
}

void Hub::drop(const std::string& kind, std::string what, std::string cure, bool is_told_once) {
  counted_.problem = what + ". " + cure;
  drops_.add(kind, std::move(what), std::move(cure), is_told_once);
}

void Hub::turn_away(const std::string& why) {
  ++counted_.turned_away;
  drop(why, why, "Connect only programs that are needed; those of other users and machines have to give the token");
}

void Hub::ended(ConnectionId id, const std::optional<Refusal>& why) {
  input_.closed(id);
  probe_.closed(id);
  if (why) {
    ++counted_.garbage;
    drop(why->kind, fmt::format("the connection from {} is closed: {}", connections_.at(id)->peer(), why->why),
         why->cure);
  }
  connections_.erase(id);
  strangers_.erase(id);
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
    drop("given up",
         fmt::format("the connection from {} is closed: it accepted no data for longer than give_up_s",
                     connection->peer()),
         "Let the other program read what it is sent");
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
  counted_.not_used = drops_.total();
  counted_.probe_poses = probe_.counts().poses;
  const std::scoped_lock lock(mutex_);
  shown_ = counted_;
}

LinkState Hub::state() const {
  const std::scoped_lock lock(mutex_);
  return shown_;
}

}  // namespace stylet::igtl
