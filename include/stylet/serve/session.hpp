// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/realtime/runner.hpp"
#include "stylet/serve/companion.hpp"
#include "stylet/serve/image_picture.hpp"
#include "stylet/serve/implant_case.hpp"
#include "stylet/serve/implant_picture.hpp"
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
  std::vector<std::string> notes;  ///< things left out, added or corrected when the model was made
  /// A plan of seeds to carry out; null: the case has none. The model may have any needle.
  std::shared_ptr<const ImplantCase> implant{};
};

/// A case that can be opened: a scenario file or a saved model.
struct CaseSource {
  std::string title;
  std::function<Result<LoadedCase>(const Progress&)> load;
};

struct SessionSettings {
  std::vector<CaseSource> cases;      ///< the first is opened; may be empty only with `replay`
  std::filesystem::path recordings;   ///< folder; every insertion makes a folder with run.h5 in it
  std::filesystem::path archive;      ///< another folder with recordings, which is only read; may be empty
  std::string replay;                 ///< name of a recording to start with; empty: live
  RunnerSettings runner;              ///< keep_steps is set by the session
  double pictures_per_s = 60.0;       ///< [1/s] highest rate of pictures
  double field_waits_s = 3.0;         ///< [s] longest wait for a page to draw before the displacement field is prepared
  double recorded_frames_per_s = 10;  ///< [1/s] highest rate of recorded frames; lower if frames take long to compute
  std::shared_ptr<Companion> companion;  ///< may be null
  /// Limit of all recordings together; the oldest are removed first; 0: no limit.
  std::uintmax_t keep_bytes = 5'000'000'000;
  double room_every_s = 2.0;  ///< [s] period of the check of this limit and of the free disk space
  /// Returns the free bytes of the disk that holds a folder; empty: asks the system.
  std::function<std::uintmax_t(const std::filesystem::path&)> free_bytes;
  /// Receives messages about removed recordings and full disks, for the terminal; may be empty. Called from any thread.
  std::function<void(const std::string&)> say;
};

/// Receives the output of a session. The session's thread makes all calls; each must return at once.
class Audience {
 public:
  virtual ~Audience() = default;
  virtual void show(std::shared_ptr<const Scene> scene) = 0;
  virtual void show(std::shared_ptr<const LiveFrame> frame) = 0;
  virtual void show(const LiveMap& map) = 0;
  // Of a case with a plan of seeds; a plan without needles ends it.
  virtual void show(const LivePlan& /*plan*/) {}
  virtual void show(const LiveImplant& /*implant*/) {}
  virtual void show(const LiveSeeds& /*seeds*/) {}
  virtual void show(std::shared_ptr<const LiveDose> /*dose*/) {}
  virtual void show(std::shared_ptr<const LiveImage> /*image*/) {}
  virtual void tell(const SessionStatus& status) = 0;
  virtual void tell(const LiveEvent& event) = 0;
  /// Reports that a request was refused.
  /// @param viewer the viewer that made the request
  virtual void refuse(std::uint64_t viewer, const Notice& why) = 0;
};

/// A request of a viewer to the session.
struct Request {
  enum class Kind {
    hole,       ///< starts an insertion through another hole of the template; text: its name
    insertion,  ///< starts an insertion that the scenario plans; number: its index
    reset,      ///< restarts the current insertion
    pause,
    resume,
    step,       ///< takes steps while paused; number: how many
    open_case,  ///< number: index of the case
    replay,     ///< text: name of a recording
    live,       ///< ends the replay and continues the live insertion
    seek,       ///< moves the replay to a time; number [s]
    play,       ///< number: speed of the replay, 1 is real time, 0 stops it
    needle,     ///< starts the insertion of a needle of the plan; number: its index
    drop,       ///< drops the next seed of the needle
    undo,       ///< takes the last seed back
    clear,      ///< takes all seeds back
    image,      ///< text: the kind of picture to make, "none", "transverse", "sagittal" or "xray"
    set,        ///< text: a key of [probe], [ultrasound] or [fluoroscopy]; number: its value
    predict,    ///< number: 1 simulates an insertion through each hole for the map, in the background; 0 stops this
    greet,      ///< a viewer has connected and needs the whole force curve
    drawn       ///< a page has drawn its first complete picture
  };
  Kind kind{};
  std::uint64_t viewer = 0;
  std::string text;
  double number = 0.0;
};

/// A live simulation with viewers: it opens cases, runs the real-time loop, makes pictures, records, and replays
/// recordings. It has one thread of its own; the real-time loop has two more.
class Session {
 public:
  Session(SessionSettings settings, Audience& audience);
  ~Session();  ///< stop()

  void start();
  /// Ends the loop and completes the recording.
  void stop();
  /// Queues a request. May be called from any thread. @return false if too many requests are waiting
  bool ask(Request request);
  /// Sets the target of the hand that holds the needle. Call it from one thread only.
  void aim(const HandTarget& target);
  /// Stops the needle, because nobody holds it. Call it from the same thread as aim().
  void let_go();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet::serve
