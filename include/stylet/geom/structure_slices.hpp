// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/contours.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stylet {

/// Orthonormal frame of a stack of parallel slices. It may be left-handed, like the frame of an image; only distances
/// and inside/outside are computed in it.
struct SliceFrame {
  Vec3 origin = Vec3::Zero();    ///< [mm] LPS
  Mat3 axes = Mat3::Identity();  ///< columns u, v (in the slice plane) and n (slice normal) in LPS

  [[nodiscard]] Vec3 local(const Vec3& lps) const { return axes.transpose() * (lps - origin); }
  [[nodiscard]] Vec3 lps(const Vec3& local_point) const { return axes * local_point + origin; }
};

/// A closed polygon in the plane of its slice [mm] (points: u, v); the first point is not repeated at the end.
using Polygon = std::vector<Eigen::Vector2d>;

/// A structure in one plane, and the slab of the structure that this plane stands for.
struct StructureSlice {
  double height = 0;  ///< [mm] of the plane along the slice normal
  double below = 0;   ///< [mm] the slab reaches this far below the plane
  double above = 0;   ///< [mm] … and above it
  /// They do not cross each other; a point is inside where an odd number of them surround it.
  std::vector<Polygon> polygons;
  double area_mm2 = 0;      ///< of the points that are inside
  bool joins_next = false;  ///< whether the structure continues to the next slice of the stack

  [[nodiscard]] double thickness() const { return below + above; }
  [[nodiscard]] double volume_mm3() const { return area_mm2 * thickness(); }
};

/// The slices of a structure: what its contours mean. Everything that measures, meshes or samples contours uses them.
///
/// - Contours whose heights differ by less than 0.3 mm, and less than a quarter of the distance of slices, lie in one
///   plane: files round their coordinates.
/// - A contour that occurs twice, also with other points or in the other direction, counts once.
/// - A contour inside another one is a hole, one inside a hole is an island. Contours that overlap in part are united.
/// - A contour that encloses nothing is left out. A loop of at most 1 mm², or half a per cent of the contour's area,
///   counts by the even-odd rule.
/// - A slice stands for half of the gap to each neighbour, and for half of the usual (median) gap at the ends.
/// - A gap of more than 1.4 usual gaps is bridged if the sections on both sides overlap by half of the
///   smaller one and the gap is at most 15 mm, or six usual gaps if that is more. Otherwise the structure ends half a
///   usual gap beyond the slices on both sides of the gap.
///
/// Every deviation from one closed contour in each of evenly spaced slices is said in `note`.
struct StructureSlices {
  SliceFrame frame;
  std::vector<StructureSlice> slices;  ///< at least two, by ascending height
  double usual_gap_mm = 0;             ///< median distance of neighbouring slices
  std::optional<std::string> note;     ///< a sentence for the user about everything unusual in the contours

  [[nodiscard]] double volume_mm3() const;
};

/// The slices of one structure in a frame of its own: from the centre of its largest contour towards the first point of
/// that contour, so that a structure that is turned and moved has the same slices, turned and moved.
/// @param roi the structure
/// @param where file, for messages
/// Errors: no contour that encloses something, a single slice, coordinates that are not finite, an extent that
/// indicates wrong units (below 1 mm, above 2 m), a contour that is not planar, planes that are not parallel, a contour
/// that crosses itself by more than a small loop.
Result<StructureSlices> structure_slices(const Roi& roi, const std::string& where);

/// The same in a given frame, for structures that are handled together. @param frame common_slice_frame()
Result<StructureSlices> structure_slices(const Roi& roi, const std::string& where, const SliceFrame& frame);

/// The common frame of all contours of some structures. Contours on axial slices give exactly the patient's axes.
/// @param where file, for messages
/// Errors: no contour encloses anything; a contour that leaves the common slice plane by more than 0.5 mm.
Result<SliceFrame> common_slice_frame(std::span<const Roi* const> rois, const std::string& where);

/// A note for the user if the side that closes a contour, from its last point to its first, is far longer than all its
/// other sides: it may be a straight side, or a curve that somebody forgot to close. Contours are closed by definition
/// (DICOM CLOSED_PLANAR), so neither is an error.
std::optional<std::string> long_closing_side(const Roi& roi);

}  // namespace stylet
