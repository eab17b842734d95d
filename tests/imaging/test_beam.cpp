// SPDX-License-Identifier: GPL-3.0-or-later
// Resolution, attenuation, shadows, enhancement, and borders.
#include "imaged_block.hpp"

namespace stylet {
namespace {

using test::block_beams;
using test::imaged_block;
using test::kLevel;
using test::mean_dB;
using test::plain_scanner;

/// Full width at half maximum of the echo of a point at a depth: along the line and across the lines [mm].
Eigen::Vector2d widths(const UltrasoundBeams& beams, const UltrasoundSettings& settings, double depth_mm) {
  const TetMesh mesh = imaged_block();
  UltrasoundScanner scanner = plain_scanner(mesh, {{-120.0, kLevel}}, settings);
  Moment moment = moment_at_rest(mesh);
  const int line = settings.lines / 2;
  const Vec3 at = beams.point_mm(line, depth_mm);
  moment.tracks.push_back({{at - Vec3(0, 0, 0.02), at + Vec3(0, 0, 0.02)}, 0.001});
  scanner.scan(moment, beams);
  const auto sample = static_cast<int>(std::lround(depth_mm / beams.sample_mm));
  const auto half_width = [&](int line_step, int sample_step) {
    int peak_line = line, peak_sample = sample;
    for (int s = sample - 2; s <= sample + 2; ++s)
      if (scanner.level_dB(line, s) > scanner.level_dB(line, peak_sample)) peak_sample = s;
    const double peak = scanner.level_dB(peak_line, peak_sample);
    double width = 0.0;
    for (const int side : {-1, 1}) {
      double before = peak;
      for (int k = 1; k < 40; ++k) {
        const double level = scanner.level_dB(peak_line + side * k * line_step, peak_sample + side * k * sample_step);
        if (level < peak - 6.0206) {
          width += k - 1 + (before - (peak - 6.0206)) / (before - level);
          break;
        }
        before = level;
      }
    }
    return width;
  };
  return {half_width(0, 1) * beams.sample_mm, half_width(1, 0) * beams.spacing_mm(depth_mm)};
}

UltrasoundSettings dense() {
  UltrasoundSettings settings;
  settings.lines = 512;
  settings.samples = 1120;  // the sampling itself widens what is measured
  return settings;
}

TEST(Beam, resolves_a_third_of_a_millimetre_along_the_line) {
  const UltrasoundSettings settings = dense();
  for (const double depth : {15.0, 30.0, 60.0})
    EXPECT_NEAR(widths(block_beams(settings), settings, depth).x(), 0.30, 0.03) << depth;
}

TEST(Beam, resolves_wavelength_times_f_number_at_the_focus_and_less_away_from_it) {
  UltrasoundSettings settings = dense();
  for (const double focus : {30.0, 50.0}) {
    settings.focus_mm = focus;
    for (const bool sector : {false, true}) {
      const double expected = 1.54 / settings.frequency_MHz * BeamProfile::kF;
      EXPECT_NEAR(widths(block_beams(settings, sector), settings, focus).y() / expected, 1.0, 0.15) << focus;
      EXPECT_NEAR(widths(block_beams(settings, sector), settings, focus + 20.0).y() / (std::sqrt(2.0) * expected), 1.0,
                  0.15);
    }
  }
}

TEST(Attenuation, lowers_the_level_by_twice_its_length_and_frequency) {
  const TetMesh mesh = imaged_block();
  for (const double frequency : {5.0, 7.5}) {
    UltrasoundSettings settings;
    settings.frequency_MHz = frequency;
    const UltrasoundBeams beams = block_beams(settings);
    const double alpha = 0.95;
    UltrasoundScanner scanner = plain_scanner(mesh, {{0.0, alpha}}, settings);
    UltrasoundScanner level = plain_scanner(mesh, {{0.0, kLevel}}, settings);
    scanner.scan(moment_at_rest(mesh), beams);
    level.scan(moment_at_rest(mesh), beams);
    const auto loss = [&](double depth) {
      return mean_dB(level, 10, 245, depth, depth + 5, beams.sample_mm) -
             mean_dB(scanner, 10, 245, depth, depth + 5, beams.sample_mm);
    };
    const double slope = (loss(75.0) - loss(15.0)) / 6.0;  // per cm
    EXPECT_NEAR(slope / (2.0 * (alpha - kLevel) * frequency), 1.0, 0.03) << frequency;
  }
}

TEST(Bone, casts_a_shadow_of_30_dB_or_more_also_with_artefacts) {
  const TetMesh mesh =
      imaged_block({"body", "pubic_arch"}, [](const Vec3& x) { return x.y() > 30 && x.y() < 40 ? 1 : 0; });
  const UltrasoundSettings settings;
  const UltrasoundBeams beams = block_beams(settings);
  auto scanner = UltrasoundScanner::create(
      mesh, std::vector<TissueEcho>{default_echo("body"), default_echo("pubic_arch")}, settings);
  ASSERT_TRUE(scanner.ok());
  scanner->scan(moment_at_rest(mesh), beams);
  const double before = mean_dB(*scanner, 10, 245, 20, 28, beams.sample_mm);
  EXPECT_LE(mean_dB(*scanner, 10, 245, 42, 85, beams.sample_mm), before - 30.0);
  EXPECT_GE(mean_dB(*scanner, 10, 245, 29.8, 30.4, beams.sample_mm), before + 10.0) << "its surface is bright";
}

TEST(Shadow, of_something_narrow_fills_up_with_depth_since_the_aperture_is_wide) {
  // Bone of 2.5 mm at a depth of 20 to 25 mm. At 28 mm the aperture, 28 mm over F, sees it over a width of 28 / 2.5 ×
  // 3 / 28 = 1.2 mm, all of it shaded; at 65 mm over 16 mm, of which a sixth is shaded.
  TetMesh mesh = box_mesh({-40, 0, -30}, {40, 100, 30}, {32, 20, 6});
  assign_regions(mesh, {"body", "pubic_arch"},
                 [](const Vec3& x) { return std::abs(x.x()) < 1.25 && x.y() > 20 && x.y() < 25 ? 1 : 0; });
  const UltrasoundSettings settings;
  const UltrasoundBeams beams = block_beams(settings);
  const std::vector<TissueEcho> echoes{{0.0, kLevel}, default_echo("pubic_arch")};
  UltrasoundScanner scanner = plain_scanner(mesh, echoes, settings);
  scanner.scan(moment_at_rest(mesh), beams);
  const auto shade = [&](int first, int last, double from, double to) {
    return mean_dB(scanner, 5, 60, from, to, beams.sample_mm) -
           mean_dB(scanner, first, last, from, to, beams.sample_mm);
  };
  EXPECT_GT(shade(126, 129, 30.0, 32.0), 8.0) << "right behind it";
  EXPECT_LT(shade(126, 129, 63.0, 68.0), 6.0) << "deep behind it";
  EXPECT_LT(shade(104, 108, 63.0, 68.0), 2.0) << "beside its shadow";
}

TEST(Gain, by_depth_changes_the_grey_as_set) {
  const TetMesh mesh = imaged_block();
  UltrasoundSettings settings;
  const UltrasoundBeams beams = block_beams(settings);
  UltrasoundScanner plain = plain_scanner(mesh, {{-10.0, kLevel}}, settings);
  settings.tgc_dB = {-6.0, 0.0, 3.0, 9.0};
  UltrasoundScanner set = plain_scanner(mesh, {{-10.0, kLevel}}, settings);
  const Moment moment = moment_at_rest(mesh);
  const PolarPicture before = plain.scan(moment, beams), after = set.scan(moment, beams);
  const auto n = static_cast<std::size_t>(settings.samples);
  for (const auto& [third, gain_dB] :
       {std::pair{0.0, -6.0}, {0.5, -3.0}, {1.0, 0.0}, {1.5, 1.5}, {2.0, 3.0}, {3.0, 9.0}}) {
    const auto sample = static_cast<std::size_t>(std::lround(third / 3.0 * (settings.samples - 1)));
    int compared = 0;
    for (std::size_t line = 0; line < 256; ++line) {
      const int from = before.grey[line * n + sample], to = after.grey[line * n + sample];
      if (from == 0 || to == 0 || from == 255 || to == 255) continue;
      EXPECT_NEAR(to - from, gain_dB * 255.0 / settings.dynamic_range_dB, 1.1) << third;
      ++compared;
    }
    EXPECT_GT(compared, 100) << third;
  }
}

TEST(Fluid, is_dark_and_what_lies_behind_it_is_brighter) {
  const TetMesh mesh =
      imaged_block({"body", "bladder"}, [](const Vec3& x) { return x.y() > 20 && x.y() < 40 && x.x() > 0 ? 1 : 0; });
  const UltrasoundSettings settings;
  const UltrasoundBeams beams = block_beams(settings);
  auto scanner =
      UltrasoundScanner::create(mesh, std::vector<TissueEcho>{default_echo("body"), default_echo("bladder")}, settings);
  ASSERT_TRUE(scanner.ok());
  scanner->scan(moment_at_rest(mesh), beams);
  const double tissue = mean_dB(*scanner, 30, 100, 25, 38, beams.sample_mm);
  const double fluid = mean_dB(*scanner, 160, 230, 25, 38, beams.sample_mm);
  EXPECT_LT(fluid, tissue - 15.0);
  EXPECT_GT(fluid, tissue - 45.0) << "clutter";
  EXPECT_GT(mean_dB(*scanner, 160, 230, 45, 55, beams.sample_mm),
            mean_dB(*scanner, 30, 100, 45, 55, beams.sample_mm) + 5.0);
}

TEST(Border, is_bright_where_the_beam_meets_it_at_a_right_angle_and_fades_with_the_angle) {
  const TetMesh mesh =
      imaged_block({"periprostatic_fat", "prostate"}, [](const Vec3& x) { return x.y() > 40 ? 1 : 0; });
  const UltrasoundSettings settings;
  const std::vector<TissueEcho> echoes{{-100.0, kLevel}, {-100.0, kLevel}};
  const auto level = [&](double degrees) {
    UltrasoundScanner scanner = plain_scanner(mesh, echoes, settings);
    UltrasoundBeams beams = block_beams(settings);
    const double angle = degrees * 3.14159265358979 / 180.0;
    beams.ahead = {std::sin(angle), std::cos(angle), 0.0};
    beams.across = {std::cos(angle), -std::sin(angle), 0.0};
    beams.origin_mm = Vec3(0, 40, 0.3) - 40.0 * beams.ahead;
    scanner.scan(moment_at_rest(mesh), beams);
    double sum = 0.0;  // the line through the point of the border that is 40 mm deep, and its neighbours
    for (int line = 118; line < 138; ++line) {
      double peak = 0.0;
      for (int s = 0; s < settings.samples; ++s)
        peak = std::max(peak, std::pow(10.0, scanner.level_dB(line, s) / 10.0));
      sum += peak / 20.0;
    }
    return 10.0 * std::log10(sum);
  };
  EXPECT_GT(level(0.0), 5.0);
  EXPECT_LT(level(25.0), level(0.0) - 1.5);
  EXPECT_LT(level(50.0), level(25.0) - 5.0);
}

}  // namespace
}  // namespace stylet
