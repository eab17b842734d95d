// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/evidence/reproduce/figure2.hpp"
#include "stylet/geom/box_mesh.hpp"
#include "stylet/mesher/mesher.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

using namespace stylet;
using namespace stylet::reproduce;

namespace {

/// Contours of a prostate, three circles with many points, and a box mesh with a prostate in its centre.
ContourSet circles() {
  Roi roi{.name = "Prostate", .number = 1, .type = "ORGAN", .contours = {}};
  for (const double z : {5.0, 0.0, -5.0}) {
    Contour contour;
    for (int i = 0; i < 60; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / 60;
      contour.points.emplace_back(20.0 * std::cos(angle), 20.0 * std::sin(angle), z);
    }
    roi.contours.push_back(contour);
  }
  ContourSet set;
  set.rois.push_back(roi);
  return set;
}

TetMesh box_with_prostate() {
  TetMesh mesh = box_mesh({-30, -30, -30}, {30, 30, 30}, {6, 6, 6});
  assign_regions(mesh, {"body", "prostate"}, [](const Vec3& x) { return x.cwiseAbs().maxCoeff() < 20.0 ? 1 : 0; });
  return mesh;
}

}  // namespace

TEST(Figure2, points_kept_are_those_the_mesher_keeps) {
  const ContourSet set = circles();
  const Figure2 figure = make_figure2(set, box_with_prostate(), 0.3);
  ASSERT_EQ(figure.contours.size(), 3u);
  EXPECT_EQ(figure.organ, "prostate");
  EXPECT_EQ(figure.points(), 180u);
  std::size_t kept = 0;
  for (const Contour& contour : set.rois[0].contours) kept += cull(contour, 0.3).points.size();
  EXPECT_EQ(figure.points_kept(), kept);
  EXPECT_LT(kept, 180u);
  for (std::size_t i = 1; i < 3; ++i)
    EXPECT_LT(figure.contours[i - 1].points[0].z(), figure.contours[i].points[0].z()) << "slices in order";
}

TEST(Figure2, surface_of_the_organ_is_closed_and_holds_its_volume) {
  const Figure2 figure = make_figure2(circles(), box_with_prostate(), 0.3);
  std::map<std::pair<Index, Index>, int> edges;
  double volume = 0.0;
  for (const auto& [a, b, c] : figure.surface_triangles) {
    const auto at = [&](Index i) { return figure.surface_points[static_cast<std::size_t>(i)]; };
    volume += at(a).dot(at(b).cross(at(c))) / 6.0;
    for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) ++edges[{p, q}];
  }
  EXPECT_NEAR(volume, 40.0 * 40.0 * 40.0, 1e-6);
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u) << "an edge with a triangle on one side only";
  }
}

TEST(Figure2, both_segments_of_the_needle_fill_the_same_bar) {
  const Figure2 figure = make_figure2(circles(), box_with_prostate(), 0.3);
  const auto volume = [](const Figure2::Segment& segment) {
    double sum = 0.0;
    for (const auto& tet : segment.tets) {
      Mat3 edges;
      for (std::size_t i = 0; i < 3; ++i) {
        edges.col(static_cast<Eigen::Index>(i)) =
            segment.points[static_cast<std::size_t>(tet[i + 1])] - segment.points[static_cast<std::size_t>(tet[0])];
      }
      EXPECT_GT(edges.determinant(), 0.0);
      sum += edges.determinant() / 6.0;
    }
    return sum;
  };
  EXPECT_GT(figure.symmetric.tets.size(), figure.asymmetric.tets.size());
  EXPECT_NEAR(volume(figure.symmetric), volume(figure.asymmetric), 1e-12);
}
