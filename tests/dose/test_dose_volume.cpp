// SPDX-License-Identifier: GPL-3.0-or-later
// Samples of structures and dose–volume figures against closed forms.
#include "stylet/dose/dose_volume.hpp"
#include "stylet/dose/structure_samples.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace stylet {
namespace {

Contour ring(double radius, double z, const Vec3& centre = Vec3::Zero(), int points = 180) {
  Contour contour;
  for (int k = 0; k < points; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / points;
    contour.points.push_back(centre + Vec3(radius * std::cos(angle), radius * std::sin(angle), z));
  }
  return contour;
}

/// A cylinder of `planes` planes.
Roi cylinder(double radius, int planes, double spacing) {
  Roi roi;
  roi.name = "cylinder";
  for (int k = 0; k < planes; ++k) roi.contours.push_back(ring(radius, k * spacing));
  return roi;
}

/// Area of the polygon of ring().
double ring_area(double radius, int points = 180) {
  return 0.5 * points * radius * radius * std::sin(2.0 * std::numbers::pi / points);
}

TEST(StructureSamples, of_a_cylinder_have_the_volume_of_its_slabs) {
  const auto samples = sample_structure(cylinder(15.0, 11, 3.0), 0.25).value();
  EXPECT_NEAR(samples.volume_cc(), ring_area(15.0) * 33.0 / 1000.0, 2e-3 * samples.volume_cc()) << "caps included";
  double low = 1e9;
  double high = -1e9;
  for (const Vec3& x : samples.points) {
    low = std::min(low, x.z());
    high = std::max(high, x.z());
    ASSERT_LT(x.head<2>().norm(), 15.0);
  }
  EXPECT_NEAR(low, -1.5 + 0.125, 1e-9);
  EXPECT_NEAR(high, 31.5 - 0.125, 1e-9);
}

TEST(StructureSamples, leave_a_hole_out_and_take_islands_in) {
  Roi roi = cylinder(15.0, 6, 2.0);
  for (int k = 0; k < 6; ++k) {
    roi.contours.push_back(ring(6.0, 2.0 * k));
    roi.contours.push_back(ring(2.0, 2.0 * k));
  }
  const double area = ring_area(15.0) - ring_area(6.0) + ring_area(2.0);
  EXPECT_NEAR(sample_structure(roi, 0.2).value().volume_cc(), area * 12.0 / 1000.0, 2e-3 * area * 0.012);
}

TEST(StructureSamples, bridge_one_missing_plane_and_no_wide_gap) {
  Roi missing = cylinder(10.0, 8, 2.0);
  missing.contours.erase(missing.contours.begin() + 4);
  EXPECT_NEAR(sample_structure(missing, 0.25).value().volume_cc(), ring_area(10.0) * 16.0 / 1000.0, 0.02);
  Roi apart = cylinder(10.0, 4, 2.0);
  for (int k = 0; k < 4; ++k) apart.contours.push_back(ring(10.0, 40.0 + 2.0 * k));
  EXPECT_NEAR(sample_structure(apart, 0.25).value().volume_cc(), ring_area(10.0) * 16.0 / 1000.0, 0.02);
}

// The same structure in oblique planes, drawn the other way round, has the same volume and centre.
TEST(StructureSamples, do_not_depend_on_the_direction_of_the_planes) {
  std::mt19937 random(3);
  std::normal_distribution<double> any;
  const Roi straight = cylinder(12.0, 9, 2.5);
  const double volume = sample_structure(straight, 0.3).value().volume_cc();
  for (int k = 0; k < 10; ++k) {
    const Eigen::Quaterniond turn = Eigen::Quaterniond(any(random), any(random), any(random), any(random)).normalized();
    Roi roi = straight;
    for (Contour& contour : roi.contours) {
      for (Vec3& x : contour.points) x = turn * x + Vec3(30, -20, 10);
      if (k % 2 == 1) std::reverse(contour.points.begin(), contour.points.end());
    }
    const auto samples = sample_structure(roi, 0.3).value();
    EXPECT_NEAR(samples.volume_cc() / volume, 1.0, 4e-3);
    Vec3 centre = Vec3::Zero();
    for (const Vec3& x : samples.points) centre += x / static_cast<double>(samples.points.size());
    EXPECT_NEAR((centre - (turn * Vec3(0, 0, 10) + Vec3(30, -20, 10))).norm(), 0.0, 0.05);
  }
}

TEST(StructureSamples, that_cannot_be_made_are_refused_with_the_structures_name) {
  for (const auto& [roi, step] :
       {std::pair(cylinder(10.0, 1, 2.0), 0.5), std::pair(cylinder(10.0, 5, 2.0), 0.0),
        std::pair(cylinder(1000.0, 5, 200.0), 0.5), std::pair(Roi{.name = "cylinder"}, 0.5)}) {
    const auto samples = sample_structure(roi, step);
    ASSERT_FALSE(samples.ok());
    EXPECT_NE(samples.error().message().find("structure 'cylinder'"), std::string::npos);
  }
}

// A dose that falls linearly over equal volumes: every figure can be written down.
TEST(DoseVolume, of_a_linear_dose_is_known) {
  std::vector<double> dose;
  for (int k = 0; k < 1000; ++k) dose.push_back(100.0 - 0.1 * k);  // 100 … 0.1 Gy
  std::shuffle(dose.begin(), dose.end(), std::mt19937(4));
  const std::vector<double> volume(1000, 20.0);  // 20 cc in all
  const DoseVolume dvh(dose, volume);
  EXPECT_NEAR(dvh.volume_cc(), 20.0, 1e-9);
  EXPECT_NEAR(dvh.dose_of_percent(90.0), 10.1, 1e-9) << "900 of 1000 samples have this dose or more";
  EXPECT_NEAR(dvh.dose_of_percent(100.0), 0.1, 1e-9);
  EXPECT_NEAR(dvh.dose_of_volume(2.0), 90.1, 1e-9);
  EXPECT_TRUE(std::isnan(dvh.dose_of_volume(50.0))) << "more than the structure";
  EXPECT_NEAR(dvh.dose_of_volume(dvh.volume_cc()), 0.1, 1e-9) << "all of it";
  EXPECT_NEAR(dvh.percent_above(50.0), 50.1, 1e-9);
  EXPECT_NEAR(dvh.volume_above_cc(75.0), 5.02, 1e-9);
  EXPECT_EQ(dvh.percent_above(101.0), 0.0);
  EXPECT_NEAR(dvh.percent_above(0.0), 100.0, 1e-9);
  EXPECT_NEAR(dvh.mean_Gy(), 50.05, 1e-9);
}

TEST(DoseVolume, counts_samples_by_their_volume) {
  const std::vector<double> dose{10.0, 20.0, 30.0};
  const std::vector<double> volume{6000.0, 3000.0, 1000.0};
  const DoseVolume dvh(dose, volume);
  EXPECT_EQ(dvh.dose_of_percent(10.0), 30.0);
  EXPECT_EQ(dvh.dose_of_percent(40.0), 20.0);
  EXPECT_EQ(dvh.dose_of_percent(40.1), 10.0);
  EXPECT_NEAR(dvh.mean_Gy(), 15.0, 1e-12);
}

}  // namespace
}  // namespace stylet
