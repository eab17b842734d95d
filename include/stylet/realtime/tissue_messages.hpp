// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/wrench.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

// The messages of a TissueProbe between the thread that asks and that of the real-time loop.
namespace stylet {

inline constexpr std::size_t kWatchedPoints = 32;  ///< largest number of watched points
inline constexpr std::size_t kTrainSeeds = 24;     ///< largest number of seeds in a train

/// A seed that the needle left while the loop ran. All places are of its centre, in LPS [mm].
struct ProbedDrop {
  bool is_done = false;        ///< the other fields hold
  bool tip_in_tissue = false;  ///< false: the tip was in air, or out at the other side; then nothing was dropped
  bool found = false;          ///< the point of the tissue was found
  Triple place{};              ///< where the seed was left, in the room
  Triple straight{};           ///< where a rigid straight needle on the same base would have left it
  Triple axis{};               ///< unit vector of the needle at the seed
  Triple rest{};               ///< the point of the tissue there, undeformed; `place` if it was not found
  Triple lasting{};            ///< part of that point's displacement to which the tissue has crept
  double base_depth_mm = 0.0;  ///< of the step in which the seed was left
  double time_s = 0.0;         ///< of that step
};

/// The loop's answer.
struct TissueAnswer {
  std::uint32_t order = 0;   ///< number of the order that `drops` belong to; 0: nothing was ordered
  double began_at_mm = 0.0;  ///< Step::base_depth_mm after which the order was begun
  std::size_t drop_count = 0;
  std::array<ProbedDrop, kTrainSeeds> drops{};  ///< in the order of the train
  std::uint32_t version = 0;                    ///< of the watched points (watch())
  std::size_t count = 0;                        ///< number of watched points
  std::array<Triple, kWatchedPoints> now{};     ///< [mm] LPS, their present places
  std::array<bool, kWatchedPoints> is_known{};  ///< the place was computed
};

/// The reading thread's question.
struct TissueOrder {
  std::uint32_t number = 0;
  std::size_t seeds = 0;
  std::array<double, kTrainSeeds> beyond_tip_mm{};
  double half_length_mm = 0.0;
  std::uint32_t version = 0;
  std::size_t count = 0;
  std::array<Triple, kWatchedPoints> points{};
};

}  // namespace stylet
