// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

#include <optional>
#include <vector>

namespace stylet {

/// A needle in a picture.
struct ShownNeedle {
  std::vector<Vec3> centreline_mm;  ///< LPS, from base to tip, at least two points
  double diameter_mm = 1.27;
  double lumen_diameter_mm = 1.0;  ///< 0 = the needle is solid
};

/// A needle without a place. @param lumen_diameter_mm empty: in proportion to that of an 18 gauge needle
ShownNeedle shown_needle(double diameter_mm, std::optional<double> lumen_diameter_mm);

/// A seed in a picture.
struct ShownSeed {
  Vec3 centre_mm = Vec3::Zero();  ///< LPS, where the seed is now
  Vec3 axis = Vec3::UnitZ();      ///< unit vector
  double length_mm = 4.5;
  double diameter_mm = 0.8;
  /// Position in Moment::seeds of the next seed of its strand, to which a spacer joins it; empty: none does.
  std::optional<std::size_t> next = {};
};

/// Joins a seed that is about to be added to the last one of a list, if both belong to one strand.
void join_to_last(std::vector<ShownSeed>& seeds, bool same_strand);

/// The way of a needle that has been drawn back: gas and blood in it are bright in ultrasound.
struct ShownTrack {
  std::vector<Vec3> centreline_mm;  ///< LPS, where the track is now, at least two points
  double diameter_mm = 1.27;
};

/// A force of a needle on the tissue. With these forces a picture shows the tissue's displacement right beside the
/// needle, which the linear elements of the mesh cannot represent (docs/theory/near_field.md).
struct ShownForce {
  Vec3 at_mm = Vec3::Zero();    ///< LPS, undeformed place of the force
  Vec3 force_N = Vec3::Zero();  ///< LPS, on the tissue
  Vec3 along = Vec3::UnitZ();   ///< unit vector of the piece of shaft
  double length_mm = 4.0;       ///< of the piece of shaft that bears the force
  double epsilon_mm = 1.05;     ///< radius over which the force is spread
  double shear_MPa = 0.0;       ///< shear modulus of the tissue there
  double poisson = 0.49;
};

/// The patient at one moment, as pictures show it: a mesh in its undeformed shape, and what has moved since.
struct Moment {
  double time_s = 0.0;
  Eigen::Matrix3Xf displacement;  ///< (3 × nodes of the mesh) [mm] LPS
  std::vector<ShownNeedle> needles;
  std::vector<ShownSeed> seeds;
  std::vector<ShownTrack> tracks;
  std::vector<ShownForce> forces;  ///< empty: the displacement is linear in each element
};

/// The moment at which nothing has moved and no needle is near.
Moment moment_at_rest(const TetMesh& mesh);

}  // namespace stylet
