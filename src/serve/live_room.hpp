// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "disk_watch.hpp"
#include "held_hand.hpp"
#include "image_desk.hpp"
#include "live_run.hpp"
#include "room.hpp"
#include "shelf.hpp"
#include "stylet/io/event_words.hpp"

namespace stylet::serve {

/// The needle that is live: the real-time loop and its recording, the device that moves it, and the seeds that it
/// drops. During a replay it is set aside: it is paused and nothing moves it. Requests: Desk::live.
class LiveRoom {
 public:
  explicit LiveRoom(const SessionSettings& settings);

  /// Takes a needle up in front of the patient in place of the present one. Errors: the loop cannot be started.
  Result<Reply> enter(const NeedleStart& start);
  Reply ask(const Request& request);
  /// Pauses the needle and takes the hand off it, until go_on(), enter() or come_back().
  Reply hold();
  /// Pauses the needle while a long recording is read, since its steps are not fetched then.
  void freeze();
  void go_on();
  /// Holds the needle, because a recording is shown. It stays aside until come_back() or enter().
  Reply set_aside();
  Reply come_back();
  /// Ends the loop and completes its recording.
  void end();

  /// Takes up finished drops, records what has changed of the implant, and shows it.
  Reply follow_implant();
  /// Fetches and records what the loop has done, and shows its newest picture if there is one.
  /// @param whole_curve the picture is to have the whole force curve
  Reply tick(bool whole_curve);

  /// Whether there is a needle, be it set aside.
  [[nodiscard]] bool has_needle() const { return run_ != nullptr; }
  /// Whether there is a needle and it is not set aside.
  [[nodiscard]] bool is_live() const { return run_ && !is_aside_; }
  /// Whether it is live and not paused.
  [[nodiscard]] bool is_running() const { return is_live() && !told_.paused; }
  /// Whether a seed is being dropped or its dose computed; then the result comes soon.
  [[nodiscard]] bool is_busy() const;
  void set_field(const std::shared_ptr<const DisplayField>& field);
  void record_probe(const ProbeSettings& probe);
  /// The moment for pictures; empty before the first step.
  [[nodiscard]] std::optional<LoopState> moment();
  /// Sets the target of the hand. Call it from one thread only, which may be another one.
  void aim(const HandTarget& target) { hand_.aim(target); }
  void describe(SessionStatus& status) const;

 private:
  void pump(Reply& reply);
  Reply drop_seed(const Request& request);
  void take_drop(Reply& reply);
  Reply take_back(const Request& request);
  void show_companion(Reply& reply);
  void heed_disk(Reply& reply);
  void set_seeds();

  const SessionSettings& settings_;
  Shelf shelf_;
  DiskWatch watch_;
  HeldHand hand_;
  std::shared_ptr<ImplantDesk> implant_;  ///< of the open case; null: it has no plan of seeds
  std::uint64_t dropper_ = 0;             ///< viewer that has asked for the drop that is under way
  std::unique_ptr<LiveRun> run_;          ///< null: no needle has been taken up
  bool is_aside_ = false;                 ///< a recording is shown
  std::vector<LiveEvent> happened_;       ///< events of the run
  results::EventWords words_;             ///< has been told of all of them
  SessionStatus told_;                    ///< the part that is about the needle: what describe() gives
};

}  // namespace stylet::serve
