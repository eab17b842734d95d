// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/realtime/runner.hpp"
#include "stylet/serve/companion.hpp"
#include "stylet/serve/picture.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace stylet::serve {

struct HandTarget;

/// A case that has been opened.
struct LoadedCase {
  std::shared_ptr<const Model> model;
  std::vector<std::string> notes;  ///< what was left out, added or put right on the way to the model
};

/// A case that can be opened: a scenario file, a saved model.
struct CaseSource {
  std::string title;
  std::function<Result<LoadedCase>(const Progress&)> load;
};

struct SessionSettings {
  std::vector<CaseSource> cases;              ///< the first is opened; there must be one unless something is replayed
  std::filesystem::path recordings;           ///< folder; every insertion makes a folder in it, with its run.h5
  std::filesystem::path archive;              ///< another folder with recordings, which is only read; may be empty
  std::string replay;                         ///< name of a recording to start with; empty: live
  RunnerSettings runner;                      ///< keep_steps is set
  double pictures_per_s = 60.0;               ///< at most
  double field_waits_s = 3.0;                 ///< longest wait for a page to draw before the displacement field is made
  double recorded_frames_per_s = 10;          ///< at most; fewer where a mesh makes them expensive
  std::shared_ptr<Companion> companion;       ///< may be null
  std::uintmax_t keep_bytes = 5'000'000'000;  ///< recordings may take together, the oldest go first; 0: no limit
  double room_every_s = 2.0;                  ///< looks after their room and the disk's
  /// Free bytes of the disk that a folder is on; empty: as the system says.
  std::function<std::uintmax_t(const std::filesystem::path&)> free_bytes;
  /// Tells who started the session of what has become of recordings; may be empty. From any thread.
  std::function<void(const std::string&)> say;
};

/// Who watches a session. Called from the session's thread; returns at once.
class Audience {
 public:
  virtual ~Audience() = default;
  virtual void show(std::shared_ptr<const Scene> scene) = 0;
  virtual void show(std::shared_ptr<const LiveFrame> frame) = 0;
  virtual void show(const LiveMap& map) = 0;
  virtual void tell(const SessionStatus& status) = 0;
  virtual void tell(const LiveEvent& event) = 0;
  /// @param viewer who asked for what is refused
  virtual void refuse(std::uint64_t viewer, const Notice& why) = 0;
};

/// What viewers can ask a session for.
struct Request {
  enum class Kind {
    hole,       ///< text: another hole of the template
    insertion,  ///< number: one that the scenario plans
    reset,      ///< back to the start of this one
    pause,
    resume,
    step,       ///< number: while paused
    open_case,  ///< number
    replay,     ///< text: a recording
    live,       ///< back from it
    seek,       ///< number [s]
    play,       ///< number: rate, 0 stands
    predict,    ///< number: 1 inserts a needle through each hole for the map, beside the one that moves; 0 no more
    greet,      ///< somebody has come: the whole curve again
    drawn       ///< a page has drawn all it shows
  };
  Kind kind{};
  std::uint64_t viewer = 0;
  std::string text;
  double number = 0.0;
};

/// A live simulation that people watch: opens cases, runs the real-time loop, makes pictures of it, records it, and
/// replays recordings. One thread of its own; the loop has its own two.
class Session {
 public:
  Session(SessionSettings settings, Audience& audience);
  ~Session();  ///< stop()

  void start();
  /// Ends the loop; the recording is whole afterwards.
  void stop();
  /// Any thread. @return false: too many are waiting
  bool ask(Request request);
  /// Where the hand that holds the needle wants the base. From one thread.
  void aim(const HandTarget& target);
  /// Nobody holds the needle any more. From the same thread.
  void let_go();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet::serve
