// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/tissue.hpp"
#include "stylet/geom/locator.hpp"
#include "stylet/geom/topology.hpp"
#include "stylet/probe/capsule.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace stylet {

/// A small area of the rectal wall on which the probe presses with one force. The area moves as the mean of its
/// material points, and the force is spread over it evenly, so that neither depends on the size of the elements.
struct WallPoint {
  Vec3 position_mm = Vec3::Zero();  ///< LPS, undeformed centroid of the area
  Vec3 outward = Vec3::UnitZ();     ///< unit vector from the lumen into the wall, mean of the area
  double area_mm2 = 0.0;
  std::vector<std::pair<Index, double>> weights;  ///< displacement nodes and their share; the shares' sum is 1
  /// Material points, in elements of the mesh, that stand for the area, and their share; the shares' sum is 1.
  std::vector<std::pair<MaterialPoint, double>> pieces;
};

/// The displacement nodes of a tissue and their share in the mean over an area.
/// @param number_of function: number in the tissue of an element of the mesh on which the area was made
std::vector<std::pair<Index, double>> area_weights(const WallPoint& point, const Tissue& tissue,
                                                   const std::function<Index(Index tet)>& number_of);

/// Which part of a surface a probe can press, and how finely.
struct WallReach {
  Capsule rest;                  ///< the probe's surface in the middle of its motions
  Vec3 finest = -Vec3::UnitY();  ///< unit vector; points are nearest to each other on this side of the lumen
  double beyond_mm = 30.0;       ///< points lie up to this far beyond the rounded end
  double lowest_mm = -1e9;       ///< points lie above this level: lowest_level_mm()
  double fine_mm = 25.0;         ///< points are finest up to this distance from the hemisphere's centre, along z
  double coarse = 3.5;           ///< largest spacing / smallest spacing
  int points = 150;              ///< largest number of points
  double spacing_mm = 2.5;       ///< smallest spacing, where `points` allows it
};

/// A triangle of the surface that a probe may press.
struct WallFace {
  std::array<Index, 3> nodes;
  Index tet;                    ///< an element with this face
  Vec3 outward = Vec3::Zero();  ///< unit vector out of the lumen
};

/// The inner surface of the rectal wall: the faces between rectal_lumen and other regions, or without that region the
/// surface of rectum.
/// Errors: the mesh has neither region. @param where name of the patient in messages
Result<std::vector<WallFace>> rectal_wall(const TetMesh& mesh, const Topology& topology, const std::string& where);

/// The level below which the lumen leaves the probe's axis, as the distance [mm] from the hemisphere's centre along the
/// axis, negative on the shaft: going out along the shaft, where the middle of the wall is first off the axis by more
/// than half of the probe's radius. There the shaft comes in through the anal canal, which bends at the pelvic floor.
/// How a probe straightens the canal is beyond linear tissue, so the probe does not press there.
double lowest_level_mm(const TetMesh& mesh, const std::vector<WallFace>& faces, const Capsule& rest);

/// Divides the part of a surface that is within reach into areas, whose number does not depend on the mesh. The areas
/// depend on distances only, so a turned or mirrored mesh has the same ones.
/// @return empty if no face is within reach
std::vector<WallPoint> wall_points(const Tissue& tissue, const std::vector<WallFace>& faces, const WallReach& reach);

}  // namespace stylet
