// SPDX-License-Identifier: GPL-3.0-or-later
// Needles and seeds in ultrasound: where they are, and when they are not seen.
#include "imaged_block.hpp"

#include "stylet/probe/probe_place.hpp"

#include <numbers>

namespace stylet {
namespace {

using test::block_beams;
using test::imaged_block;
using test::kLevel;
using test::plain_scanner;

constexpr double kDiameter_mm = 1.27;

/// A needle along x at a depth of the linear array, out of its plane by some millimetres, whose tip is at x = 0.
Moment needle_along_array(const TetMesh& mesh, double depth_mm, double beside_mm) {
  Moment moment = moment_at_rest(mesh);
  moment.needles.push_back({{{-38, depth_mm, 0.3 + beside_mm}, {0, depth_mm, 0.3 + beside_mm}}, kDiameter_mm});
  return moment;
}

struct Peak {
  double level_dB = -300.0, depth_mm = 0.0;
};

Peak brightest(const UltrasoundScanner& scanner, const UltrasoundBeams& beams, int line, double near_mm) {
  Peak peak;
  for (int s = 0; s < beams.samples; ++s) {
    const double depth = s * beams.sample_mm;
    if (std::abs(depth - near_mm) > 4.0 || scanner.level_dB(line, s) <= peak.level_dB) continue;
    peak = {scanner.level_dB(line, s), depth};
  }
  return peak;
}

TEST(NeedleEcho, is_at_the_near_side_of_a_needle_in_the_plane) {
  const TetMesh mesh = imaged_block();
  const UltrasoundSettings settings;
  const UltrasoundBeams beams = block_beams(settings);
  UltrasoundScanner scanner = plain_scanner(mesh, {{0.0, kLevel}}, settings);
  for (const double depth : {15.0, 30.0, 55.0}) {
    scanner.scan(needle_along_array(mesh, depth, 0.0), beams);
    for (const int line : {30, 60, 90, 115}) {
      const Peak peak = brightest(scanner, beams, line, depth);
      EXPECT_NEAR(peak.depth_mm, depth - 0.5 * kDiameter_mm, 0.5);
      EXPECT_GT(peak.level_dB, 15.0) << "well above speckle";
    }
  }
}

TEST(NeedleEcho, in_a_transverse_picture_is_a_point_where_the_needle_passes) {
  const TetMesh mesh = imaged_block();
  const UltrasoundSettings settings;
  const UltrasoundBeams beams = block_beams(settings, true);
  UltrasoundScanner scanner = plain_scanner(mesh, {{0.0, kLevel}}, settings);
  Moment moment = moment_at_rest(mesh);
  const Vec3 at(6.0, 32.0, 0.3);
  moment.needles.push_back({{at - Vec3(1.0, 0, 20), at + Vec3(1.0, 0, 20)}, kDiameter_mm});
  scanner.scan(moment, beams);
  Peak best;
  int best_line = 0;
  for (int line = 0; line < beams.lines; ++line) {
    const Peak peak = brightest(scanner, beams, line, beams.locate(at).depth_mm);
    if (peak.level_dB > best.level_dB) best = peak, best_line = line;
  }
  const Vec3 shown = beams.point_mm(best_line, best.depth_mm);
  const Vec3 near_side = beams.point_mm(beams.locate(at).line, beams.locate(at).depth_mm - 0.5 * kDiameter_mm);
  EXPECT_LT((shown - near_side).norm(), 0.5);
  EXPECT_GT(best.level_dB, 15.0);
}

TEST(NeedleEcho, has_reverberations_and_a_tail_behind_it) {
  const TetMesh mesh = imaged_block();
  const UltrasoundSettings settings;
  const UltrasoundBeams beams = block_beams(settings);
  UltrasoundScanner scanner = plain_scanner(mesh, {{-20.0, kLevel}}, settings);
  scanner.scan(needle_along_array(mesh, 30.0, 0.0), beams);
  const double before = test::mean_dB(scanner, 40, 110, 24.0, 28.0, beams.sample_mm);
  const double behind = test::mean_dB(scanner, 40, 110, 30.5, 34.5, beams.sample_mm);
  EXPECT_GT(behind, before + 10.0);
  EXPECT_LT(behind, test::mean_dB(scanner, 40, 110, 29.1, 29.6, beams.sample_mm) - 6.0);
}

/// Whether the needle stands out of the speckle over its length.
bool is_seen(const UltrasoundScanner& scanner, const UltrasoundBeams& beams, double depth_mm) {
  const int lines = scanner.settings().lines;
  return test::mean_dB(scanner, lines / 6, lines * 2 / 5, depth_mm - 1.2, depth_mm + 0.2, beams.sample_mm) > 6.0;
}

TEST(NeedleEcho, is_seen_over_4_to_25_degrees_of_the_probes_rotation) {
  // Published: one needle is seen over 17° (4–25°) of rotation, Radiat Med 2008;26:512.
  const TetMesh mesh = imaged_block();
  UltrasoundSettings settings;
  settings.lines = 96;
  settings.samples = 400;
  UltrasoundScanner scanner = plain_scanner(mesh, {{0.0, kLevel}}, settings);
  for (const double depth : {15.0, 40.0}) {
    int seen = 0;
    for (int k = -30; k <= 30; ++k) {
      UltrasoundBeams beams = block_beams(settings);
      const double angle = 0.5 * k * std::numbers::pi / 180.0;
      // The array lies on a probe with the radius 10 mm whose axis is along x.
      beams.ahead = {0.0, std::cos(angle), std::sin(angle)};
      beams.surface_mm = 10.0;
      beams.origin_mm = {0.0, -10.0, 0.3};
      scanner.scan(needle_along_array(mesh, depth, 0.0), beams);
      seen += is_seen(scanner, beams, (depth + 10.0) / std::max(0.5, std::cos(angle)) - 10.0) ? 1 : 0;
    }
    EXPECT_GE(0.5 * seen, 4.0) << depth;
    EXPECT_LE(0.5 * seen, 25.0) << depth;
  }
}

TEST(NeedleEcho, is_lost_out_of_plane_by_more_than_half_the_thickness_of_the_slice) {
  const TetMesh mesh = imaged_block();
  const UltrasoundSettings settings;
  const UltrasoundBeams beams = block_beams(settings);
  UltrasoundScanner scanner = plain_scanner(mesh, {{0.0, kLevel}}, settings);
  for (const double depth : {20.0, 30.0, 50.0}) {
    const double half = 0.5 * scanner.profile().elevation_mm(depth);
    scanner.scan(needle_along_array(mesh, depth, 0.5 * half), beams);
    EXPECT_TRUE(is_seen(scanner, beams, depth));
    for (const double side : {-1.0, 1.0}) {
      scanner.scan(needle_along_array(mesh, depth, 1.2 * side * half), beams);
      EXPECT_FALSE(is_seen(scanner, beams, depth)) << depth;
    }
  }
}

TEST(NeedleEcho, ends_before_the_tip_of_a_needle_that_leaves_the_plane) {
  const TetMesh mesh = imaged_block();
  const UltrasoundSettings settings;
  const UltrasoundBeams beams = block_beams(settings);
  UltrasoundScanner scanner = plain_scanner(mesh, {{0.0, kLevel}}, settings);
  const double half = 0.5 * scanner.profile().elevation_mm(30.0);
  Moment moment = moment_at_rest(mesh);
  moment.needles.push_back({{{-30, 30, 0.3}, {20, 30, 0.3 + 2.0 * half}}, kDiameter_mm});
  scanner.scan(moment, beams);
  double last_x = -40.0;
  for (int line = 0; line < beams.lines; ++line) {
    if (brightest(scanner, beams, line, 29.4).level_dB > 14.0) last_x = beams.start_mm(line).x();
  }
  // It leaves the slice at x = −5; the tip at x = 20 is not seen.
  EXPECT_NEAR(last_x, -5.0, 4.0);
}

TEST(SeedEcho, is_a_bright_line_of_its_length_that_fades_with_tilt) {
  const TetMesh mesh = imaged_block();
  const UltrasoundSettings settings;
  const UltrasoundBeams beams = block_beams(settings);
  UltrasoundScanner scanner = plain_scanner(mesh, {{0.0, kLevel}}, settings);
  const auto peak_at = [&](double degrees) {
    Moment moment = moment_at_rest(mesh);
    const double angle = degrees * std::numbers::pi / 180.0;
    moment.seeds.push_back({{2.0, 30.0, 0.3}, {std::cos(angle), std::sin(angle), 0.0}, 4.5, 0.8});
    scanner.scan(moment, beams);
    double best = -300.0;
    int bright = 0;
    for (int line = 0; line < beams.lines; ++line) {
      const double level = brightest(scanner, beams, line, 29.6).level_dB;
      best = std::max(best, level);
      bright += level > 14.0 ? 1 : 0;
    }
    return std::pair(best, bright * beams.step);
  };
  const auto [flat, length] = peak_at(0.0);
  EXPECT_NEAR(length, 4.5, 1.0);
  EXPECT_GT(flat, 15.0);
  EXPECT_LT(peak_at(15.0).first, flat - 4.0);
}

TEST(StrandEcho, has_spacers_between_its_seeds_that_are_fainter_than_the_seeds) {
  const TetMesh mesh = imaged_block();
  const UltrasoundSettings settings;
  const UltrasoundBeams beams = block_beams(settings);
  UltrasoundScanner scanner = plain_scanner(mesh, {{0.0, kLevel}}, settings);
  const auto levels = [&](bool stranded) {
    Moment moment = moment_at_rest(mesh);
    moment.seeds.push_back({{-5.0, 30.0, 0.3}, Vec3::UnitX()});
    join_to_last(moment.seeds, stranded);
    moment.seeds.push_back({{5.0, 30.0, 0.3}, Vec3::UnitX()});
    scanner.scan(moment, beams);
    const auto level = [&](double from_x, double to_x) {
      const auto line = [&](double x) { return static_cast<int>(std::lround((x - beams.first) / beams.step)); };
      return test::mean_dB(scanner, line(from_x), line(to_x), 29.2, 29.9, beams.sample_mm);
    };
    return std::pair(level(-6.0, -4.0), level(-1.5, 1.5));  // on a seed, and in the middle between both
  };
  const auto [seed, spacer] = levels(true);
  EXPECT_GT(spacer, 3.0) << "brighter than the speckle";
  EXPECT_LT(spacer, seed - 6.0);
  EXPECT_LT(levels(false).second, 3.0) << "loose seeds have none";
}

TEST(TrackEcho, is_brighter_than_the_tissue_and_fainter_than_a_needle) {
  const TetMesh mesh = imaged_block();
  const UltrasoundSettings settings;
  const UltrasoundBeams beams = block_beams(settings);
  UltrasoundScanner scanner = plain_scanner(mesh, {{0.0, kLevel}}, settings);
  Moment moment = moment_at_rest(mesh);
  moment.tracks.push_back({{{-38, 30, 0.3}, {0, 30, 0.3}}, kDiameter_mm});
  scanner.scan(moment, beams);
  const double track = test::mean_dB(scanner, 40, 110, 29.0, 29.8, beams.sample_mm);
  EXPECT_GT(track, 3.0);
  scanner.scan(needle_along_array(mesh, 30.0, 0.0), beams);
  EXPECT_LT(track, test::mean_dB(scanner, 40, 110, 29.0, 29.8, beams.sample_mm) - 6.0);
}

}  // namespace
}  // namespace stylet
