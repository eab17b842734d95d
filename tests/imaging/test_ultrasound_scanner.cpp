// SPDX-License-Identifier: GPL-3.0-or-later
// Places in the picture, and what a scan may not do.
#include "imaged_block.hpp"
#include "support/count_allocations.hpp"

#include "stylet/geom/locator.hpp"
#include "stylet/imaging/scan_conversion.hpp"
#include "stylet/probe/probe_place.hpp"

#include <algorithm>

namespace stylet {
namespace {

using test::block_beams;
using test::imaged_block;
using test::kLevel;
using test::plain_scanner;

TEST(UltrasoundPicture, shows_twenty_points_of_deformed_tissue_where_the_mesh_has_them) {
  const TetMesh mesh = imaged_block();
  const UltrasoundSettings settings;
  UltrasoundScanner scanner = plain_scanner(mesh, {{0.0, kLevel}}, settings);
  Moment moment = moment_at_rest(mesh);
  for (Index node = 0; node < mesh.node_count(); ++node) {
    const Vec3& x = mesh.nodes[static_cast<std::size_t>(node)];
    moment.displacement.col(node) = Eigen::Vector3f(static_cast<float>(2.0 * std::sin(x.y() / 15.0)),
                                                    static_cast<float>(3.0 * std::cos(x.x() / 20.0)),
                                                    static_cast<float>(1.5 * std::sin(x.x() / 12.0)));
  }
  for (const bool sector : {false, true}) {
    const UltrasoundBeams beams = block_beams(settings, sector);
    scanner.scan(moment, beams);
    for (int k = 0; k < 20; ++k) {
      const int line = 30 + 10 * k, sample = 60 + 20 * k;
      const Vec3 material = scanner.material_mm(line, sample);
      // Where the mesh has this material now, by interpolation in the element of the undeformed mesh.
      const Topology topology(mesh);
      const Locator locator(mesh, topology);
      const auto at = locator.find(material);
      ASSERT_TRUE(at.has_value());
      Vec3 now = material;
      for (std::size_t c = 0; c < 4; ++c)
        now += at->weights[static_cast<Eigen::Index>(c)] *
               moment.displacement.col(mesh.tets[static_cast<std::size_t>(at->tet)][c]).cast<double>();
      EXPECT_LT((now - beams.point_mm(line, sample * beams.sample_mm)).norm(), 0.01);
    }
  }
}

TEST(UltrasoundPicture, of_a_tuned_scanner_is_that_of_a_new_one) {
  const TetMesh mesh = imaged_block({"periprostatic_fat", "prostate"},
                                    [](const Vec3& x) { return (x - Vec3(0, 35, 0)).norm() < 20 ? 1 : 0; });
  const std::vector<TissueEcho> echoes{default_echo("periprostatic_fat"), default_echo("prostate")};
  auto scanner = UltrasoundScanner::create(mesh, echoes, {});
  ASSERT_TRUE(scanner.ok());
  UltrasoundSettings other;
  other.depth_mm = 50.0;
  other.focus_mm = 40.0;
  other.lines = 100;
  for (const int random : {other.random, other.random + 1}) {
    other.random = random;
    auto tuned = scanner->tuned(other);
    auto fresh = UltrasoundScanner::create(mesh, echoes, other);
    ASSERT_TRUE(tuned.ok() && fresh.ok());
    const UltrasoundBeams beams = block_beams(other, true);
    const Moment moment = moment_at_rest(mesh);
    const auto a = tuned->scan(moment, beams).grey, b = fresh->scan(moment, beams).grey;
    EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
  }
  other.samples = 1;
  EXPECT_FALSE(scanner->tuned(other).ok());
}

TEST(UltrasoundPicture, is_made_without_allocation) {
  if (!test::AllocationCount::available()) GTEST_SKIP() << "allocations cannot be counted here";
  const TetMesh mesh = imaged_block({"periprostatic_fat", "prostate"},
                                    [](const Vec3& x) { return (x - Vec3(0, 35, 0)).norm() < 20 ? 1 : 0; });
  auto scanner = UltrasoundScanner::create(
      mesh, std::vector<TissueEcho>{default_echo("periprostatic_fat"), default_echo("prostate")}, {});
  ASSERT_TRUE(scanner.ok());
  Moment moment = moment_at_rest(mesh);
  moment.needles.push_back({{{0, 30, -30}, {1, 32, 20}}, 1.27});
  moment.seeds.push_back({{5, 30, 0}, Vec3::UnitZ(), 4.5, 0.8});
  moment.tracks.push_back({{{-5, 30, -20}, {-5, 30, 20}}, 1.27});
  moment.forces.push_back({{0, 30, 0}, {0, 0, 1}, Vec3::UnitZ(), 4.0, 1.05, 0.005, 0.49});
  const UltrasoundBeams sector = block_beams({}, true), linear = block_beams({}, false);
  scanner->scan(moment, sector);
  const test::AllocationCount count;
  scanner->scan(moment, linear);
  scanner->scan(moment, sector);
  EXPECT_EQ(count.count(), 0);
}

TEST(UltrasoundPicture, of_inputs_that_do_not_fit_is_refused) {
  const TetMesh mesh = imaged_block();
  const auto refused = [&](const std::vector<TissueEcho>& echoes, const UltrasoundSettings& settings) {
    const auto scanner = UltrasoundScanner::create(mesh, echoes, settings);
    EXPECT_FALSE(scanner.ok());
    return scanner ? std::string() : scanner.error().message();
  };
  EXPECT_NE(refused({}, {}).find("0 echoes"), std::string::npos);
  UltrasoundSettings settings;
  settings.lines = 1;
  EXPECT_NE(refused({{}}, settings).find("1 lines"), std::string::npos);
}

TEST(UltrasoundPicture, of_a_place_outside_of_the_patient_is_black) {
  const TetMesh mesh = imaged_block();
  UltrasoundScanner scanner = plain_scanner(mesh, {{0.0, kLevel}});
  UltrasoundBeams beams = block_beams({});
  beams.origin_mm.z() = 500.0;
  const PolarPicture picture = scanner.scan(moment_at_rest(mesh), beams);
  for (const std::uint8_t grey : picture.grey) ASSERT_EQ(grey, 0);
  EXPECT_FALSE(scanner.material_mm(3, 3).allFinite());
}

TEST(UltrasoundAnatomy, has_a_transition_zone_that_is_darker_than_the_peripheral_zone) {
  // A gland of one region: the zone is assumed.
  const TetMesh mesh = imaged_block({"periprostatic_fat", "prostate"},
                                    [](const Vec3& x) { return (x - Vec3(0, 35, 0)).norm() < 22 ? 1 : 0; });
  auto scanner = UltrasoundScanner::create(mesh, std::vector<TissueEcho>{{2.0, kLevel}, {0.0, kLevel}}, {},
                                           {.anatomy = true, .artefacts = false});
  ASSERT_TRUE(scanner.ok());
  UltrasoundBeams beams = block_beams({});
  // Posterior is +y: look from behind, as the probe does.
  beams.origin_mm = {0, 100, 0.3};
  beams.ahead = -Vec3::UnitY();
  scanner->scan(moment_at_rest(mesh), beams);
  const double peripheral = test::mean_dB(*scanner, 118, 138, 45.0, 50.0, beams.sample_mm);
  const double transition = test::mean_dB(*scanner, 105, 150, 64.0, 74.0, beams.sample_mm);
  EXPECT_LT(transition, peripheral - 3.0);
}

/// A gland of 40 mm in a block of fat with the rectum's wall (y = 90 … 95) and lumen behind it, seen from the lumen.
struct AnatomyBlock {
  static constexpr double kLumen_mm = 95.0, kWall_mm = 5.0;
  AnatomyBlock() {
    mesh = imaged_block({"periprostatic_fat", "prostate", "rectum", "rectal_lumen", "bladder"}, [](const Vec3& x) {
      if (x.y() > kLumen_mm) return 3;
      if (x.y() > kLumen_mm - kWall_mm) return 2;
      return (x - Vec3(0, 67, 0)).norm() < 20 ? 1 : 0;
    });
    for (const std::string& region : mesh.regions) echoes.push_back(default_echo(region));
  }
  UltrasoundScanner scanner(const UltrasoundSettings& settings) const {
    return UltrasoundScanner::create(mesh, echoes, settings, {.anatomy = true, .artefacts = false}).value();
  }
  UltrasoundBeams beams(const UltrasoundSettings& settings, double z_mm) const {
    UltrasoundBeams made = block_beams(settings);
    made.origin_mm = {0, kLumen_mm, z_mm};
    made.ahead = -Vec3::UnitY();
    return made;
  }
  TetMesh mesh;
  std::vector<TissueEcho> echoes;
};

TEST(UltrasoundAnatomy, has_a_dark_muscle_between_the_bright_layers_of_the_rectal_wall) {
  const AnatomyBlock block;
  const UltrasoundSettings settings;
  UltrasoundScanner scanner = block.scanner(settings);
  const UltrasoundBeams beams = block.beams(settings, 0.3);
  scanner.scan(moment_at_rest(block.mesh), beams);
  const auto layer = [&](double from, double to) {
    return test::mean_dB(scanner, 20, 235, from * AnatomyBlock::kWall_mm, to * AnatomyBlock::kWall_mm, beams.sample_mm);
  };
  const double submucosa = layer(0.28, 0.40), muscle = layer(0.60, 0.78), serosa = layer(0.94, 1.0);
  EXPECT_LT(muscle, submucosa - 8.0);
  EXPECT_LT(muscle, serosa - 8.0);
}

TEST(UltrasoundAnatomy, has_concretions_that_are_bright_and_cast_shadows) {
  const AnatomyBlock block;
  UltrasoundSettings settings;
  int found = 0;
  double before = 0.0, behind = 0.0, beside = 0.0;
  for (settings.random = 1; settings.random <= 3; ++settings.random) {
    UltrasoundScanner scanner = block.scanner(settings);
    for (double z = -8.0; z <= 8.0; z += 1.0) {
      const UltrasoundBeams beams = block.beams(settings, z);
      scanner.scan(moment_at_rest(block.mesh), beams);
      const auto power = [&](int line, double from_mm, double to_mm) {
        return std::pow(10.0, 0.1 * test::mean_dB(scanner, line - 1, line + 1, from_mm, to_mm, beams.sample_mm));
      };
      for (int line = 100; line <= 156; line += 2) {
        // The brightest sample of the inner gland, if it is a concretion.
        int bright = -1;
        double level = 21.0;  // speckle of soft tissue hardly ever reaches it
        for (int s = static_cast<int>(12.0 / beams.sample_mm); s < static_cast<int>(28.0 / beams.sample_mm); ++s) {
          if (scanner.level_dB(line, s) > level) level = scanner.level_dB(line, s), bright = s;
        }
        if (bright < 0) continue;
        const double depth = bright * beams.sample_mm;
        ++found;
        before += power(line, depth - 4.0, depth - 2.0);
        behind += power(line, depth + 3.0, depth + 6.0);
        beside += 0.5 * (power(line - 40, depth + 3.0, depth + 6.0) + power(line + 40, depth + 3.0, depth + 6.0));
      }
    }
  }
  ASSERT_GT(found, 10);
  EXPECT_LT(10.0 * std::log10(behind / before), -5.0);
  EXPECT_LT(10.0 * std::log10(behind / beside), -4.0);
}

TEST(UltrasoundAnatomy, of_fluid_near_the_plane_is_grey_since_the_slice_is_thick) {
  AnatomyBlock block;
  // Fluid above z = 10, between depths of 15 and 35 mm.
  const auto fluid = static_cast<int>(block.mesh.regions.size()) - 1;
  for (std::size_t t = 0; t < block.mesh.tets.size(); ++t) {
    Vec3 x = Vec3::Zero();
    for (const Index node : block.mesh.tets[t]) x += 0.25 * block.mesh.nodes[static_cast<std::size_t>(node)];
    if (x.z() > 10.0 && x.y() > 60.0 && x.y() < 80.0) block.mesh.tet_region[t] = fluid;
  }
  const UltrasoundSettings settings;  // a slice of 5 mm at a depth of 30 mm
  UltrasoundScanner scanner = block.scanner(settings);
  const auto level_at = [&](double z_mm) {
    const UltrasoundBeams beams = block.beams(settings, z_mm);
    scanner.scan(moment_at_rest(block.mesh), beams);
    return test::mean_dB(scanner, 40, 60, 22.0, 28.0, beams.sample_mm);
  };
  const double wall = level_at(8.5);
  EXPECT_GT(level_at(10.7), wall - 12.0) << "a third of the slice is in the wall";
  EXPECT_LT(level_at(16.0), wall - 30.0) << "the whole slice is in the fluid";
}

// --- geometry of the arrays ---------------------------------------------------------------------------------------

ProbePlace place_at(const ProbeSettings& probe) { return probe_place(probe, {{0, 30, -60}, 0.0}); }

TEST(UltrasoundBeams, of_the_transverse_array_lie_across_the_axis_with_the_patients_left_at_the_right) {
  ProbeSettings probe{.kind = ProbeKind::biplane};
  const UltrasoundBeams beams = ultrasound_beams(probe.kind, place_at(probe), {}, UltrasoundArray::transverse);
  EXPECT_LT((beams.across - Vec3::UnitX()).norm(), 1e-12);
  EXPECT_LT((beams.ahead + Vec3::UnitY()).norm(), 1e-12);
  const Vec3 middle = beams.point_mm(127.5, 20.0);
  EXPECT_LT((middle - Vec3(0, 0, 0)).norm(), 1e-9) << middle.transpose();  // 10 mm of radius and 20 mm of depth
}

TEST(UltrasoundBeams, of_the_sagittal_array_turn_with_the_roll_and_have_superior_at_the_left) {
  ProbeSettings probe{.kind = ProbeKind::biplane, .roll_deg = 90.0};
  const UltrasoundBeams beams = ultrasound_beams(probe.kind, place_at(probe), {}, UltrasoundArray::sagittal);
  EXPECT_LT((beams.across + Vec3::UnitZ()).norm(), 1e-12);
  EXPECT_LT((beams.ahead - Vec3::UnitX()).norm(), 1e-12) << "to the patient's left";
  EXPECT_FALSE(beams.sector);
}

TEST(UltrasoundBeams, of_an_endfire_probe_look_along_its_axis) {
  ProbeSettings probe{.kind = ProbeKind::endfire};
  for (const UltrasoundArray array : {UltrasoundArray::sagittal, UltrasoundArray::transverse}) {
    const UltrasoundBeams beams = ultrasound_beams(probe.kind, place_at(probe), {}, array);
    EXPECT_LT((beams.ahead - Vec3::UnitZ()).norm(), 1e-12);
    EXPECT_TRUE(beams.sector);
  }
}

TEST(UltrasoundBeams, find_the_line_and_depth_of_their_own_points) {
  for (const bool sector : {false, true}) {
    UltrasoundBeams beams = block_beams({}, sector);
    const BeamPoint at = beams.locate(Vec3(beams.point_mm(33.25, 41.5) + 2.0 * beams.normal()));
    EXPECT_NEAR(at.line, 33.25, 1e-9);
    EXPECT_NEAR(at.depth_mm, 41.5, 1e-9);
    EXPECT_NEAR(at.elevation_mm, 2.0, 1e-9);
  }
}

TEST(ScanConversion, puts_an_echo_where_it_is_in_the_patient) {
  const TetMesh mesh = imaged_block();
  for (const bool sector : {false, true}) {
    const UltrasoundBeams beams = block_beams({}, sector);
    UltrasoundScanner scanner = plain_scanner(mesh, {{-90.0, kLevel}});
    Moment moment = moment_at_rest(mesh);
    const Vec3 at(7.0, 41.0, 0.3);
    moment.tracks.push_back({{at - Vec3(0, 0, 0.1), at + Vec3(0, 0, 0.1)}, 0.01});
    ScanConversion conversion(0.2);
    const GreyPicture& picture = conversion.convert(scanner.scan(moment, beams));
    int best = -1;
    Vec3 shown = Vec3::Zero();
    for (int row = 0; row < picture.rows; ++row) {
      for (int column = 0; column < picture.columns; ++column) {
        if (picture.at(row, column) <= best) continue;
        best = picture.at(row, column);
        shown = picture.point_mm(column, row);
      }
    }
    EXPECT_GT(best, 0);
    EXPECT_LT((shown - at).norm(), 0.5);
    const Eigen::Vector4d corner = picture.pixel_to_lps() * Eigen::Vector4d(3, 5, 0, 1);
    EXPECT_LT((corner.head<3>() - picture.point_mm(3, 5)).norm(), 1e-9);
  }
}

TEST(ScanConversion, has_the_probe_at_the_bottom_and_black_beside_the_sector) {
  const TetMesh mesh = imaged_block();
  const UltrasoundBeams beams = block_beams({}, true);
  UltrasoundScanner scanner = plain_scanner(mesh, {{0.0, kLevel}});
  ScanConversion conversion(0.25);
  const GreyPicture& picture = conversion.convert(scanner.scan(moment_at_rest(mesh), beams));
  EXPECT_LT((picture.down + beams.ahead).norm(), 1e-12);
  EXPECT_EQ(picture.at(0, 0), 0);
  EXPECT_EQ(picture.at(picture.rows - 1, 0), 0);
  EXPECT_GT(picture.at(picture.rows / 2, picture.columns / 2), 0);
}

}  // namespace
}  // namespace stylet
