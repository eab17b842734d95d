// SPDX-License-Identifier: GPL-3.0-or-later
// Statistics of the speckle, and that it belongs to the material.
#include "imaged_block.hpp"

#include <algorithm>
#include <numbers>

namespace stylet {
namespace {

using test::block_beams;
using test::imaged_block;
using test::kLevel;
using test::plain_scanner;

std::vector<double> amplitudes(const UltrasoundScanner& scanner, int line_step, int sample_step) {
  std::vector<double> values;
  for (int line = 20; line < 236; line += line_step)
    for (int s = 60; s < 520; s += sample_step) values.push_back(std::pow(10.0, scanner.level_dB(line, s) / 20.0));
  return values;
}

/// Mean over standard deviation.
double ratio(const std::vector<double>& values) {
  double mean = 0.0, square = 0.0;
  for (const double v : values) {
    mean += v;
    square += v * v;
  }
  mean /= static_cast<double>(values.size());
  return mean / std::sqrt(square / static_cast<double>(values.size()) - mean * mean);
}

TEST(Speckle, has_the_signal_to_noise_ratio_of_fully_developed_speckle) {
  const TetMesh mesh = imaged_block();
  for (const bool sector : {false, true}) {
    for (const int random : {1, 2, 3}) {
      UltrasoundSettings settings;
      settings.random = random;
      UltrasoundScanner scanner = plain_scanner(mesh, {{0.0, kLevel}}, settings);
      scanner.scan(moment_at_rest(mesh), block_beams(settings, sector));
      // sqrt(π / (4 − π)), of the Rayleigh distribution (Burckhardt 1978)
      EXPECT_NEAR(ratio(amplitudes(scanner, 1, 1)), 1.913, 0.05) << (sector ? "sector" : "linear") << random;
    }
  }
}

TEST(Speckle, follows_the_rayleigh_distribution) {
  const TetMesh mesh = imaged_block();
  const UltrasoundSettings settings;
  UltrasoundScanner scanner = plain_scanner(mesh, {{0.0, kLevel}}, settings);
  scanner.scan(moment_at_rest(mesh), block_beams(settings));
  // Values far enough from each other are independent.
  std::vector<double> values = amplitudes(scanner, 9, 6);
  std::sort(values.begin(), values.end());
  double power = 0.0;
  for (const double v : values) power += v * v;
  power /= static_cast<double>(values.size());
  double largest = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double expected = 1.0 - std::exp(-values[k] * values[k] / power);
    const auto n = static_cast<double>(values.size());
    largest = std::max({largest, std::abs(expected - static_cast<double>(k) / n),
                        std::abs(expected - static_cast<double>(k + 1) / n)});
  }
  // Kolmogorov and Smirnov at the 5 % level
  EXPECT_LT(largest, 1.358 / std::sqrt(static_cast<double>(values.size()))) << values.size();
}

TEST(Speckle, has_the_level_of_the_tissues_echo_at_every_depth) {
  const TetMesh mesh = imaged_block();
  const UltrasoundSettings settings;
  for (const bool sector : {false, true}) {
    UltrasoundScanner scanner = plain_scanner(mesh, {{-6.0, kLevel}}, settings);
    const UltrasoundBeams beams = block_beams(settings, sector);
    scanner.scan(moment_at_rest(mesh), beams);
    for (const double depth : {5.0, 20.0, 40.0, 60.0, 80.0})
      EXPECT_NEAR(test::mean_dB(scanner, 10, 245, depth, depth + 8.0, beams.sample_mm), -6.0, 0.6) << depth;
  }
}

/// Correlation of the amplitudes of two pictures, the second shifted by a number of samples that need not be whole.
double correlation(const UltrasoundScanner& before, const UltrasoundScanner& after, double samples) {
  const int whole = static_cast<int>(std::floor(samples));
  const double part = samples - whole;
  double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  int n = 0;
  for (int line = 20; line < 236; ++line) {
    for (int s = 150; s < 230; ++s) {
      const auto value = [&](const UltrasoundScanner& scanner, int k) {
        return std::pow(10.0, scanner.level_dB(line, k) / 20.0);
      };
      const double a = value(before, s);
      const double b = (1.0 - part) * value(after, s + whole) + part * value(after, s + whole + 1);
      sa += a, sb += b, saa += a * a, sbb += b * b, sab += a * b;
      ++n;
    }
  }
  return (n * sab - sa * sb) / std::sqrt((n * saa - sa * sa) * (n * sbb - sb * sb));
}

double correlation_after_shift(double samples) {
  const TetMesh mesh = imaged_block();
  const UltrasoundSettings settings;
  UltrasoundScanner before = plain_scanner(mesh, {{0.0, kLevel}}, settings);
  UltrasoundScanner after = plain_scanner(mesh, {{0.0, kLevel}}, settings);
  const UltrasoundBeams beams = block_beams(settings);
  before.scan(moment_at_rest(mesh), beams);
  Moment moved = moment_at_rest(mesh);
  moved.displacement.row(1).setConstant(static_cast<float>(samples * beams.sample_mm));
  after.scan(moved, beams);
  return correlation(before, after, samples);
}

TEST(Speckle, moves_with_the_tissue_by_whole_samples) {
  for (const int samples : {1, 3, 6}) EXPECT_GE(correlation_after_shift(samples), 0.99) << samples;
}

TEST(Speckle, moves_with_the_tissue_by_parts_of_a_sample) {
  for (const double samples : {0.25, 0.5, 2.7}) EXPECT_GE(correlation_after_shift(samples), 0.95) << samples;
}

TEST(Speckle, of_other_material_is_other_speckle) {
  // A picture of the plane 3 mm further has nothing in common with this one.
  const TetMesh mesh = imaged_block();
  const UltrasoundSettings settings;
  UltrasoundScanner here = plain_scanner(mesh, {{0.0, kLevel}}, settings);
  UltrasoundScanner there = plain_scanner(mesh, {{0.0, kLevel}}, settings);
  UltrasoundBeams beams = block_beams(settings);
  here.scan(moment_at_rest(mesh), beams);
  beams.origin_mm.z() += 3.0;
  there.scan(moment_at_rest(mesh), beams);
  EXPECT_LT(std::abs(correlation(here, there, 0.0)), 0.1);
}

TEST(Speckle, of_the_same_seed_has_the_same_bits) {
  const TetMesh mesh = imaged_block();
  UltrasoundSettings settings;
  const UltrasoundBeams beams = block_beams(settings, true);
  const Moment moment = moment_at_rest(mesh);
  const auto grey = [&](int random) {
    settings.random = random;
    auto scanner = UltrasoundScanner::create(mesh, std::vector<TissueEcho>{{0.0, kLevel}}, settings);
    const PolarPicture picture = scanner->scan(moment, beams);
    return std::vector<std::uint8_t>(picture.grey.begin(), picture.grey.end());
  };
  EXPECT_EQ(grey(5), grey(5));
  EXPECT_NE(grey(5), grey(6));
}

}  // namespace
}  // namespace stylet
