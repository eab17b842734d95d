// SPDX-License-Identifier: GPL-3.0-or-later
// Organs of a patient are told apart by their colours, with every colour vision. Sections, 3D views, reports and the
// live page have the colours from region_views().
#include "stylet/io/region_views.hpp"
#include "synthetic_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

using namespace stylet;
using namespace stylet::results;

namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

Colour times(const Matrix& m, const Colour& v) {
  Colour out{};
  for (std::size_t r = 0; r < 3; ++r) out[r] = m[r][0] * v[0] + m[r][1] * v[1] + m[r][2] * v[2];
  return out;
}

/// Vision in linear RGB: of most people, and without one kind of cone. Machado, Oliveira & Fernandes, IEEE TVCG 15
/// (2009) 1291, severity 1.
constexpr std::array<Matrix, 4> kVisions{
    Matrix{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
    Matrix{{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}},
    Matrix{{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}},
    Matrix{{{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}}};

/// CIELAB for the white D65.
Colour lab(const Colour& seen) {
  constexpr Matrix kXyz{{{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}}};
  constexpr Colour kWhite{0.9505, 1.0, 1.089};
  Colour f = times(kXyz, seen);
  for (std::size_t k = 0; k < 3; ++k) {
    const double x = f[k] / kWhite[k];
    f[k] = x > 0.008856 ? std::cbrt(x) : 7.787 * x + 16.0 / 116.0;
  }
  return {116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])};
}

/// The distance of two colours in CIELAB for the vision that tells them apart worst.
double distance(const Colour& a, const Colour& b) {
  const auto linear = [](Colour c) {
    for (double& x : c) x = x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
    return c;
  };
  const auto seen = [&](const Matrix& vision, const Colour& c) {
    Colour out = times(vision, linear(c));
    for (double& x : out) x = std::clamp(x, 0.0, 1.0);
    return lab(out);
  };
  double least = 1e9;
  for (const Matrix& vision : kVisions) {
    const Colour p = seen(vision, a), q = seen(vision, b);
    least = std::min(least, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
  }
  return least;
}

/// The views of a patient with these regions.
std::vector<RegionView> views_of(const std::vector<std::string>& regions) {
  TetMesh mesh = stylet::testing::synthetic_run().mesh;
  mesh.regions = regions;
  for (std::size_t t = 0; t < mesh.tet_region.size(); ++t) mesh.tet_region[t] = static_cast<int>(t % regions.size());
  return region_views(mesh, {});
}

TEST(RegionColours, no_two_organs_of_a_patient_look_alike_with_any_colour_vision) {
  const auto views = views_of({"prostate", "urethra", "bladder", "rectum", "seminal_vesicles", "pubic_arch", "levator",
                               "periprostatic_fat", "ischiorectal_fat", "subcutaneous_fat"});
  ASSERT_EQ(views.size(), 10U);
  for (std::size_t a = 1; a < views.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (views[a].background || views[b].background) continue;  // drawn as a hint of flesh around the organs
      EXPECT_GT(distance(views[a].colour, views[b].colour), 12.0) << views[a].name << " and " << views[b].name;
    }
  }
}

TEST(RegionColours, fat_of_any_name_has_a_shade_of_fat) {
  const auto views = views_of({"bladder", "pelvic_fat", "visceral_fat", "mesorectal_fat"});
  for (std::size_t k = 1; k < views.size(); ++k) {
    EXPECT_GE(views[k].colour[0], views[k].colour[2] + 0.1) << views[k].name << " is not blue";
    for (std::size_t other = 0; other < k; ++other) EXPECT_NE(views[k].colour, views[other].colour);
  }
}

}  // namespace
