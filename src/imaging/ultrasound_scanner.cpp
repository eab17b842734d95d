// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/imaging/ultrasound_scanner.hpp"

#include "border_echoes.hpp"
#include "echo_picture.hpp"
#include "rod_echoes.hpp"
#include "tissue_attenuation.hpp"
#include "tissue_speckle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace stylet {

double hand_gain_dB(const UltrasoundSettings& settings, double share) {
  const auto& values = settings.tgc_dB;
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const std::size_t low = std::min(static_cast<std::size_t>(place), values.size() - 2);
  const double next = place - static_cast<double>(low);
  return settings.gain_dB + (1.0 - next) * values[low] + next * values[low + 1];
}

struct UltrasoundScanner::Parts {
  Parts(const TetMesh& mesh_, std::span<const TissueEcho> echoes_, const UltrasoundSettings& settings_,
        const UltrasoundFeatures& features_, std::shared_ptr<const EchoMap> painted)
      : mesh(mesh_),
        echoes(echoes_.begin(), echoes_.end()),
        settings(settings_),
        features(features_),
        profile{settings_.frequency_MHz, settings_.focus_mm, settings_.elevation_mm},
        slice(mesh_, settings_.lines),
        shift(mesh_, settings_.lines, settings_.samples),
        tissue(static_cast<std::size_t>(settings_.lines) * static_cast<std::size_t>(settings_.samples)),
        speckle(echoes_, std::move(painted), static_cast<std::uint32_t>(settings_.random), settings_.samples),
        spread(profile, settings_.samples),
        field(settings_.lines, settings_.samples),
        borders(mesh_, settings_.lines),
        attenuation(settings_.lines, settings_.samples),
        rods(settings_.lines, settings_.samples),
        picture(settings_, features_.artefacts) {}

  void fill(const UltrasoundBeams& beams, const Moment& moment);

  const TetMesh& mesh;
  std::vector<TissueEcho> echoes;  ///< (regions)
  UltrasoundSettings settings;
  UltrasoundFeatures features;
  BeamProfile profile;
  DeformedSlice slice;
  MaterialShift shift;
  SampledTissue tissue;
  TissueSpeckle speckle;
  PointSpread spread;
  EchoField field;
  BorderEchoes borders;
  TissueAttenuation attenuation;
  RodEchoes rods;
  EchoPicture picture;
};

/// Fills the field with the speckle of the tissue on all lines, and notes the borders.
void UltrasoundScanner::Parts::fill(const UltrasoundBeams& beams, const Moment& moment) {
  field.clear();
  borders.clear();
  tissue.clear();
  speckle.begin(beams, profile);
  slice.place(beams, moment.displacement);
  shift.compute(beams, moment, slice);
  const SpeckleScene scene{beams, profile, shift, spread};
  slice.cut(
      beams,
      [&](const BeamSpan& span) {
        if (span.leaves) borders.note(span);
        const int region = mesh.tet_region[static_cast<std::size_t>(span.tet)];
        speckle.fill(scene, span, static_cast<std::size_t>(region), tissue, field);
      },
      [](Index) { return true; });
}

namespace {

/// Errors: no scanner can work with these settings.
Result<> check(const TetMesh& mesh, std::span<const TissueEcho> echoes, const UltrasoundSettings& settings) {
  if (echoes.size() != mesh.regions.size())
    return input_error("ultrasound",
                       fmt::format("{} echoes are given for {} regions", echoes.size(), mesh.regions.size()),
                       "Give one for each region of the mesh");
  if (settings.lines < 2 || settings.samples < 2)
    return input_error("ultrasound",
                       fmt::format("a picture cannot have {} lines and {} samples", settings.lines, settings.samples),
                       "Give at least 2 of each");
  if (mesh.regions.size() > 255)
    return input_error("ultrasound", fmt::format("the mesh has {} regions", mesh.regions.size()),
                       "Join regions until there are at most 255");
  return Ok{};
}

std::shared_ptr<const EchoMap> paint(const TetMesh& mesh, std::span<const TissueEcho> echoes, int random) {
  auto map = EchoMap::paint(mesh, echoes, static_cast<std::uint32_t>(random));
  return map ? std::make_shared<const EchoMap>(std::move(*map)) : nullptr;
}

}  // namespace

Result<UltrasoundScanner> UltrasoundScanner::create(const TetMesh& mesh, std::span<const TissueEcho> echoes,
                                                    const UltrasoundSettings& settings,
                                                    const UltrasoundFeatures& features) {
  if (auto checked = check(mesh, echoes, settings); !checked) return checked.error();
  auto map = features.anatomy ? paint(mesh, echoes, settings.random) : nullptr;
  return UltrasoundScanner(std::make_unique<Parts>(mesh, echoes, settings, features, std::move(map)));
}

Result<UltrasoundScanner> UltrasoundScanner::tuned(const UltrasoundSettings& settings) const {
  const Parts& p = *parts_;
  if (settings.random != p.settings.random) return create(p.mesh, p.echoes, settings, p.features);
  if (auto checked = check(p.mesh, p.echoes, settings); !checked) return checked.error();
  return UltrasoundScanner(std::make_unique<Parts>(p.mesh, p.echoes, settings, p.features, p.speckle.map()));
}

UltrasoundScanner::UltrasoundScanner(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
UltrasoundScanner::~UltrasoundScanner() = default;
UltrasoundScanner::UltrasoundScanner(UltrasoundScanner&&) noexcept = default;
UltrasoundScanner& UltrasoundScanner::operator=(UltrasoundScanner&&) noexcept = default;

PolarPicture UltrasoundScanner::scan(const Moment& moment, ProbeKind kind, const ProbePlace& place,
                                     UltrasoundArray array) {
  return scan(moment, ultrasound_beams(kind, place, parts_->settings, array));
}

PolarPicture UltrasoundScanner::scan(const Moment& moment, const UltrasoundBeams& beams) {
  Parts& p = *parts_;
  p.spread.follow(beams);
  p.fill(beams, moment);
  p.attenuation.apply(beams, p.profile.frequency_MHz, p.mesh, p.echoes, p.tissue.tets, p.tissue.is_concretion, p.field);
  p.borders.add(beams, p.attenuation.gain(), p.speckle.lattice(), p.spread, p.field);
  p.rods.clear();
  const auto rod = [&](std::span<const Vec3> line, double diameter_mm, const RodLook& look) {
    p.rods.add(line, diameter_mm, look, beams, p.profile, p.spread, p.attenuation.gain(), p.field);
  };
  for (const ShownTrack& track : moment.tracks) rod(track.centreline_mm, track.diameter_mm, track_look());
  for (const ShownSeed& seed : moment.seeds) {
    const std::array<Vec3, 2> ends{seed.centre_mm - 0.5 * seed.length_mm * seed.axis,
                                   seed.centre_mm + 0.5 * seed.length_mm * seed.axis};
    rod(ends, seed.diameter_mm, seed_look(seed.diameter_mm));
    if (!seed.next || *seed.next >= moment.seeds.size()) continue;
    const ShownSeed& other = moment.seeds[*seed.next];
    const Vec3 way = other.centre_mm - seed.centre_mm;
    const double length = way.norm(), metal = 0.5 * (seed.length_mm + other.length_mm);
    if (length <= metal) continue;  // the seeds touch
    const Vec3 from = seed.centre_mm + 0.5 * seed.length_mm / length * way;
    rod(std::array<Vec3, 2>{from, from + (length - metal) / length * way}, seed.diameter_mm, spacer_look());
  }
  for (const ShownNeedle& needle : moment.needles)
    rod(needle.centreline_mm, needle.diameter_mm, needle_look(needle.diameter_mm));
  p.rods.add_tails(p.picture.artefacts().pattern(), beams.sample_mm, p.field);
  p.field.blur(p.spread);
  p.picture.compress(beams, p.settings, p.field);
  return {beams, p.picture.grey()};
}

double UltrasoundScanner::level_dB(int line, int sample) const {
  const UltrasoundBeams& beams = parts_->picture.beams();
  const auto at =
      static_cast<std::size_t>(sample) * static_cast<std::size_t>(beams.lines) + static_cast<std::size_t>(line);
  return 10.0 * std::log10(std::max(1e-20, static_cast<double>(parts_->picture.power()[at])));
}

Vec3 UltrasoundScanner::material_mm(int line, int sample) const {
  const Parts& p = *parts_;
  const UltrasoundBeams& beams = p.picture.beams();
  const Index tet = p.tissue.tets[static_cast<std::size_t>(line) * static_cast<std::size_t>(beams.samples) +
                                  static_cast<std::size_t>(sample)];
  if (tet < 0) return Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  const double depth = sample * beams.sample_mm;
  const Vec4 weights = p.slice.weights(tet, beams.start_mm(line) + depth * beams.direction(line));
  Vec3 x = Vec3::Zero();
  for (std::size_t k = 0; k < 4; ++k)
    x += weights[static_cast<Eigen::Index>(k)] *
         p.mesh.nodes[static_cast<std::size_t>(p.mesh.tets[static_cast<std::size_t>(tet)][k])];
  if (p.shift.touches(line, sample, sample)) x += p.shift.at(line, sample).cast<double>();
  return x;
}

const BeamProfile& UltrasoundScanner::profile() const { return parts_->profile; }
const UltrasoundSettings& UltrasoundScanner::settings() const { return parts_->settings; }
const TetMesh& UltrasoundScanner::mesh() const { return parts_->mesh; }

}  // namespace stylet
