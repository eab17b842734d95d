// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/snapshot.hpp"
#include "stylet/sim/hole_map.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// What viewers are shown (docs/live_protocol.md).
namespace stylet::serve {

/// A case as it lies undeformed.
struct Scene {
  std::string text;                      ///< JSON
  std::vector<float> positions;          ///< (3 n) [mm] LPS of the nodes of surfaces
  std::vector<std::uint32_t> triangles;  ///< (3 t) corners, patch by patch
};

/// One moment, as it goes to viewers (wire.hpp).
struct LiveFrame {
  enum Bit : std::uint32_t { paused = 1, replayed = 2, trusted = 4, displaced = 8, whole_curve = 16 };

  double time_s = 0.0;  ///< simulated; of a replay between two steps later than the step's
  Step step;            ///< the last one
  std::uint32_t bits = 0;
  std::uint32_t steps = 0;                                              ///< so many have been taken
  std::uint32_t missed = 0;                                             ///< deadlines
  double roll_deg = 0.0, tilt_left_deg = 0.0, tilt_anterior_deg = 0.0;  ///< of the hand
  double left_out_N = 0.0;                                              ///< far or near field is not shown, the larger
  std::optional<TipError> tip_error;                                    ///< empty in a replay: not recorded
  std::vector<float> centreline;                                        ///< (3 p) [mm] LPS, base to tip
  std::vector<ContactSnapshot> contacts;
  std::vector<Step> curve;                 ///< steps since the last frame; with whole_curve all
  double unit_mm = 0.0;                    ///< of `displacement`
  std::vector<std::int16_t> displacement;  ///< (3 n) of the scene's nodes; may be empty
};

/// Puts displacements into a frame, in the finest unit that holds them.
/// @param u [mm] (3 × n) LPS
void set_displacement(LiveFrame& frame, const Eigen::Ref<const Eigen::Matrix3Xf>& u);

/// Something that happened, or "started" with the insertion's name for the region.
struct LiveEvent {
  std::string kind;
  double time_s = 0.0;
  double depth_mm = 0.0;
  double force_N = 0.0;
  std::string region;
};

/// The map of the case's template, as far as it has been made.
struct LiveMap {
  std::optional<HoleMap> map{};  ///< empty until the clearances are there, and where there can be none
  std::string why_not{};         ///< why there can be none; empty: there can
  int predicted = 0;             ///< holes whose insertion has succeeded or failed
  bool predicting = false;       ///< more are to come
};

/// Why a request was not carried out.
struct Notice {
  std::string text;
  std::string cure;
};

/// How a session is doing, but for what differs from viewer to viewer.
struct SessionStatus {
  enum class State { loading, ready, failed };
  State state = State::loading;
  std::string stage;       ///< of loading; when ready: what is still missing of the picture
  double fraction = -1.0;  ///< of it, −1 where it is not known
  Notice failure;
  bool paused = false;
  std::string insertion;            ///< its name
  std::string hole;                 ///< empty where it is none
  std::vector<std::string> inside;  ///< regions that the needle is in with its tip (the first) or its shaft
  std::string device;               ///< that has the needle: "page", or a companion's name
  std::string device_problem;       ///< why it does not move the needle now; empty: it does
  struct Recording {
    std::string name;
    double seconds = 0.0;
    std::string problem;  ///< why nothing is recorded; empty: it is
    std::string warning;  ///< what may keep it from going on
  } recording;
  struct Replay {
    std::string name;  ///< empty: live
    double time_s = 0.0;
    double duration_s = 0.0;
    double rate = 0.0;  ///< 0: stands
  } replay;
  struct Loop {
    std::int64_t steps = 0;
    std::int64_t missed = 0;
    double p50_us = 0.0, p99_us = 0.0, max_us = 0.0;  ///< thread CPU time of a step
    std::string rights;
  } loop;
};

}  // namespace stylet::serve
