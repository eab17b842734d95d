// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// Numbers that Goksel et al. 2005 state, and numbers that follow from them. All other numbers of the reproduction are
/// measured or computed in its run. @cite Goksel2005
namespace stylet::reproduce::paper_numbers {

inline constexpr int kNodes = 570;
inline constexpr int kTets = 2801;
inline constexpr double kShortestEdge_mm = 3.06;
inline constexpr double kSmallestDihedral_deg = 9.94;
inline constexpr double kWorstBcs_s = 2.75;
inline constexpr double kWoodburyBelow_s = 1e-3;  ///< "less than 1 ms iterations"
inline constexpr double kForceAxisFrom_N = -0.6;  ///< extent of figure 6's axes
inline constexpr double kForceAxisTo_N = 0.9;

inline constexpr double kClock_Hz = 3.2e9;
inline constexpr int kFlopPerCycle = 2;  ///< a Pentium 4: one addition and one multiplication of doubles

/// Number of nodes of the elements that change when a node is added on the face between two elements.
inline constexpr int kNodesInvolved = 6;
inline constexpr int kOrder = 3 * kNodes;
inline constexpr int kChange = 3 * kNodesInvolved;

}  // namespace stylet::reproduce::paper_numbers
