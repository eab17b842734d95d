// SPDX-License-Identifier: GPL-3.0-or-later
// The shadows of bodies whose transmission is known exactly.
#include "stylet/geom/box_mesh.hpp"
#include "stylet/geom/locator.hpp"
#include "stylet/imaging/fluoroscope.hpp"
#include "stylet/imaging/xray_materials.hpp"
#include "support/count_allocations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

namespace stylet {
namespace {

using test::AllocationCount;

/// Settings without noise.
FluoroscopySettings quiet() {
  FluoroscopySettings settings;
  settings.photons = 0;
  settings.pixels = 256;
  return settings;
}

std::unique_ptr<Fluoroscope> unit_for(const TetMesh& mesh, const FluoroscopySettings& settings) {
  auto made = Fluoroscope::create(mesh, settings);
  if (!made) throw std::runtime_error(made.error().message());
  return std::move(*made);
}

double transmission_at(const Fluoroscope& unit, int column, int row) {
  const int pixels = unit.geometry().pixels;
  return unit.transmission()[static_cast<std::size_t>(row) * static_cast<std::size_t>(pixels) +
                             static_cast<std::size_t>(column)];
}

TetMesh named(TetMesh mesh, const std::string& region) {
  mesh.regions = {region};
  return mesh;
}

/// The length of a ray between two planes at right angles to the central ray, `depth_mm` apart.
double slanted(const Fluoroscope& unit, int column, int row, double depth_mm) {
  return depth_mm * unit.geometry().ray(column, row).norm();
}

/// A ball: tetrahedra from its centre to a sphere of triangles, made by dividing an octahedron.
TetMesh ball_mesh(double radius, int divisions) {
  TetMesh mesh;
  mesh.regions = {"prostate"};
  mesh.nodes = {Vec3::Zero(),   Vec3::UnitX(),  Vec3::UnitY(), Vec3::UnitZ(),
                -Vec3::UnitX(), -Vec3::UnitY(), -Vec3::UnitZ()};
  std::vector<std::array<Index, 3>> faces{{1, 2, 3}, {2, 4, 3}, {4, 5, 3}, {5, 1, 3},
                                          {2, 1, 6}, {4, 2, 6}, {5, 4, 6}, {1, 5, 6}};
  for (int division = 0; division < divisions; ++division) {
    std::map<std::pair<Index, Index>, Index> middles;
    const auto middle = [&](Index a, Index b) {
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<Index>(mesh.nodes.size()));
      if (is_new)
        mesh.nodes.push_back(
            (mesh.nodes[static_cast<std::size_t>(a)] + mesh.nodes[static_cast<std::size_t>(b)]).normalized());
      return at->second;
    };
    std::vector<std::array<Index, 3>> finer;
    for (const auto& [a, b, c] : faces) {
      const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    faces = std::move(finer);
  }
  for (Vec3& node : mesh.nodes) node *= radius;
  for (const auto& [a, b, c] : faces) {
    mesh.tets.push_back({0, a, b, c});
    mesh.tet_region.push_back(0);
  }
  return mesh;
}

/// The column at which a row's transmission crosses a value, seen from the left side.
double edge_column(const Fluoroscope& unit, int row, double level) {
  for (int column = 1; column < unit.geometry().pixels; ++column) {
    const double before = transmission_at(unit, column - 1, row);
    const double here = transmission_at(unit, column, row);
    if ((before > level) != (here > level)) return column - 1 + (before - level) / (before - here);
  }
  return -1.0;
}

TEST(Fluoroscope, a_slab_transmits_exactly) {
  const TetMesh mesh = named(box_mesh({-200, -40, -200}, {200, 40, 200}, {5, 3, 4}, 0.15), "prostate");
  const auto unit = unit_for(mesh, quiet());
  unit->expose(moment_at_rest(mesh));
  const double per_mm = attenuation_per_mm(XrayMaterial::soft_tissue, 60.0);
  for (int row = 0; row < 256; row += 5) {
    for (int column = 0; column < 256; column += 3) {
      const double exact = std::exp(-per_mm * slanted(*unit, column, row, 80.0));
      ASSERT_NEAR(transmission_at(*unit, column, row) / exact, 1.0, 1e-4) << column << ' ' << row;
    }
  }
}

TEST(Fluoroscope, slabs_of_several_materials_add_up) {
  TetMesh mesh = box_mesh({-200, -40, -200}, {200, 40, 200}, {4, 8, 4}, 0.0);
  assign_regions(mesh, {"prostate", "bladder", "ischiorectal_fat"}, [](const Vec3& x) {
    return x.y() < -20 ? 0 : x.y() < 10 ? 1 : 2;
  });
  const auto unit = unit_for(mesh, quiet());
  unit->expose(moment_at_rest(mesh));
  const double sum = 20.0 * attenuation_per_mm(XrayMaterial::soft_tissue, 60.0) + 30.0 * contrast_per_mm(20.0, 60.0) +
                     30.0 * attenuation_per_mm(XrayMaterial::fat, 60.0);
  for (int k = 0; k < 256; k += 7) {
    const double exact = std::exp(-sum * slanted(*unit, k, 255 - k, 1.0));
    ASSERT_NEAR(transmission_at(*unit, k, 255 - k) / exact, 1.0, 1e-4) << k;
  }
}

TEST(Fluoroscope, a_bone_adds_its_cortex) {
  const TetMesh mesh = named(box_mesh({-200, -10, -200}, {200, 10, 200}, {4, 2, 4}, 0.0), "pubic_arch");
  const auto unit = unit_for(mesh, quiet());
  unit->expose(moment_at_rest(mesh));
  const double bone = (20.0 - 2.0 * kCortex_mm) * spongy_bone_per_mm(60.0) +
                      2.0 * kCortex_mm * attenuation_per_mm(XrayMaterial::cortical_bone, 60.0);
  const double exact = std::exp(-bone * slanted(*unit, 100, 140, 1.0));
  EXPECT_NEAR(transmission_at(*unit, 100, 140) / exact, 1.0, 1e-4);
}

TEST(Fluoroscope, a_ball_transmits_within_half_a_percent) {
  constexpr double radius = 30.0;
  const TetMesh mesh = ball_mesh(radius, 6);
  FluoroscopySettings settings = quiet();
  settings.field_mm = 80.0;
  const auto unit = unit_for(mesh, settings);
  unit->expose(moment_at_rest(mesh));
  const double per_mm = attenuation_per_mm(XrayMaterial::soft_tissue, 60.0);
  const Vec3 source = unit->geometry().source_mm();
  int inside = 0;
  for (int row = 0; row < 256; ++row) {
    for (int column = 0; column < 256; ++column) {
      const Vec3 ray = unit->geometry().ray(column, row).normalized();
      const double beside = (source - source.dot(ray) * ray).norm();
      if (std::abs(beside - radius) < 0.1) continue;  // there the polyhedron ends
      const double chord = beside < radius ? 2.0 * std::sqrt(radius * radius - beside * beside) : 0.0;
      inside += chord > 0.0;
      ASSERT_NEAR(transmission_at(*unit, column, row) / std::exp(-per_mm * chord), 1.0, 0.005) << column << ' ' << row;
    }
  }
  EXPECT_GT(inside, 20000);
}

/// Regions without order, nodes without order: the sum over faces is compared with steps along rays.
TEST(Fluoroscope, any_mesh_transmits_as_steps_along_its_rays_do) {
  TetMesh mesh = box_mesh({-60, -50, -40}, {60, 50, 40}, {9, 8, 7}, 0.15);
  assign_regions(mesh, {"prostate", "bladder", "subcutaneous_fat"}, [](const Vec3& x) {
    return static_cast<int>(std::abs(std::lround(0.9 * x.x() + 1.3 * x.y() - 0.7 * x.z()))) % 3;
  });
  FluoroscopySettings settings = quiet();
  settings.angle_deg = 25.0;
  settings.cranial_deg = -10.0;
  const auto unit = unit_for(mesh, settings);
  unit->expose(moment_at_rest(mesh));
  const Topology topology(mesh);
  const Locator locator(mesh, topology);
  const Vec3 source = unit->geometry().source_mm();
  constexpr double step = 0.02;
  for (int k = 0; k < 40; ++k) {
    const int column = 40 + (k * 37) % 180;
    const int row = 60 + (k * 53) % 130;
    const Vec3 ray = unit->geometry().ray(column, row).normalized();
    double sum = 0.0;
    Index hint = -1;
    for (double way = 500.0; way < 800.0; way += step) {
      const auto at = locator.find(source + way * ray, hint);
      if (!at) continue;
      hint = at->tet;
      const auto region = static_cast<std::size_t>(mesh.tet_region[static_cast<std::size_t>(at->tet)]);
      sum += step * region_attenuation_per_mm(mesh.regions[region], settings);
    }
    EXPECT_NEAR(transmission_at(*unit, column, row) / std::exp(-sum), 1.0, 0.005) << column << ' ' << row;
  }
}

TEST(Fluoroscope, a_turned_scene_seen_by_the_turned_c_arm_is_the_same_picture) {
  const TetMesh mesh = [] {
    TetMesh box = box_mesh({-50, -40, -30}, {50, 40, 30}, {6, 5, 4}, 0.1);
    assign_regions(box, {"body", "pubic_arch", "bladder"}, [](const Vec3& x) {
      return x.x() > 20 ? 1 : x.z() > 8 ? 2 : 0;
    });
    return box;
  }();
  Moment moment = moment_at_rest(mesh);
  moment.needles.push_back({.centreline_mm = {{-5, 5, -90}, {-4, 6, -20}, {0, 5, 20}}});
  moment.seeds.push_back({.centre_mm = {10, -3, 5}, .axis = Vec3(1, 2, 3).normalized()});
  FluoroscopySettings settings = quiet();
  const auto at_0 = unit_for(mesh, settings);
  at_0->expose(moment);

  settings.angle_deg = 35.0;
  settings.cranial_deg = 12.0;
  const XrayGeometry turned_unit = xray_geometry(settings, Vec3::Zero());
  Mat3 from, to;
  from << at_0->geometry().right, at_0->geometry().up, at_0->geometry().towards;
  to << turned_unit.right, turned_unit.up, turned_unit.towards;
  const Mat3 turn = to * from.transpose();
  TetMesh turned_mesh = mesh;
  for (Vec3& x : turned_mesh.nodes) x = turn * x;
  Moment turned = moment;
  for (Vec3& x : turned.needles[0].centreline_mm) x = turn * x;
  turned.seeds[0].centre_mm = turn * moment.seeds[0].centre_mm;
  turned.seeds[0].axis = turn * moment.seeds[0].axis;
  const auto at_35 = unit_for(turned_mesh, settings);
  at_35->expose(turned);

  double darkest = 1.0;
  int differ = 0;
  for (std::size_t k = 0; k < at_0->transmission().size(); ++k) {
    const double before = at_0->transmission()[k];
    darkest = std::min(darkest, before);
    differ += std::abs(at_35->transmission()[k] / before - 1.0) > 1e-3;
  }
  EXPECT_LT(darkest, 0.1);
  // Rays on the very edge of a face may fall on its other side by rounding.
  EXPECT_LE(differ, 5);
}

TEST(Fluoroscope, the_detector_goes_where_the_angles_say) {
  FluoroscopySettings settings;
  EXPECT_TRUE(xray_geometry(settings, Vec3::Zero()).towards.isApprox(-Vec3::UnitY())) << "anterior";
  settings.angle_deg = 90.0;
  EXPECT_TRUE(xray_geometry(settings, Vec3::Zero()).towards.isApprox(Vec3::UnitX())) << "the patient's left";
  settings.angle_deg = 0.0;
  settings.cranial_deg = 30.0;
  EXPECT_NEAR(xray_geometry(settings, Vec3::Zero()).towards.z(), 0.5, 1e-12);
  const XrayGeometry unit = xray_geometry(settings, Vec3(1, 2, 3));
  const auto left = unit.place(Vec3(11, 2, 3));
  EXPECT_NEAR((left.column - unit.middle()) * unit.pixel_mm, 10.0, 1e-9);
  EXPECT_NEAR(left.row, unit.middle(), 1e-9);
  EXPECT_LT(unit.place(Vec3(1, 2, 13)).row, unit.middle()) << "superior is up";
}

TEST(Fluoroscope, a_boundary_that_moves_moves_its_shadow) {
  TetMesh mesh = box_mesh({-40, -2, -40}, {40, 2, 40}, {8, 1, 8}, 0.0);
  assign_regions(mesh, {"ischiorectal_fat", "bladder"}, [](const Vec3& x) { return x.x() > 0 ? 1 : 0; });
  FluoroscopySettings settings = quiet();
  settings.bladder_iodine_mg_per_ml = 300.0;
  settings.field_mm = 60.0;
  const auto unit = unit_for(mesh, settings);
  Moment moment = moment_at_rest(mesh);
  unit->expose(moment);
  constexpr int row = 120;
  const double level = 0.7;
  const double before = edge_column(*unit, row, level);
  EXPECT_NEAR(before, unit->geometry().place({0, 0, 0}).column, 1.0);
  for (Index node = 0; node < mesh.node_count(); ++node) {
    if (std::abs(mesh.nodes[static_cast<std::size_t>(node)].x()) < 1.0) moment.displacement.col(node) << 4.0F, 0, 1.0F;
  }
  unit->expose(moment);
  const double moved = edge_column(*unit, row, level) - before;
  EXPECT_NEAR(moved * unit->geometry().pixel_mm, 4.0, unit->geometry().pixel_mm);
}

/// Pictures of metal alone: the patient, whom a fluoroscope needs, is a small slab beside the picture.
struct Metal : testing::Test {
  Metal() { settings.field_mm = 20.0; }
  TetMesh mesh = named(box_mesh({-300, -1, -300}, {-250, 1, -250}, {1, 1, 1}, 0.0), "body");
  FluoroscopySettings settings = quiet();

  std::unique_ptr<Fluoroscope> exposed(const Moment& moment) const {
    auto unit = unit_for(mesh, settings);
    unit->expose(moment);
    return unit;
  }
  Vec3 centre() const { return unit_for(mesh, settings)->geometry().centre_mm; }
  /// A moment with nothing but metal, about the centre of the picture, and the slab out of sight.
  Moment nothing() const {
    Moment moment = moment_at_rest(mesh);
    moment.displacement.row(0).setConstant(-200.0F);
    return moment;
  }
};

TEST_F(Metal, a_needle_darkens_by_the_thickness_of_its_wall) {
  Moment moment = nothing();
  const Vec3 c = centre();
  moment.needles.push_back({.centreline_mm = {c - Vec3(0, 0, 30), c + Vec3(0.1, 0, 0), c + Vec3(0.1, 0, 30)},
                            .diameter_mm = 1.27,
                            .lumen_diameter_mm = 1.0});
  const auto unit = exposed(moment);
  const double steel = attenuation_per_mm(XrayMaterial::iron, 60.0);
  const int row = 60;  // superior of the bend
  const double column = unit->geometry().place(c + Vec3(0.1, 0, 0)).column;
  EXPECT_NEAR(transmission_at(*unit, static_cast<int>(std::lround(column)), row), std::exp(-steel * 0.27), 0.005);
  // The whole width: the section of the wall, whatever the size of a pixel.
  for (const double field : {20.0, 100.0}) {
    settings.field_mm = field;
    const auto wide = exposed(moment);
    double sum = 0.0;
    for (int k = 0; k < 256; ++k) sum -= std::log(transmission_at(*wide, k, 100)) * wide->geometry().pixel_mm;
    EXPECT_NEAR(sum, steel * std::numbers::pi / 4.0 * (1.27 * 1.27 - 1.0), 0.02 * sum) << field;
  }
}

TEST_F(Metal, a_bent_needle_is_nowhere_darker_than_its_pieces) {
  Moment moment = nothing();
  const Vec3 c = centre();
  const std::vector<Vec3> bent{c - Vec3(2, 0, 30), c, c + Vec3(-2, 0, 30)};
  moment.needles.push_back({.centreline_mm = bent, .diameter_mm = 1.27, .lumen_diameter_mm = 0.0});
  const auto unit = exposed(moment);
  double darkest = 1.0;
  for (int row = 0; row < 256; ++row) {
    double in_row = 1.0;
    for (int column = 0; column < 256; ++column) in_row = std::min(in_row, transmission_at(*unit, column, row));
    darkest = std::min(darkest, in_row);
    EXPECT_LT(in_row, std::exp(-0.95 * 1.27 * attenuation_per_mm(XrayMaterial::iron, 60.0))) << "a gap at " << row;
  }
  EXPECT_GT(darkest, std::exp(-1.01 * 1.27 * attenuation_per_mm(XrayMaterial::iron, 60.0)));
}

TEST_F(Metal, a_seed_darkens_by_its_capsule_and_its_core) {
  settings.energy_keV = 100.0;
  Moment moment = nothing();
  moment.seeds.push_back({.centre_mm = centre(), .axis = Vec3::UnitZ(), .length_mm = 4.5, .diameter_mm = 0.8});
  const double titanium = attenuation_per_mm(XrayMaterial::titanium, 100.0);
  const double silver = attenuation_per_mm(XrayMaterial::silver, 100.0);
  settings.field_mm = 5.12;  // 0.02 mm a pixel
  const auto across = exposed(moment);
  EXPECT_NEAR(transmission_at(*across, 128, 128), std::exp(-titanium * 0.1 - silver * 0.5), 0.005);
  // 1.8 mm from the middle there is the capsule alone.
  EXPECT_NEAR(transmission_at(*across, 128, 128 - 90), std::exp(-titanium * 0.1), 0.005);
  EXPECT_EQ(transmission_at(*across, 128, 128 - 118), 1.0) << "beyond its end of 2.25 mm";

  moment.seeds[0].axis = Vec3::UnitY();
  settings.energy_keV = 150.0;
  const auto along = exposed(moment);
  const double through = -std::log(transmission_at(*along, 128, 128));
  const double exact =
      attenuation_per_mm(XrayMaterial::titanium, 150.0) * 0.1 + attenuation_per_mm(XrayMaterial::silver, 150.0) * 3.0;
  EXPECT_NEAR(through, exact, 0.01 * exact);
}

TEST_F(Metal, what_is_beside_the_picture_darkens_nothing) {
  Moment moment = nothing();
  const Vec3 c = centre();
  moment.seeds.push_back({.centre_mm = c + Vec3(50, 0, 0)});
  moment.seeds.push_back({.centre_mm = c + Vec3(-500, 0, 900)});
  moment.needles.push_back({.centreline_mm = {c + Vec3(80, 0, -100), c + Vec3(80, 0, 100)}});
  moment.needles.push_back({.centreline_mm = {c + Vec3(3, 0, 0), c + Vec3(3, 0, 0), c + Vec3(3, 0, 0)}});
  const auto unit = exposed(moment);
  for (const float share : unit->transmission()) ASSERT_EQ(share, 1.0F);
}

/// A urethra of 10 mm × 10 mm with a bladder at its upper end.
TetMesh urinary_tract() {
  TetMesh mesh = box_mesh({-30, -30, -40}, {30, 30, 60}, {12, 12, 20}, 0.0);
  assign_regions(mesh, {"prostate", "urethra", "bladder"}, [](const Vec3& x) {
    if (x.z() > 10) return 2;
    return std::abs(x.x()) < 10 && std::abs(x.y()) < 10 ? 1 : 0;
  });
  return mesh;
}

TEST(Fluoroscope, the_catheter_and_its_balloon_follow_the_urethra) {
  const TetMesh mesh = urinary_tract();
  FluoroscopySettings with = quiet();
  with.field_mm = 100.0;
  FluoroscopySettings without = with;
  without.catheter = false;
  Moment moment = moment_at_rest(mesh);
  for (const float shift : {0.0F, 6.0F}) {
    moment.displacement.row(0).setConstant(shift);
    const auto a = unit_for(mesh, with);
    const auto b = unit_for(mesh, without);
    a->expose(moment);
    b->expose(moment);
    const auto added = [&](const Vec3& x) {
      const auto place = a->geometry().place(x);
      const int column = static_cast<int>(std::lround(place.column));
      const int row = static_cast<int>(std::lround(place.row));
      return -std::log(transmission_at(*a, column, row) / transmission_at(*b, column, row));
    };
    const double contrast = contrast_per_mm(100.0, 60.0);
    const double in_urethra = 2.7 * (contrast - attenuation_per_mm(XrayMaterial::soft_tissue, 60.0));
    EXPECT_NEAR(added({shift, 0, -10}), in_urethra, 0.05 * in_urethra) << shift;
    EXPECT_NEAR(added({shift + 8.0, 0, -10}), 0.0, 1e-5) << shift;
    const double in_balloon = 21.2 * (contrast_per_mm(50.0, 60.0) - contrast_per_mm(20.0, 60.0));
    EXPECT_NEAR(added({shift, 0, 20.6}), in_balloon, 0.02 * in_balloon) << shift;
  }
}

TEST(Fluoroscope, noise_is_that_of_the_photons) {
  const TetMesh mesh = named(box_mesh({-200, -60, -200}, {200, 60, 200}, {2, 2, 2}, 0.0), "prostate");
  FluoroscopySettings settings = quiet();
  settings.field_mm = 20.0;
  settings.photons = 20000;
  const auto unit = unit_for(mesh, settings);
  unit->expose(moment_at_rest(mesh));
  // The rays of such a small field pass nearly the same tissue. Pixels two apart share nothing by the blur.
  double sum = 0.0, square = 0.0, neighbours = 0.0;
  int count = 0;
  const auto seen = unit->optical_depth();
  const double mean_depth = -std::log(transmission_at(*unit, 128, 128));
  for (std::size_t row = 1; row + 1 < 256; ++row) {
    for (std::size_t column = 1; column + 1 < 256; ++column) {
      const double off = seen[row * 256 + column] + std::log(unit->transmission()[row * 256 + column]);
      sum += off;
      square += off * off;
      neighbours += off * (seen[row * 256 + column + 1] + std::log(unit->transmission()[row * 256 + column + 1]));
      ++count;
    }
  }
  const double photons = 20000.0 * std::exp(-mean_depth);
  constexpr double side = 0.15, centre = 0.7;
  constexpr double kept = (centre * centre + 2 * side * side) * (centre * centre + 2 * side * side);
  EXPECT_NEAR(square / count, kept / photons, 0.05 * kept / photons);
  EXPECT_NEAR(sum / count, 0.0, 0.1 / std::sqrt(photons)) << "the mean is kept";
  EXPECT_NEAR(neighbours / square, 2 * side * centre / (centre * centre + 2 * side * side), 0.03) << "slight blur";
}

TEST(Fluoroscope, the_same_seed_gives_the_same_bits_and_another_one_another_noise) {
  const TetMesh mesh = urinary_tract();
  FluoroscopySettings settings;
  settings.pixels = 128;
  Moment moment = moment_at_rest(mesh);
  moment.seeds.push_back({.centre_mm = {12, 0, -10}});
  const auto one = unit_for(mesh, settings);
  const std::vector<std::uint8_t> first = one->expose(moment).pixels;
  EXPECT_EQ(one->expose(moment).pixels, first);
  EXPECT_EQ(unit_for(mesh, settings)->expose(moment).pixels, first);
  Moment later = moment;
  later.time_s = 0.04;
  EXPECT_NE(one->expose(later).pixels, first) << "the next picture has another noise";
  settings.random = 2;
  const auto other = unit_for(mesh, settings);
  EXPECT_NE(other->expose(moment).pixels, first);
  one->expose(moment);
  EXPECT_TRUE(std::equal(one->transmission().begin(), one->transmission().end(), other->transmission().begin()));
}

TEST(Fluoroscope, an_exposure_does_not_allocate) {
  if (!AllocationCount::available()) GTEST_SKIP() << "not with a sanitizer";
  const TetMesh mesh = urinary_tract();
  const auto unit = unit_for(mesh, {});
  Moment moment = moment_at_rest(mesh);
  moment.seeds.push_back({.centre_mm = {12, 0, -10}});
  moment.needles.push_back({.centreline_mm = {{15, 5, -90}, {14, 5, -20}, {13, 5, 0}}});
  unit->expose(moment);
  const AllocationCount allocations;
  unit->expose(moment);
  EXPECT_EQ(allocations.count(), 0);
}

TEST(Fluoroscope, dense_is_dark) {
  const TetMesh mesh = urinary_tract();
  FluoroscopySettings settings = quiet();
  settings.field_mm = 140.0;
  const auto unit = unit_for(mesh, settings);
  const GreyPicture& picture = unit->expose(moment_at_rest(mesh));
  ASSERT_EQ(picture.pixels.size(), 256U * 256U);
  const auto at = [&](const Vec3& x) {
    const auto place = unit->geometry().place(x);
    return picture.pixels.at(static_cast<std::size_t>(std::lround(place.row)) * 256 +
                             static_cast<std::size_t>(std::lround(place.column)));
  };
  EXPECT_EQ(at({45, 0, 0}), 255) << "air";
  EXPECT_LT(at({20, 0, 40}), at({20, 0, -10})) << "contrast in the bladder";
  EXPECT_LT(at({0, 0, 20}), at({20, 0, 40})) << "more contrast in the balloon";
}

TEST(Fluoroscope, the_picture_knows_its_place_in_the_patient) {
  const TetMesh mesh = urinary_tract();
  FluoroscopySettings settings = quiet();
  settings.angle_deg = -20.0;
  const auto unit = unit_for(mesh, settings);
  const GreyPicture& picture = unit->expose(moment_at_rest(mesh));
  const XrayGeometry& geometry = unit->geometry();
  for (const auto& [column, row] : {std::pair{0.0, 0.0}, std::pair{255.0, 0.0}, std::pair{17.0, 200.0}}) {
    const auto place = geometry.place(picture.point_mm(column, row));
    EXPECT_NEAR(place.column, column, 1e-9);
    EXPECT_NEAR(place.row, row, 1e-9);
    EXPECT_NEAR(place.depth_mm, geometry.source_distance_mm, 1e-9);
  }
}

TEST(Fluoroscope, two_energies_make_soft_tissue_vanish_and_leave_bone) {
  TetMesh mesh = box_mesh({-200, -40, -200}, {200, 40, 200}, {20, 4, 4}, 0.0);
  assign_regions(mesh, {"prostate", "pubic_arch"},
                 [](const Vec3& x) { return x.x() > 20 && std::abs(x.y()) < 20 ? 1 : 0; });
  FluoroscopySettings settings = quiet();
  settings.energy_keV = 50.0;
  const auto low = unit_for(mesh, settings);
  settings.energy_keV = 110.0;
  const auto high = unit_for(mesh, settings);
  low->expose(moment_at_rest(mesh));
  high->expose(moment_at_rest(mesh));
  const auto left = without_soft_tissue(*low, *high);
  ASSERT_TRUE(left) << left.error().message();
  const auto value = [&](int column, int row) { return left->pixels[static_cast<std::size_t>(row) * 256 + column]; };
  EXPECT_NEAR(value(10, 10), value(120, 128), 2) << "soft tissue has one grey, though the rays are longer outside";
  EXPECT_LT(value(220, 128) + 100, value(100, 128)) << "bone is darker";
  EXPECT_FALSE(without_soft_tissue(*high, *low));
  settings.angle_deg = 5.0;
  EXPECT_FALSE(without_soft_tissue(*low, *unit_for(mesh, settings)));
}

TEST(Fluoroscope, a_source_or_detector_in_the_patient_is_refused) {
  const TetMesh mesh = named(box_mesh({-100, -100, -100}, {100, 100, 100}, {2, 2, 2}, 0.0), "body");
  FluoroscopySettings settings;
  settings.detector_mm = 80.0;
  const auto detector = Fluoroscope::create(mesh, settings);
  ASSERT_FALSE(detector);
  EXPECT_EQ(detector.error().where, "fluoroscopy.detector_mm");
  EXPECT_NE(detector.error().cure.find("120"), std::string::npos) << detector.error().message();
  settings.detector_mm = 420.0;
  settings.source_mm = 500.0;
  const auto source = Fluoroscope::create(mesh, settings);
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().where, "fluoroscopy.source_mm");
  EXPECT_NE(source.error().cure.find("540"), std::string::npos) << source.error().message();
}

}  // namespace
}  // namespace stylet
