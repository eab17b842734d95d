// SPDX-License-Identifier: GPL-3.0-or-later
// Ultrasound pictures of a block: statistics of the speckle, attenuation, and places in deformed tissue.
#include "../rows.hpp"

#include "stylet/geom/box_mesh.hpp"
#include "stylet/geom/locator.hpp"
#include "stylet/imaging/ultrasound_scanner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet::validate {

namespace {

/// A block of 80 × 100 × 60 mm in front of a linear array that looks along +y.
struct ImagedBlock {
  TetMesh mesh = box_mesh({-40, 0, -30}, {40, 100, 30}, {8, 10, 6});
  UltrasoundSettings settings{};
  UltrasoundBeams beams{};

  ImagedBlock() {
    beams = {.origin_mm = {0, 0, 0.3},
             .across = Vec3::UnitX(),
             .ahead = Vec3::UnitY(),
             .sector = false,
             .surface_mm = 0.0,
             .first = -32.0,
             .step = 64.0 / (settings.lines - 1),
             .lines = settings.lines,
             .samples = settings.samples,
             .sample_mm = settings.depth_mm / (settings.samples - 1)};
  }
  [[nodiscard]] UltrasoundScanner scanner(double attenuation) const {
    const std::vector<TissueEcho> echoes{{0.0, attenuation, ""}};
    return need(UltrasoundScanner::create(mesh, echoes, settings, {.anatomy = false, .artefacts = false}));
  }
};

constexpr double kEven = UltrasoundScanner::kCompensated_dB_per_cm_MHz;  // speckle keeps its level

Finding speckle(Context&) {
  Finding finding;
  double sum = 0.0;
  constexpr int kSeeds = 4;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    ImagedBlock block;
    block.settings.random = seed;
    auto scanner = block.scanner(kEven);
    scanner.scan(moment_at_rest(block.mesh), block.beams);
    double mean = 0.0, square = 0.0;
    int count = 0;
    for (int line = 20; line < 236; ++line) {
      for (int s = 60; s < 520; ++s) {
        const double amplitude = std::pow(10.0, scanner.level_dB(line, s) / 20.0);
        mean += amplitude;
        square += amplitude * amplitude;
        ++count;
      }
    }
    mean /= count;
    sum += mean / std::sqrt(square / count - mean * mean);
  }
  finding.value = sum / kSeeds;
  finding.note = fmt::format(
      "Mean over standard deviation of the amplitude in a block of one tissue, mean of {} seeds. Fully developed "
      "speckle has the Rayleigh distribution, for which it is √(π/(4 − π)) = 1.913.",
      kSeeds);
  finding.why_missed = "The lattice is too coarse for the beam, so that few random numbers make an echo.";
  return finding;
}

Finding attenuation(Context&) {
  const ImagedBlock block;
  constexpr double kAlpha = 0.95;
  auto weak = block.scanner(kAlpha), even = block.scanner(kEven);
  weak.scan(moment_at_rest(block.mesh), block.beams);
  even.scan(moment_at_rest(block.mesh), block.beams);
  const auto level = [&](const UltrasoundScanner& scanner, double depth_mm) {
    double power = 0.0;
    const int first = static_cast<int>(depth_mm / block.beams.sample_mm);
    for (int line = 10; line < 246; ++line)
      for (int s = first; s < first + 30; ++s) power += std::pow(10.0, scanner.level_dB(line, s) / 10.0);
    return 10.0 * std::log10(power);
  };
  Finding finding;
  Curve ours{.label = "picture"};
  Curve law{.label = "2 α f z", .kind = Curve::Kind::reference};
  const double dB_per_cm = 2.0 * (kAlpha - kEven) * block.settings.frequency_MHz;
  for (const double depth : {15.0, 30.0, 45.0, 60.0, 75.0}) {
    ours.add(depth, level(even, depth) - level(weak, depth));
    law.add(depth, dB_per_cm * (depth + 15.0 * block.beams.sample_mm) / 10.0);
  }
  const double slope = (ours.y.back() - ours.y.front()) / 6.0;
  finding.value = 100.0 * std::abs(slope / dB_per_cm - 1.0);
  finding.plot.curves = {ours, law};
  finding.plot.x_label = "depth [mm]";
  finding.plot.y_label = "loss [dB]";
  finding.note =
      fmt::format("The loss of speckle with depth in tissue of {:g} dB/(cm MHz) at {:g} MHz, from 15 to 75 mm.", kAlpha,
                  block.settings.frequency_MHz);
  finding.why_missed = "The sum over samples along a line is wrong.";
  return finding;
}

Finding place(Context&) {
  const ImagedBlock block;
  auto scanner = block.scanner(kEven);
  Moment moment = moment_at_rest(block.mesh);
  for (Index node = 0; node < block.mesh.node_count(); ++node) {
    const Vec3& x = block.mesh.nodes[static_cast<std::size_t>(node)];
    moment.displacement.col(node) =
        Vec3(2.0 * std::sin(x.y() / 15.0), 3.0 * std::cos(x.x() / 20.0), 1.5 * std::sin(x.x() / 12.0)).cast<float>();
  }
  scanner.scan(moment, block.beams);
  const Topology topology(block.mesh);
  const Locator locator(block.mesh, topology);
  Finding finding{.value = 0.0};
  constexpr int kBeads = 20;
  for (int k = 0; k < kBeads; ++k) {
    const int line = 30 + 10 * k, sample = 60 + 20 * k;
    const Vec3 material = scanner.material_mm(line, sample);
    const auto at = locator.find(material);
    if (!at) continue;
    Vec3 now = material;
    for (std::size_t c = 0; c < 4; ++c)
      now += at->weights[static_cast<Eigen::Index>(c)] *
             moment.displacement.col(block.mesh.tets[static_cast<std::size_t>(at->tet)][c]).cast<double>();
    const Vec3 shown = block.beams.point_mm(line, sample * block.beams.sample_mm);
    finding.value = std::max(finding.value, (now - shown).norm());
  }
  finding.note = fmt::format(
      "A block is displaced by up to 3.9 mm. The value is the largest distance between the place of {} material points "
      "in the picture and their place by interpolation in the finite elements.",
      kBeads);
  finding.why_missed = "The picture shows other material than the elements have there.";
  return finding;
}

}  // namespace

std::vector<RowSpec> ultrasound_rows() {
  return {{"ultrasound_speckle", Group::analysis, "Speckle is fully developed", "the Rayleigh distribution", "",
           Accepted::between(1.863, 1.963), false, speckle},
          {"ultrasound_attenuation", Group::analysis, "Ultrasound loses what the tissue attenuates", "2 α f per length",
           "%", Accepted::at_most(3.0), false, attenuation},
          {"ultrasound_place", Group::analysis, "Ultrasound shows deformed tissue where it is",
           "the displacement of the finite elements", "mm", Accepted::at_most(0.3), false, place}};
}

}  // namespace stylet::validate
