// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"
#include "stylet/needle/tet.hpp"

#include <array>
#include <vector>

namespace stylet::tet {

/// Nodes of a segment: 0…3 corners and 4 centre of the layer nearer the base, 5…9 the same of the next layer, then the
/// middle nodes, which belong to this segment alone: 10…13 centres of the side faces, 14 centre of the body.
inline constexpr int kLayerNodes = 5;
inline constexpr int kAxisNode = 4;
inline constexpr int kMostNodes = 15;
inline constexpr int kFirstMiddle = 2 * kLayerNodes;

/// A linear tetrahedron in the straight needle.
struct Element {
  std::array<int, 4> node{};     ///< of the segment
  std::array<Vec3, 4> gradient;  ///< [1/mm] of the nodes' hat functions
  double volume = 0.0;           ///< [mm³]
};

/// The element between four nodes. @param nodes [mm] of the segment, @param node ordered so that its volume is positive
[[nodiscard]] Element make_element(const std::vector<Vec3>& nodes, const std::array<int, 4>& node);

/// The piece of bar the needle repeats along its axis (z), all alike.
struct SegmentMesh {
  std::vector<Vec3> nodes;  ///< [mm] from the centre of the layer nearer the base; kFirstMiddle and more
  std::vector<Element> elements;

  [[nodiscard]] int middle_nodes() const { return static_cast<int>(nodes.size()) - kFirstMiddle; }
  /// Nodes that share an element with a middle node, without the middle nodes before it.
  [[nodiscard]] std::vector<int> neighbours_after(int middle) const;
};

/// @param width [mm] of the square section, @param length [mm] of the segment
[[nodiscard]] SegmentMesh make_segment(TetNeedle::Segment kind, double width, double length);

}  // namespace stylet::tet
