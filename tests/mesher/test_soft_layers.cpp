// SPDX-License-Identifier: GPL-3.0-or-later
// Tests the soft layers that contours lack: their places, the structures to which they yield, and the quality of the
// mesh.
#include "made_anatomy.hpp"
#include "mesh_checks.hpp"
#include "stylet/geom/locator.hpp"

namespace stylet {
namespace {

using testing::gland;
using testing::set_of;
using testing::tube;

constexpr Index kNodes = 2500;
constexpr double kFat = 7.0, kMuscle = 5.0, kSkinFat = 9.0, kWall = 4.0;  // [mm]
const Vec3 kCentre(5, -20, 10), kHalf(20, 16, 18);                        // of testing::gland()
constexpr double kRectum = 12.0;                                          // [mm] radius of the rectum
const Vec3 kRectumAxis(5, 15, 0);

MeshOptions with_layers() {
  MeshOptions o;
  o.nodes = kNodes;
  o.layers = {.periprostatic_fat_mm = kFat,
              .levator_mm = kMuscle,
              .ischiorectal_fat_mm = 20,
              .subcutaneous_fat_mm = kSkinFat,
              .rectal_wall_mm = kWall};
  return o;
}

Roi rectum() { return tube("Rectum", kRectumAxis + Vec3(0, 0, -25), 55, kRectum, 3); }

const Result<MeshedAnatomy>& pelvis() {
  static const auto m = mesh_contours(set_of({gland(), rectum()}), with_layers());
  return m;
}

/// Distance [mm] from the gland's ellipsoid to first order, accurate to a millimetre within a layer's thickness.
double from_gland(const Vec3& p) {
  const Vec3 q = (p - kCentre).cwiseQuotient(kHalf);
  const Vec3 gradient = q.cwiseQuotient(kHalf) / q.norm();
  return (q.norm() - 1) / gradient.norm();
}

double from_rectum(const Vec3& p) { return (p - kRectumAxis).head<2>().norm() - kRectum; }

/// Calls `see(centroid, volume)` for each element of a region.
template <class See>
void for_elements(const MeshedAnatomy& m, const std::string& name, See see) {
  const int region = m.mesh.region_index(name);
  for (Index t = 0; t < m.mesh.tet_count(); ++t) {
    if (m.mesh.tet_region[t] != region) continue;
    const auto& n = m.mesh.tets[t];
    const Vec3 &a = m.mesh.nodes[n[0]], &b = m.mesh.nodes[n[1]], &c = m.mesh.nodes[n[2]], &d = m.mesh.nodes[n[3]];
    see(Vec3(0.25 * (a + b + c + d)), (b - a).cross(c - a).dot(d - a) / 6);
  }
}

double volume(const MeshedAnatomy& m, const std::string& name) {
  double sum = 0;
  for_elements(m, name, [&](const Vec3&, double v) { sum += v; });
  return sum;
}

TEST(SoftLayers, all_are_made_and_the_mesh_is_as_good_as_without_them) {
  const auto& m = pelvis();
  ASSERT_TRUE(m.ok()) << m.error().message();
  testing::expect_kept(*m, kNodes);
  for (const char* name : {"periprostatic_fat", "levator", "ischiorectal_fat", "subcutaneous_fat", "rectal_lumen"}) {
    EXPECT_TRUE(testing::has_region(*m, name)) << name;
    EXPECT_GT(volume(*m, name), 500.0) << name;
  }
  EXPECT_TRUE(testing::has_note(*m, "7 mm of fat around the gland")) << "the user is told what was added";
}

TEST(SoftLayers, each_lies_where_it_belongs) {
  const auto& m = pelvis();
  ASSERT_TRUE(m.ok());
  constexpr double kOff = 2.5;  // [mm] because faces are flat and the ellipsoid's distance is of first order
  for_elements(*m, "periprostatic_fat", [&](const Vec3& p, double) {
    EXPECT_GT(from_gland(p), -kOff);
    EXPECT_LT(from_gland(p), kFat + kOff);
  });
  for_elements(*m, "levator", [&](const Vec3& p, double) {
    EXPECT_LT(std::min(from_gland(p) - kFat, from_rectum(p)), kMuscle + kOff);
    EXPECT_LT(p.z(), kCentre.z() + kHalf.z()) << "below the gland's base";
  });
  for_elements(*m, "rectal_lumen", [&](const Vec3& p, double) { EXPECT_LT(from_rectum(p), -kWall + kOff); });
  double skin = HUGE_VAL;
  for (const Vec3& p : m->mesh.nodes) skin = std::min(skin, p.z());
  for_elements(*m, "ischiorectal_fat", [&](const Vec3& p, double) {
    EXPECT_GT(std::abs(p.x() - kRectumAxis.x()), kRectum) << "beside the rectum";
    EXPECT_LT(p.z(), kCentre.z());
  });
  const double middle = volume(*m, "subcutaneous_fat");
  EXPECT_GT(middle, 0);
  for_elements(*m, "subcutaneous_fat", [&](const Vec3& p, double) { EXPECT_LT(p.z(), skin + kSkinFat + 25); });
}

/// The volume of the shell between two ellipsoids, without what neighbours of the gland take of it, which is little
/// here.
TEST(SoftLayers, the_fat_round_the_gland_is_as_thick_as_asked_for) {
  MeshOptions o;
  o.nodes = kNodes;
  o.stiff_band = false;
  o.layers = {};
  o.layers.periprostatic_fat_mm = kFat;
  const auto m = mesh_contours(set_of({gland()}), o);
  ASSERT_TRUE(m.ok()) << m.error().message();
  const double inner = kHalf.prod();
  const double outer = (kHalf + Vec3::Constant(kFat)).prod();
  const double shell = 4.0 / 3.0 * std::numbers::pi * (outer - inner);
  EXPECT_NEAR(volume(*m, "periprostatic_fat") / shell, 1.0, 0.06);
}

/// From the skin inwards along the axis, the first layer is fat of the wanted thickness.
TEST(SoftLayers, the_fat_under_the_skin_is_as_thick_as_asked_for) {
  const auto& m = pelvis();
  ASSERT_TRUE(m.ok());
  const Topology topology(m->mesh);
  const Locator locator(m->mesh, topology);
  const int fat = m->mesh.region_index("subcutaneous_fat");
  double sum = 0;
  int ways = 0;
  for (const double x : {-15.0, 0.0, 10.0, 25.0}) {
    for (const double y : {-35.0, -20.0, -10.0}) {
      int inside = 0;
      for (double z = kCentre.z() - 80; z < kCentre.z(); z += 0.1) {
        const auto at = locator.find(Vec3(x, y, z), 0);
        if (at && m->mesh.tet_region[at->tet] == fat) ++inside;
      }
      // The skin is curved within one of the coarse elements.
      EXPECT_NEAR(0.1 * inside, kSkinFat, 2.5) << x << ", " << y;
      sum += 0.1 * inside;
      ++ways;
    }
  }
  EXPECT_NEAR(sum / ways, kSkinFat, 0.8);
}

TEST(SoftLayers, what_the_input_has_is_not_made) {
  const auto m = mesh_contours(
      set_of({gland(), testing::ellipsoid("Levator ani", kCentre + Vec3(0, 0, -26), {22, 12, 4}, 1.5)}), with_layers());
  ASSERT_TRUE(m.ok()) << m.error().message();
  for_elements(*m, "levator", [&](const Vec3& p, double) { EXPECT_LT(p.z(), kCentre.z() - 18); });
  EXPECT_FALSE(testing::has_note(*m, "of levator muscle"));
  EXPECT_TRUE(testing::has_region(*m, "periprostatic_fat"));
}

TEST(SoftLayers, zero_leaves_a_layer_out) {
  MeshOptions o = with_layers();
  o.layers.levator_mm = 0;
  o.layers.rectal_wall_mm = 0;
  const auto m = mesh_contours(set_of({gland(), rectum()}), o);
  ASSERT_TRUE(m.ok()) << m.error().message();
  EXPECT_FALSE(testing::has_region(*m, "levator"));
  EXPECT_FALSE(testing::has_region(*m, "rectal_lumen"));
  EXPECT_TRUE(testing::has_region(*m, "periprostatic_fat"));
}

TEST(SoftLayers, the_rectum_keeps_its_outer_volume) {
  const auto& m = pelvis();
  ASSERT_TRUE(m.ok());
  constexpr int kCorners = 24, kSlices = 19;  // of testing::tube(), 3 mm apart
  const double area = 0.5 * kCorners * kRectum * kRectum * std::sin(2 * std::numbers::pi / kCorners);
  const double whole = area * kSlices * 3;
  EXPECT_NEAR((volume(*m, "rectum") + volume(*m, "rectal_lumen")) / whole, 1.0, 0.05);
}

TEST(SoftLayers, a_rectum_too_thin_for_a_wall_is_meshed_as_one_and_that_is_said) {
  const auto m =
      mesh_contours(set_of({gland(), tube("Rectum", kRectumAxis + Vec3(0, 0, -25), 55, 5, 3)}), with_layers());
  ASSERT_TRUE(m.ok()) << m.error().message();
  EXPECT_FALSE(testing::has_region(*m, "rectal_lumen"));
  EXPECT_TRUE(testing::has_note(*m, "too thin for a wall"));
}

TEST(SoftLayers, masks_get_them_too) {
  const auto m = mesh_labels(testing::two_zones(), with_layers());
  ASSERT_TRUE(m.ok()) << m.error().message();
  for (const char* name : {"periprostatic_fat", "levator", "ischiorectal_fat", "subcutaneous_fat"})
    EXPECT_TRUE(testing::has_region(*m, name)) << name;
}

TEST(SoftLayers, the_preset_of_the_paper_has_none) {
  MeshOptions o;
  o.preset = MeshPreset::paper;
  const auto m = mesh_contours(set_of({gland()}), o);
  ASSERT_TRUE(m.ok()) << m.error().message();
  EXPECT_FALSE(testing::has_region(*m, "periprostatic_fat"));
  EXPECT_FALSE(testing::has_region(*m, "subcutaneous_fat"));
}

}  // namespace
}  // namespace stylet
