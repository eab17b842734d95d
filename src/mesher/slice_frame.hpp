// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/geom/contours.hpp"

namespace stylet::meshing {

/// Orthonormal frame of a stack of parallel slices. It may be left-handed, like the frame of an image; only distances
/// and inside/outside are computed in it.
struct SliceFrame {
  Vec3 origin = Vec3::Zero();    ///< [mm] LPS
  Mat3 axes = Mat3::Identity();  ///< columns u, v (in the slice plane) and n (slice normal) in LPS

  [[nodiscard]] Vec3 local(const Vec3& lps) const { return axes.transpose() * (lps - origin); }
  [[nodiscard]] Vec3 lps(const Vec3& local_point) const { return axes * local_point + origin; }
};

/// A closed polygon in the plane of its slice.
using Polygon = std::vector<Eigen::Vector2d>;

/// All polygons of one structure in one plane. A point is inside when an odd number of polygons contain it.
struct Slice {
  double height = 0;              ///< [mm] along the slice normal
  std::vector<Polygon> polygons;  ///< [mm] (u, v)

  [[nodiscard]] double area() const;  ///< [mm²] by the even-odd rule, for polygons that do not cross each other
};

/// The common frame of all contours of some ROIs. Errors: contours that are not planar or not parallel; the error names
/// the ROI.
Result<SliceFrame> common_frame(const ContourSet& contours, const std::vector<const Roi*>& rois);

/// Sorts the contours of a structure into slices by height. A contour that occurs twice counts once.
std::vector<Slice> to_slices(const std::vector<Contour>& contours, const SliceFrame& frame);

/// Median distance between neighbouring slices [mm]; 0 for a single slice.
double slice_gap(const std::vector<Slice>& slices);

/// Thickness that each slice represents [mm] (slices): half way to each neighbour; half the median gap at the ends and
/// towards gaps wider than kMaxBridgedGaps medians.
std::vector<double> slice_thickness(const std::vector<Slice>& slices);

/// Slices further apart than this number of median gaps belong to separate pieces of the structure.
inline constexpr double kMaxBridgedGaps = 4.5;

}  // namespace stylet::meshing
