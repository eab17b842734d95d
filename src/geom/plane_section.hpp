// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/structure_slices.hpp"

namespace stylet::detail {

/// The area that the contours of one plane enclose.
struct PlaneSection {
  std::vector<Polygon> polygons;  ///< [mm] they do not cross; a point is inside where an odd number surround it
  double area_mm2 = 0;            ///< of the points that are inside
  int twice = 0;                  ///< contours that occurred before, and do not count again
  int united = 0;                 ///< contours that overlapped another one in part, and were united with it
  int holes = 0;                  ///< contours that lie inside a part and are holes in it
  int parts = 0;                  ///< parts apart from each other, and islands in holes
};

/// Finds what the contours of one plane enclose together. A contour that occurs twice counts once, one inside another
/// is a hole, one inside a hole is an island, and contours that overlap in part are united. Outlines whose mean
/// distance is below 0.25 mm are the same outline.
/// @param contours [mm] polygons that enclose an area and do not cross themselves
PlaneSection plane_section(const std::vector<Polygon>& contours);

/// Area of a polygon [mm²], positive if its points go round counter-clockwise.
double signed_area(const Polygon& polygon);

/// The area that a polygon that crosses itself encloses by the even-odd rule.
struct EvenOdd {
  std::vector<Polygon> polygons;  ///< [mm] as in PlaneSection
  double area_mm2 = 0;
  double loops_mm2 = 0;  ///< area of the loops on which the even-odd rule and the sense of rotation disagree
};
EvenOdd even_odd(const Polygon& polygon);

/// Area [mm²] that two sections have in common.
double common_area(const std::vector<Polygon>& a, const std::vector<Polygon>& b);

}  // namespace stylet::detail
