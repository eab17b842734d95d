// SPDX-License-Identifier: GPL-3.0-or-later
// The volume of a structure drawn in any way, against the polygons of an independent library (GEOS).
#include "stylet/dose/structure_samples.hpp"
#include "stylet/geom/structure_slices.hpp"
#include "stylet/mesher/mesher.hpp"
#include "support/value_of.hpp"

#include <geos_c.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>

namespace stylet {
namespace {

/// Areas of polygons by GEOS.
class Geos {
 public:
  Geos() : handle_(GEOS_init_r()) {}
  ~Geos() { GEOS_finish_r(handle_); }
  Geos(const Geos&) = delete;
  Geos& operator=(const Geos&) = delete;

  using Shape = std::shared_ptr<GEOSGeometry>;
  Shape polygon(const Contour& contour) const {
    const auto n = static_cast<unsigned>(contour.points.size());
    GEOSCoordSequence* points = GEOSCoordSeq_create_r(handle_, n + 1, 2);
    for (unsigned k = 0; k <= n; ++k)
      GEOSCoordSeq_setXY_r(handle_, points, k, contour.points[k % n].x(), contour.points[k % n].y());
    return hold(GEOSGeom_createPolygon_r(handle_, GEOSGeom_createLinearRing_r(handle_, points), nullptr, 0));
  }
  Shape both(const Shape& a, const Shape& b) const { return hold(GEOSUnion_r(handle_, a.get(), b.get())); }
  Shape less(const Shape& a, const Shape& b) const { return hold(GEOSDifference_r(handle_, a.get(), b.get())); }
  double area(const Shape& shape) const {
    double area = 0;
    GEOSArea_r(handle_, shape.get(), &area);
    return area;
  }

 private:
  Shape hold(GEOSGeometry* geometry) const {
    return {geometry, [handle = handle_](GEOSGeometry* g) { GEOSGeom_destroy_r(handle, g); }};
  }
  GEOSContextHandle_t handle_;
};

Contour ellipse(double x, double y, double z, double a, double b, int points, double start = 0) {
  Contour contour;
  for (int k = 0; k < points; ++k) {
    const double angle = start + 2 * std::numbers::pi * k / points;
    contour.points.emplace_back(x + a * std::cos(angle), y + b * std::sin(angle), z);
  }
  return contour;
}

/// A gland drawn in a random way, and the volume that it has by GEOS.
struct Drawn {
  Roi roi;
  double volume_mm3 = 0;
  std::vector<std::string> said;  ///< words that the note has to have
};

Drawn draw(unsigned seed, const Geos& geos) {
  std::mt19937 random(seed);
  const auto chance = [&](double p) { return std::bernoulli_distribution(p)(random); };
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Drawn out;
  out.roi.name = "Prostate";
  const double spacing = between(1.5, 4);
  const double half_length = between(16, 26);
  const double a = between(14, 26);
  const double b = between(12, 20);
  const bool second_lobe = chance(0.3);
  const bool hole = chance(0.3);
  const bool island = chance(0.2);
  const bool uneven = chance(0.3);
  const int twice = chance(0.4) ? std::uniform_int_distribution<int>(1, 3)(random) : 0;
  const bool heights_differ = chance(0.2);
  const int missing = chance(0.4) ? std::uniform_int_distribution<int>(1, 3)(random) : 0;

  std::vector<double> heights;
  double z = -half_length + 0.5 * spacing;
  while (z < half_length - 0.3 * spacing) {
    heights.push_back(z);
    z += uneven && z > 0 ? 2 * spacing : spacing;
  }
  if (missing > 0) {
    const auto first = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
    heights.erase(first, first + std::min<std::ptrdiff_t>(missing, heights.end() - first - 2));
  }
  std::vector<double> areas;
  for (const double height : heights) {
    const double scale = std::sqrt(1 - std::pow(height / half_length, 2));
    const auto add = [&](const Contour& contour) {
      Contour drawn = contour;
      if (heights_differ && out.roi.contours.size() % 2 == 1) {
        for (Vec3& p : drawn.points) p.z() += 0.07;
      }
      out.roi.contours.push_back(drawn);
      return geos.polygon(contour);
    };
    const Contour outer = ellipse(0, 0, height, a * scale, b * scale, 72);
    Geos::Shape whole = add(outer);
    if (second_lobe)
      whole = geos.both(whole, add(ellipse(0.9 * a * scale, 0, height, 0.5 * a * scale, 0.6 * b * scale, 60)));
    if (hole) whole = geos.less(whole, add(ellipse(-0.3 * a * scale, 0, height, 0.3 * a * scale, 0.3 * b * scale, 40)));
    if (island) whole = geos.both(whole, add(ellipse(0, -3 * b, height, 0.3 * b * scale, 0.3 * b * scale, 36)));
    if (twice == 1) add(outer);
    if (twice == 2) {
      Contour other = outer;
      std::reverse(other.points.begin(), other.points.end());
      std::rotate(other.points.begin(), other.points.begin() + 17, other.points.end());
      add(other);
    }
    if (twice == 3) add(ellipse(0, 0, height, a * scale, b * scale, 60, 0.03));
    areas.push_back(geos.area(whole));
  }
  std::vector<double> gaps;
  for (std::size_t k = 1; k < heights.size(); ++k) gaps.push_back(heights[k] - heights[k - 1]);
  std::vector<double> sorted = gaps;
  std::sort(sorted.begin(), sorted.end());
  const double usual = sorted[sorted.size() / 2];
  for (std::size_t k = 0; k < heights.size(); ++k) {
    const double below = k == 0 ? usual : gaps[k - 1];
    const double above = k + 1 == heights.size() ? usual : gaps[k];
    out.volume_mm3 += areas[k] * 0.5 * (below + above);
  }
  if (second_lobe) out.said.emplace_back("united");
  if (hole) out.said.emplace_back("hole");
  if (island) out.said.emplace_back("separate parts");
  if (twice > 0) out.said.emplace_back("occurs twice");
  if (heights_differ && (second_lobe || hole || island || twice > 0)) out.said.emplace_back("different heights");
  if (sorted.back() > 1.4 * usual) out.said.emplace_back("unevenly spaced");
  return out;
}

TEST(StructureVolumes, of_contours_drawn_in_any_way_are_those_of_an_independent_library_and_what_is_unusual_is_said) {
  const Geos geos;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const Drawn drawn = draw(seed, geos);
    const auto slices = test::value_of(structure_slices(drawn.roi, ""));
    EXPECT_NEAR(slices.volume_mm3() / drawn.volume_mm3, 1, 0.005) << seed;
    const auto samples = test::value_of(sample_structure(drawn.roi, 0.5));
    EXPECT_NEAR(1000 * samples.volume_cc() / slices.volume_mm3(), 1, 0.01) << seed;
    const Roi* one[] = {&drawn.roi};
    const auto frame = test::value_of(common_slice_frame(one, ""));
    const auto meshed = test::value_of(structure_slices(drawn.roi, "", frame));
    EXPECT_NEAR(meshed.volume_mm3() / slices.volume_mm3(), 1, 1e-4) << seed;
    EXPECT_EQ(slices.note.has_value(), !drawn.said.empty()) << seed << ": " << slices.note.value_or("");
    for (const std::string& word : drawn.said)
      EXPECT_NE(slices.note.value_or("").find(word), std::string::npos) << seed << ": " << word;
  }
}

TEST(StructureVolumes, in_the_mesh_are_those_of_the_contours_or_a_note_says_so) {
  const Geos geos;
  for (const unsigned seed : {1U, 4U, 9U, 16U, 25U}) {
    const Drawn drawn = draw(seed, geos);
    ContourSet set;
    set.rois = {drawn.roi};
    MeshOptions options;
    options.nodes = 1200;
    const auto mesh = test::value_of(mesh_contours(set, options));
    const auto& regions = mesh.report.regions;
    const auto gland = std::find_if(regions.begin(), regions.end(), [](const auto& r) { return r.name == "prostate"; });
    ASSERT_NE(gland, regions.end());
    EXPECT_NEAR(1000 * gland->structure_volume_cc / drawn.volume_mm3, 1, 0.005) << seed;
    const bool said = std::any_of(mesh.report.notes.begin(), mesh.report.notes.end(), [](const std::string& note) {
      return note.find("'prostate' differs by") != std::string::npos;
    });
    if (!said) {
      EXPECT_NEAR(1000 * gland->volume_cc / drawn.volume_mm3, 1, 0.03) << seed;
    }
  }
}

/// Rings of one radius at these heights.
Roi tower(std::initializer_list<double> heights, double radius = 12) {
  Roi roi;
  roi.name = "tower";
  for (const double z : heights) roi.contours.push_back(ellipse(0, 0, z, radius, radius, 90));
  return roi;
}

double length_of(const Roi& roi) {
  const StructureSlices slices = structure_slices(roi, "").value();
  return slices.volume_mm3() / slices.slices.front().area_mm2;
}

TEST(StructureVolumes, have_gaps_bridged_by_one_rule_and_named) {
  EXPECT_NEAR(length_of(tower({0, 3, 6, 9, 12, 24, 27, 30})), 33, 1e-6) << "three missing slices";
  EXPECT_NEAR(length_of(tower({0, 1, 2, 3, 4, 7, 10, 13})), 14, 1e-6) << "slices that are wider further up";
  EXPECT_NEAR(length_of(tower({0, 3, 6, 9, 60, 63, 66, 69})), 24, 1e-6) << "two pieces";
  const auto apart = structure_slices(tower({0, 3, 6, 9, 60, 63, 66, 69}), "");
  EXPECT_NE(apart->note.value_or("").find("z = 9.00 to z = 60.00"), std::string::npos) << *apart->note;
  Roi beside = tower({0, 3, 6, 9});
  for (const double z : {21.0, 24.0, 27.0, 30.0}) beside.contours.push_back(ellipse(60, 0, z, 12, 12, 90));
  EXPECT_NEAR(length_of(beside), 24, 1e-6) << "sections that do not overlap";
  EXPECT_NEAR(length_of(tower({0, 10, 20, 30, 40})), 50, 1e-6) << "wide slices";
}

TEST(StructureVolumes, of_planes_written_twice_a_little_apart_count_once) {
  for (const double apart : {0.01, 0.04, 0.1, 0.2}) {
    Roi roi;
    roi.name = "halves";
    for (int k = 0; k < 8; ++k) {
      roi.contours.push_back(ellipse(-20, 0, 3.0 * k, 8, 8, 60));
      roi.contours.push_back(ellipse(20, 0, 3.0 * k + apart, 8, 8, 60));
    }
    const auto slices = test::value_of(structure_slices(roi, ""));
    EXPECT_EQ(slices.slices.size(), 8U) << apart;
    EXPECT_NEAR(slices.volume_mm3(), 24 * 2 * slices.slices[0].area_mm2 / 2, 1e-6 * slices.volume_mm3()) << apart;
    EXPECT_NEAR(slices.slices[0].area_mm2, 2 * std::numbers::pi * 64, 3) << apart;
  }
}

TEST(StructureVolumes, of_thin_walls_and_nested_islands_keep_every_ring) {
  Roi roi;
  roi.name = "wall";
  double area = 0;
  double sign = 1;
  for (const double radius : {20.0, 18.5, 12.0, 11.0, 4.0}) {
    for (int k = 0; k < 6; ++k) roi.contours.push_back(ellipse(0, 0, 2.0 * k, radius, radius, 120));
    area += sign * 60 * radius * radius * std::sin(2 * std::numbers::pi / 120);
    sign = -sign;
  }
  const auto slices = test::value_of(structure_slices(roi, ""));
  EXPECT_NEAR(slices.volume_mm3(), 12 * area, 1e-6 * area);
}

TEST(StructureVolumes, of_a_hole_beside_an_overlapping_part_keep_the_hole) {
  const Geos geos;
  Roi roi;
  roi.name = "gland";
  double area = 0;
  for (int k = 0; k < 5; ++k) {
    const Contour first = ellipse(0, 0, 3.0 * k, 20, 15, 90);
    const Contour second = ellipse(25, 0, 3.0 * k, 15, 12, 90);
    const Contour hole = ellipse(-8, 2, 3.0 * k, 4, 4, 60);
    roi.contours.insert(roi.contours.end(), {hole, second, first});
    area = geos.area(geos.less(geos.both(geos.polygon(first), geos.polygon(second)), geos.polygon(hole)));
  }
  EXPECT_NEAR(structure_slices(roi, "")->volume_mm3(), 15 * area, 1e-4 * 15 * area);
}

TEST(StructureVolumes, of_a_contour_with_a_small_loop_follow_the_even_odd_rule) {
  Roi roi;
  roi.name = "gland";
  for (int k = 0; k < 5; ++k) roi.contours.push_back(ellipse(0, 0, 3.0 * k, 20, 15, 48));
  const double volume = structure_slices(roi, "")->volume_mm3();
  std::swap(roi.contours[2].points[10], roi.contours[2].points[11]);
  const auto slices = test::value_of(structure_slices(roi, ""));
  EXPECT_NEAR(slices.volume_mm3() / volume, 1, 0.005);
  EXPECT_NE(slices.note.value_or("").find("contour 3"), std::string::npos);
}

}  // namespace
}  // namespace stylet
