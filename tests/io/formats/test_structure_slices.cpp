// SPDX-License-Identifier: GPL-3.0-or-later
#include "files.hpp"
#include "stylet/geom/structure_slices.hpp"

#include <Eigen/Geometry>

#include <chrono>

using namespace stylet;
using namespace stylet::test;

namespace {

Roi ball() { return two_organs().rois[0]; }

Result<StructureSlices> check(const Roi& roi) { return structure_slices(roi, "case.dcm"); }

/// The note about a structure; empty if there is nothing to say.
std::string note_of(const Roi& roi) {
  const auto slices = check(roi);
  EXPECT_TRUE(slices.ok()) << why(slices);
  return slices.ok() ? slices->note.value_or("") : "";
}

void expect_said(const Roi& roi, std::initializer_list<const char*> parts) {
  for (const char* part : parts) EXPECT_NE(note_of(roi).find(part), std::string::npos) << note_of(roi);
}

Contour polygon(double z, std::initializer_list<std::pair<double, double>> points) {
  Contour c;
  for (const auto& [x, y] : points) c.points.emplace_back(x, y, z);
  return c;
}

/// A structure with the same polygon in all slices.
Roi prism(const Contour& base) {
  Roi roi;
  roi.name = "Prism";
  for (int k = 0; k < 3; ++k) {
    Contour c = base;
    for (Vec3& p : c.points) p.z() += 5.0 * k;
    roi.contours.push_back(c);
  }
  return roi;
}

}  // namespace

TEST(StructureSlices, accepts_contours_on_parallel_slices) { EXPECT_TRUE(check(ball()).ok()) << why(check(ball())); }

TEST(StructureSlices, accepts_oblique_parallel_slices) {
  Roi roi = ball();
  const Eigen::AngleAxisd turn(0.6, Vec3(1, 2, 3).normalized());
  for (Contour& c : roi.contours) {
    for (Vec3& p : c.points) p = turn * p;
  }
  EXPECT_TRUE(check(roi).ok()) << why(check(roi));
}

TEST(StructureSlices, refuses_an_empty_structure) {
  Roi roi = ball();
  roi.contours.clear();
  expect_refused(check(roi), {"case.dcm, ROI 'Prostate'", "empty"});
}

TEST(StructureSlices, refuses_a_structure_on_one_slice) {
  Roi roi = ball();
  roi.contours.resize(1);
  expect_refused(check(roi), {"'Prostate'", "one slice only", "z = -15.00 mm", "at least 2"});
  roi.contours.push_back(circle(-15.0, 3.0, 24, Vec3(40, 0, 0)));
  expect_refused(check(roi), {"one slice only"});
}

TEST(StructureSlices, leaves_out_contours_that_enclose_nothing_and_says_so) {
  Roi roi = ball();
  EXPECT_EQ(note_of(roi), "");
  const double volume = check(roi)->volume_mm3();
  roi.contours.push_back(polygon(-5.0, {{40, 0}, {41, 1}}));
  roi.contours.push_back(polygon(0.0, {{0, 0}, {1, 1}, {2, 2}, {3, 3}}));
  roi.contours.push_back(polygon(5.0, {{1, 1}, {1, 1}, {1, 1}}));
  roi.contours.push_back(polygon(99.0, {{1, 1}}));
  roi.contours.emplace_back();
  expect_said(roi, {"'Prostate'", "enclose nothing", "contour 8, z = -5.00: 2 points",
                    "contour 9, z = 0.00: points on a", "contour 11, z = 99.00: 1 point"});
  EXPECT_NEAR(check(roi)->volume_mm3(), volume, 1e-9 * volume);
  for (Contour& contour : roi.contours) contour.points.resize(std::min<std::size_t>(2, contour.points.size()));
  expect_refused(check(roi), {"none of its 12 contours encloses an area", "2 points"});
}

TEST(StructureSlices, refuses_nan) {
  Roi roi = ball();
  roi.contours[2].points[5].y() = NAN;
  expect_refused(check(roi), {"contour 3, point 6", "not finite"});
}

TEST(StructureSlices, refuses_a_contour_that_is_not_planar) {
  Roi roi = ball();
  roi.contours[3].points[0].z() += 1.5;
  expect_refused(check(roi), {"contour 4", "off a common plane"});
}

TEST(StructureSlices, refuses_contours_that_are_not_parallel) {
  Roi roi = ball();
  for (Vec3& p : roi.contours[6].points) p.z() += 0.1 * p.x();
  expect_refused(check(roi), {"contour 7", "tilted by 5.7°"});
}

TEST(StructureSlices, refuses_metres_and_micrometres) {
  Roi roi = ball();
  for (Contour& c : roi.contours) {
    for (Vec3& p : c.points) p *= 1e-3;
  }
  expect_refused(check(roi), {"0.04 mm long", "1 mm to 2 m", "metres"});
  for (Contour& c : roi.contours) {
    for (Vec3& p : c.points) p *= 1e6;
  }
  expect_refused(check(roi), {"4e+04 mm long", "micrometres"});
}

TEST(StructureSlices, refuses_a_curve_whose_closing_side_crosses_it) {
  Contour spiral;  // almost 1.5 turns inwards
  for (int i = 0; i <= 60; ++i) {
    const double angle = 2.9 * M_PI * i / 60, radius = 20 - 0.2 * i;
    spiral.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.0);
  }
  expect_refused(check(prism(spiral)), {"crosses itself"});
}

TEST(StructureSlices, says_how_to_do_without_a_broken_structure) {
  Roi roi = ball();
  roi.contours.resize(1);
  expect_refused(check(roi), {"skip = [\"Prostate\"] below [patient]"});
}

TEST(StructureSlices, refuses_a_self_crossing_contour_and_says_where) {
  Roi roi = prism(polygon(0, {{0, 0}, {20, 20}, {20, 0}, {0, 20}}));  // bow tie
  expect_refused(check(roi), {"'Prism', contour 1 (slice z = 0.00 mm)", "crosses itself at (10.00, 10.00, 0.00)"});
  roi = ball();
  std::swap(roi.contours[3].points[4], roi.contours[3].points[7]);
  expect_refused(check(roi), {"contour 4", "crosses itself"});
}

TEST(StructureSlices, accepts_a_keyhole_that_cuts_out_a_hole) {
  // An outer square, an edge inwards to the hole, around it, and back along the same edge; then with the two edges
  // separated by 0.02 mm, as after rounding.
  for (const double apart : {0.0, 0.02, -0.02}) {
    const Roi roi = prism(polygon(0, {{0, 0},
                                      {30, 0},
                                      {30, 30},
                                      {0, 30},
                                      {0, 15},
                                      {10, 15},
                                      {10, 20},
                                      {20, 20},
                                      {20, 10},
                                      {10, 10},
                                      {10, 15 - apart},
                                      {0, 15 - apart}}));
    EXPECT_TRUE(check(roi).ok()) << apart << ": " << why(check(roi));
  }
}

TEST(StructureSlices, accepts_a_polygon_that_touches_itself) {
  EXPECT_TRUE(check(prism(polygon(0, {{0, 0}, {10, 10}, {20, 0}, {20, 20}, {10, 10}, {0, 20}}))).ok());
  EXPECT_TRUE(check(prism(polygon(0, {{0, 0}, {20, 0}, {20, 10}, {10, 0}, {0, 10}}))).ok());
}

TEST(StructureSlices, closes_a_curve_by_a_straight_side_and_notes_a_long_one) {
  Roi roi = ball();
  EXPECT_FALSE(long_closing_side(roi));
  roi.contours[3].points.clear();
  for (int i = 0; i <= 60; ++i) {  // three quarters of a circle
    const double angle = 1.5 * M_PI * i / 60;
    roi.contours[3].points.emplace_back(20 * std::cos(angle), 20 * std::sin(angle), 0.0);
  }
  EXPECT_TRUE(check(roi).ok()) << why(check(roi));
  const auto note = long_closing_side(roi);
  ASSERT_TRUE(note);
  for (const char* part : {"'Prostate'", "1 of 7 contours", "28.3 mm", "straight side"})
    EXPECT_NE(note->find(part), std::string::npos) << *note;
}

TEST(StructureSlices, accepts_coarse_polygons_with_sides_of_any_length) {
  EXPECT_TRUE(check(prism(polygon(0, {{0, 0}, {1, 0}, {1, 60}}))).ok());
  EXPECT_TRUE(
      check(prism(polygon(0, {{0, 0}, {10, 0}, {40, 2}, {41, 3}, {40, 20}, {20, 21}, {1, 20}, {0, 18}, {0, 9}}))).ok());
}

TEST(StructureSlices, judges_half_a_million_points_without_a_noticeable_wait) {
  Roi roi;
  roi.name = "Body";
  for (int k = 0; k < 100; ++k) roi.contours.push_back(circle(2.5 * k, 170.0, 5000));
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(check(roi).ok());
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 3.0);
}
