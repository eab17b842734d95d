// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/probe/probe_contact.hpp"
#include "stylet/realtime/latest_value.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <thread>
#include <vector>

namespace stylet {

/// A thread beside the real-time loop that finds how a moving probe deforms the tissue: the newest pose of the probe
/// goes in, the displacement of nodes comes out. Both sides are wait-free and do not allocate. Poses that come faster
/// than the thread works are left out. The displacement is added to the displacement by needles; the loop's equations
/// do not change (docs/theory/probe.md, Superposition).
class ProbeWorker {
 public:
  struct Answer {
    std::uint32_t pose = 0;  ///< number of the pose that this answers; 0: none yet
    Capsule probe;
    ProbePress press;
    const float* displacement = nullptr;  ///< [mm] LPS (3 × nodes asked for), column-major; see displacement()
  };

  /// Starts the thread; throws std::system_error if the system provides none, std::out_of_range for a node that the
  /// mesh does not have.
  /// @param contact may have a reference pose
  /// @param nodes nodes of the mesh whose displacement is wanted; empty: all
  explicit ProbeWorker(ProbeContact contact, std::vector<Index> nodes = {});
  /// Ends the thread after its present pose.
  ~ProbeWorker();
  ProbeWorker(const ProbeWorker&) = delete;
  ProbeWorker& operator=(const ProbeWorker&) = delete;

  /// Moves the probe. Calls from one thread only. @return number of the pose
  std::uint32_t move(const Capsule& probe);

  /// Fetches the newest answer. Calls of this and the next two from one thread only. @return whether it is a new one
  bool fetch() { return answer_.fetch(); }
  [[nodiscard]] const Answer& answer() const { return answer_.value(); }
  /// Displacement [mm] of the nodes asked for (3 × nodes), of the answer last fetched, which must not be the one of
  /// pose 0. It stays unchanged until the next fetch().
  [[nodiscard]] Eigen::Map<const Eigen::Matrix3Xf> displacement() const {
    return {answer().displacement, 3, nodes_count_};
  }

 private:
  struct Pose {
    std::uint32_t number = 0;
    Capsule probe;
  };

  void run() noexcept;
  void answer_pose(const Pose& pose);

  LatestValue<Pose> pose_;
  LatestValue<Answer> answer_;
  std::uint32_t number_ = 0;  ///< used by the thread that moves the probe
  // Used by the worker's thread.
  ProbeContact contact_;
  std::vector<Index> nodes_;
  Eigen::Index nodes_count_;
  std::array<Eigen::Matrix3Xf, 3> fields_;  ///< one for each slot of answer_
  std::size_t given_ = 0;                   ///< number of fields that have a slot
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace stylet
