// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "companion_turn.hpp"
#include "complaints.hpp"
#include "live_room.hpp"
#include "mailbox.hpp"
#include "open_case.hpp"
#include "picture_room.hpp"
#include "replay_room.hpp"

#include <atomic>
#include <chrono>
#include <optional>
#include <thread>

namespace stylet::serve {

/// A live simulation with viewers. It knows which room has the audience, the live needle or a recording, passes each
/// request to the room that the table of commands names, shows the viewers what the room replies, and carries out the
/// transition that the room wants. It has one thread of its own; the real-time loop has two more.
class Session {
 public:
  Session(SessionSettings settings, Audience& audience);
  ~Session() { stop(); }

  void start();
  /// Ends the loop and completes the recording.
  void stop();
  /// Queues a request. May be called from any thread. @return false if too many requests are waiting
  bool ask(Request request) { return mail_.put(std::move(request)); }
  /// Says that a viewer has connected, who needs the whole force curve. May be called from any thread.
  void welcome() { is_awaited_ = true; }
  /// Sets the target of the hand that holds the needle. Call it from one thread only.
  void aim(const HandTarget& target) { live_.aim(target); }
  /// Says whether a page holds the needle. May be called from any thread.
  void hold(bool is_held) { turn_.hold(is_held); }
  /// Stops the needle, because nobody holds it. Call it from the same thread as aim().
  void let_go();

 private:
  using SessionClock = std::chrono::steady_clock;

  void run(const std::stop_token& stop);
  void turn(const std::stop_token& stop, SessionClock::time_point& before);
  void begin();
  void carry_out(const Request& request);
  void heed_companion();
  std::optional<Notice> obey(const std::string& text);
  Reply ask_room(const CommandRow& row, const Request& request);
  void tick(double dt_s);
  bool show(const Reply& reply);
  void follow(const Reply& reply, const Request& request);
  void go(const Stay& /*here*/, const Request& /*request*/) {}
  void go(const ToOpen& what, const Request& request);
  void go(const ToLive& what, const Request& request);
  void go(const ToReplay& what, const Request& request);
  void pass_moment();
  void say_status();
  Progress progress();
  void refuse(const Request& request, const Notice& why) { pass(Refusal{request.viewer, why}); }
  void pass(const Message& message);
  void fail(const Notice& why);
  void give_up(const Request& request, const Error& why);
  void tell_all(const Error& why);

  const SessionSettings settings_;
  Audience& audience_;
  Complaints complaints_;
  OpenCase case_;
  LiveRoom live_;
  ReplayRoom replay_;
  PictureRoom pictures_;
  bool is_replaying_ = false;  ///< the recording has the audience, otherwise the live needle
  Mailbox mail_;
  SessionStatus status_;
  std::atomic<bool> is_awaited_ = true;  ///< the whole curve is
  CompanionTurn turn_;
  std::chrono::steady_clock::time_point next_status_;
  std::chrono::steady_clock::time_point last_progress_;
  std::jthread thread_;  ///< last member, so that it starts when the others exist
};

}  // namespace stylet::serve
