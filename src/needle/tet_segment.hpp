// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"
#include "stylet/needle/tet.hpp"

#include <array>
#include <vector>

namespace stylet::tet {

/// Nodes of a segment: 0…3 are the corners and 4 is the centre of the layer nearer to the base; 5…9 are the same for
/// the next layer. Then follow the middle nodes, which belong to this segment alone: 10…13 are the centres of the side
/// faces, 14 is the centre of the body.
inline constexpr int kLayerNodes = 5;
inline constexpr int kAxisNode = 4;
inline constexpr int kMostNodes = 15;
inline constexpr int kFirstMiddle = 2 * kLayerNodes;

/// A linear tetrahedron of the unloaded needle.
struct Element {
  std::array<int, 4> node{};     ///< node numbers in the segment
  std::array<Vec3, 4> gradient;  ///< [1/mm] gradients of the hat functions of its nodes
  double volume = 0.0;           ///< [mm³]
};

/// The element between four nodes.
/// @param nodes [mm] all nodes of the segment
/// @param node numbers of the four nodes, in an order that makes the volume positive
[[nodiscard]] Element make_element(const std::vector<Vec3>& nodes, const std::array<int, 4>& node);

/// The piece of the bar that is repeated along the needle's axis (z).
struct SegmentMesh {
  /// [mm] relative to the centre of the layer nearer to the base; at least kFirstMiddle nodes.
  std::vector<Vec3> nodes;
  std::vector<Element> elements;

  [[nodiscard]] int middle_nodes() const { return static_cast<int>(nodes.size()) - kFirstMiddle; }
  /// Nodes that share an element with a middle node, without the middle nodes that precede it.
  [[nodiscard]] std::vector<int> neighbours_after(int middle) const;
};

/// Makes a segment of one kind.
/// @param width width of the square section [mm]
/// @param length length of the segment [mm]
[[nodiscard]] SegmentMesh make_segment(TetNeedle::Segment kind, double width, double length);

}  // namespace stylet::tet
