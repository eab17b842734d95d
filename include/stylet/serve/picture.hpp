// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/snapshot.hpp"
#include "stylet/sim/hole_map.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// The data that viewers of a live session receive (docs/live_protocol.md).
namespace stylet::serve {

/// A case, undeformed.
struct Scene {
  std::string text;                      ///< JSON: regions, template, planned insertions, …
  std::vector<float> positions;          ///< (3 n) [mm] LPS, the points of the surfaces
  std::vector<std::uint32_t> triangles;  ///< (3 t) indices of the corners, patch by patch
};

/// The state at one moment, as it is sent to viewers (wire.hpp).
struct LiveFrame {
  enum Bit : std::uint32_t { paused = 1, replayed = 2, trusted = 4, displaced = 8, whole_curve = 16, coarse = 32 };

  double time_s = 0.0;  ///< simulated time; in a replay it may lie between `step` and the next one
  Step step;            ///< the last step
  std::uint32_t bits = 0;
  std::uint32_t steps = 0;                                              ///< number of steps taken
  std::uint32_t missed = 0;                                             ///< number of missed deadlines
  double roll_deg = 0.0, tilt_left_deg = 0.0, tilt_anterior_deg = 0.0;  ///< orientation of the hand
  double left_out_N = 0.0;  ///< force whose far field or near field (the larger of both), or that at all, is not shown
  std::optional<TipError> tip_error;  ///< empty in a replay, because it is not recorded
  std::vector<float> centreline;      ///< (3 p) [mm] LPS, base to tip
  /// (3 × Snapshot::kRestingPoints × needles) [mm] LPS, needles that rest in the tissue, each base to tip; none in a
  /// replay, because they are not recorded.
  std::vector<float> resting;
  std::vector<ContactSnapshot> contacts;
  std::vector<Step> curve;                 ///< steps since the last frame; with the bit whole_curve, all steps
  double unit_mm = 0.0;                    ///< length that 1 in `displacement` stands for
  std::vector<std::int16_t> displacement;  ///< (3 n) displacement of the scene's points; may be empty
  bool is_news = true;                     ///< false: a sign of life of a needle at rest; not sent
};

/// Stores displacements in a frame, in the smallest unit_mm in which the largest fits 16 bits (at least 0.001 mm).
/// @param u [mm] (3 × n) LPS; the frame gets no displacement if a value is not finite
void set_displacement(LiveFrame& frame, const Eigen::Ref<const Eigen::Matrix3Xf>& u);

/// An event of the insertion. The kind "started" marks the start of an insertion; `region` is then the insertion's
/// name.
struct LiveEvent {
  std::string kind;
  double time_s = 0.0;
  double depth_mm = 0.0;
  double force_N = 0.0;
  std::string region;
  std::string label;  ///< the event in words (results::EventWords); empty: it has none of its own
};

/// The map of the template's holes, as far as it has been computed.
struct LiveMap {
  std::optional<HoleMap> map{};  ///< empty until the clearances are computed, and where no map is possible
  std::string why_not{};         ///< why no map is possible; empty: a map is possible
  int predicted = 0;             ///< number of holes whose insertion was simulated or failed
  bool predicting = false;       ///< further holes are being simulated
};

/// Why a request was not carried out (`text`), and what the user can do (`cure`).
struct Notice {
  std::string text;
  std::string cure;
};

/// The state of a session, without the part that differs from viewer to viewer.
struct SessionStatus {
  enum class State { loading, ready, failed };
  State state = State::loading;
  std::string stage;       ///< stage of loading; when ready: the part of the picture that is still missing
  double fraction = -1.0;  ///< part of `stage` that is done, 0…1; −1 if it is not known
  Notice failure;
  bool paused = false;
  std::string insertion;            ///< name of the insertion
  std::string hole;                 ///< template hole; empty where the insertion does not use one
  std::vector<std::string> inside;  ///< regions that contain the tip (the first) or the shaft
  /// [mm] How far a seed that is pushed out of the tip now would rest from where a rigid straight needle leaves it in a
  /// patient that nothing has moved; empty: not known, or the tip is not in the tissue.
  std::optional<double> seed_off_mm;
  std::string device;          ///< device that moves the needle: "page", or a companion's name
  std::string device_problem;  ///< why the device does not move the needle; empty: it moves the needle
  struct Companion {
    std::string name;           ///< empty: there is no companion
    std::int64_t not_used = 0;  ///< messages and connections that it has not used
    Notice newest;              ///< the newest of these, with its cure; may be empty
  } companion;
  struct Recording {
    std::string name;
    double seconds = 0.0;
    std::string problem;  ///< why nothing is recorded; empty: the session is recorded
    std::string warning;  ///< a condition that may soon stop the recording
  } recording;
  struct Image {
    std::string shown = "none";  ///< the kind of picture that the pages get: "none", "transverse", "sagittal" or "xray"
    std::string problem;         ///< why it cannot be made; empty: it can
    std::string stage;           ///< the part that is being prepared for it; empty: nothing
    std::string probe_device = "page";  ///< mover of the probe: "page", or a companion's name
    std::string probe_problem;          ///< where the probe does not do what a companion's pose says; empty: it does
    bool operator==(const Image&) const = default;
  } image;
  struct Replay {
    std::string name;  ///< recording that is replayed; empty: the session is live
    double time_s = 0.0;
    double duration_s = 0.0;
    double rate = 0.0;  ///< playing speed, 1 is real time; 0: stopped
  } replay;
  /// An implant of the open case that an earlier session, or this one, has begun and not finished.
  struct Interrupted {
    std::string recording;        ///< of its last needle
    std::int64_t recorded_s = 0;  ///< [s] since 1970, when this was last written
    std::size_t seeds = 0;        ///< in the tissue
    std::size_t planned_seeds = 0;
    std::string needle;  ///< that was in front of the patient
  };
  std::optional<Interrupted> interrupted;  ///< empty: there is none, or another one has been begun
  struct Loop {
    std::int64_t steps = 0;
    std::int64_t missed = 0;
    double p50_us = 0.0, p99_us = 0.0, max_us = 0.0;  ///< thread CPU time of a step
    std::string rights;
  } loop;
};

}  // namespace stylet::serve
