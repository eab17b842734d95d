// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/imaging/ultrasound_scanner.hpp"

#include "deformed_slice.hpp"
#include "echo_field.hpp"
#include "echo_map.hpp"
#include "interface_echo.hpp"
#include "material_shift.hpp"
#include "point_spread.hpp"
#include "rod_echoes.hpp"
#include "speckle_lattice.hpp"
#include "tissue_attenuation.hpp"
#include "ultrasound_artefacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace stylet {

namespace {

constexpr double kSlicePoint = 0.23;    // standard deviation of the slice's profile, in thicknesses
constexpr double kPatch = 0.12;         // patches of a border are larger than speckle by its inverse
constexpr int kRoughParts = 14;         // echoes behind the surface of bone,
constexpr double kRoughPart_mm = 0.22;  // their distance,
constexpr float kRoughShare = 0.80F;    // and the amplitude of each, relative to the one before
constexpr float kLogUnit_dB = 3.0103F;  // 10 log10(2)

float amplitude_of_dB(double dB) { return static_cast<float>(std::pow(10.0, dB / 20.0)); }

/// log2 of a positive number, within 1e-5: the exponent, and a polynomial of the mantissa m that is exact at m = 1.
float quick_log2(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const auto exponent = static_cast<float>(static_cast<int>(bits >> 23) - 127);
  const auto m = std::bit_cast<float>((bits & 0x007FFFFFU) | 0x3F800000U);  // 1 … 2
  return exponent +
         (m - 1.0F) * (3.1157899F +
                       m * (-3.3241990F + m * (2.5988452F + m * (-1.2315303F + m * (0.31821337F - 0.034436006F * m)))));
}

}  // namespace

double hand_gain_dB(const UltrasoundSettings& settings, double share) {
  const auto& values = settings.tgc_dB;
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const std::size_t low = std::min(static_cast<std::size_t>(place), values.size() - 2);
  const double next = place - static_cast<double>(low);
  return settings.gain_dB + (1.0 - next) * values[low] + next * values[low + 1];
}

/// A place where a line crosses a border between tissues.
struct BorderHit {
  int line;
  float depth_mm;
  float amplitude;
  double roughness_mm;
  Vec3 at;  ///< undeformed
};

struct UltrasoundScanner::Parts {
  Parts(const TetMesh& mesh_, std::span<const TissueEcho> echoes_, const UltrasoundSettings& settings_,
        const UltrasoundFeatures& features_, std::shared_ptr<const EchoMap> painted)
      : mesh(mesh_),
        settings(settings_),
        features(features_),
        profile{settings_.frequency_MHz, settings_.focus_mm, settings_.elevation_mm},
        slice(mesh_, settings_.lines),
        lattice(static_cast<std::uint32_t>(settings_.random)),
        shift(mesh_, settings_.lines, settings_.samples),
        spread(profile, settings_.samples),
        field(settings_.lines, settings_.samples),
        attenuation(settings_.lines, settings_.samples),
        rods(settings_.lines, settings_.samples),
        artefacts(settings_.lines, settings_.samples, static_cast<std::uint32_t>(settings_.random)),
        tets(static_cast<std::size_t>(settings_.lines) * static_cast<std::size_t>(settings_.samples)),
        power(tets.size()),
        slice_mm(static_cast<std::size_t>(settings_.samples)),
        grey(tets.size()) {
    echoes.assign(echoes_.begin(), echoes_.end());
    for (const TissueEcho& echo : echoes) amplitudes.push_back(amplitude_of_dB(echo.echo_dB));
    for (const std::string& region : mesh.regions) roles.push_back(tissue_role(region));
    map = std::move(painted);
    for (std::size_t level = 0; level < of_level.size(); ++level)
      of_level[level] = amplitude_of_dB(EchoMap::kDarkest_dB + EchoMap::kStep_dB * static_cast<double>(level));
    hits.reserve(static_cast<std::size_t>(settings.lines) * 64);
    is_concretion.resize(tets.size());
  }

  void fill(const Moment& moment);
  void fill(const BeamSpan& span);
  void fill_row(int line, int from, int to, float amplitude, const Eigen::Vector3f& p0, const Eigen::Vector3f& dp,
                const Vec3& x0, const Vec3& dx);
  void note_border(const BeamSpan& span);
  void add_borders();
  void compress();

  const TetMesh& mesh;
  UltrasoundSettings settings;
  UltrasoundFeatures features;
  BeamProfile profile;
  std::vector<TissueEcho> echoes;
  std::vector<float> amplitudes;  ///< (regions) of their speckle
  std::vector<TissueRole> roles;
  DeformedSlice slice;
  SpeckleLattice lattice;
  std::shared_ptr<const EchoMap> map;  ///< null: none
  std::array<float, 256> of_level{};
  MaterialShift shift;
  PointSpread spread;
  EchoField field;
  TissueAttenuation attenuation;
  RodEchoes rods;
  UltrasoundArtefacts artefacts;
  UltrasoundBeams beams;
  std::vector<BorderHit> hits;
  std::vector<Index> tets;                  ///< (lines × samples) tetrahedron of each sample, or -1
  std::vector<std::uint8_t> is_concretion;  ///< (lines × samples)
  std::vector<float> power;                 ///< (samples × lines)
  std::vector<float> slice_mm;              ///< (samples) distance from the plane at which tissue is looked at
  std::vector<std::uint8_t> grey;           ///< (lines × samples)
};

void UltrasoundScanner::Parts::fill(const Moment& moment) {
  field.clear();
  hits.clear();
  std::fill(tets.begin(), tets.end(), Index{-1});
  std::fill(is_concretion.begin(), is_concretion.end(), std::uint8_t{0});
  for (int s = 0; s < beams.samples; ++s)
    slice_mm[static_cast<std::size_t>(s)] = static_cast<float>(kSlicePoint * profile.elevation_mm(s * beams.sample_mm));
  slice.place(beams, moment.displacement);
  shift.compute(beams, moment, slice);
  slice.cut(
      beams, [this](const BeamSpan& span) { fill(span); }, [](Index) { return true; });
}

/// Fills the samples of a span with speckle.
void UltrasoundScanner::Parts::fill(const BeamSpan& span) {
  if (span.leaves) note_border(span);
  const int from = static_cast<int>(std::ceil(span.from_mm / beams.sample_mm - 1e-7));
  const int to = std::min(beams.samples - 1, static_cast<int>(std::floor(span.to_mm / beams.sample_mm + 1e-7)));
  if (from > to) return;
  const Vec3& x0 = span.undeformed_mm;
  const Vec3 dx = span.course * beams.sample_mm;
  const auto region = static_cast<std::size_t>(mesh.tet_region[static_cast<std::size_t>(span.tet)]);
  const std::size_t line = static_cast<std::size_t>(span.line) * static_cast<std::size_t>(beams.samples);
  std::fill(tets.begin() + static_cast<std::ptrdiff_t>(line) + from,
            tets.begin() + static_cast<std::ptrdiff_t>(line) + to + 1, span.tet);
  fill_row(span.line, from, to, amplitudes[region], lattice.position(x0), lattice.difference(dx), x0, dx);
}

void UltrasoundScanner::Parts::fill_row(int line, int from, int to, float amplitude, const Eigen::Vector3f& p0,
                                        const Eigen::Vector3f& dp, const Vec3& x0, const Vec3& dx) {
  constexpr int kLevelStep = 5;  // samples from one look at the map to the next
  float* const real = field.real(line);
  float* const imaginary = field.imaginary(line);
  const bool shifted = shift.touches(line, from, to);
  const std::size_t first = static_cast<std::size_t>(line) * static_cast<std::size_t>(beams.samples);
  const Eigen::Vector3f normal = EchoMap::difference(beams.normal());
  const auto level_at = [&](int s) {
    Vec3 x = x0 + s * dx;
    if (shifted) x += shift.at(line, s).cast<double>();
    const Eigen::Vector3f at = map->position(x), beside = slice_mm[static_cast<std::size_t>(s)] * normal;
    return map->mean_power(at - beside, at + beside);
  };
  Eigen::Vector3f moved = Eigen::Vector3f::Zero(), move = Eigen::Vector3f::Zero();  // on the lattice
  float level = -1.0F, slope = 0.0F;  // of the map at a sample, and from one sample to the next
  float next_level = map ? level_at(from) : -1.0F;
  int next_look = map ? from : to + 1;
  for (int s = from; s <= to; ++s) {
    if (s == next_look) {
      const int then = std::min(s + kLevelStep, to);
      level = next_level;
      next_level = level_at(then);
      slope =
          next_level >= 0.0F && level >= 0.0F ? (next_level - level) / static_cast<float>(std::max(1, then - s)) : 0.0F;
      next_look = s + kLevelStep;
    }
    float share = amplitude;
    if (level >= 0.0F) {
      share = of_level[static_cast<std::size_t>(std::min(255.0F, level + 0.5F))];
      if (level > EchoMap::kCalcified) is_concretion[first + static_cast<std::size_t>(s)] = 1;
      level += slope;
    }
    Eigen::Vector3f p = p0 + static_cast<float>(s) * dp;
    if (shifted) {
      if (s == from || s % MaterialShift::kSampleStep == 0) {  // linear in between
        const int next = (s / MaterialShift::kSampleStep + 1) * MaterialShift::kSampleStep;
        moved = lattice.difference(shift.at(line, s).cast<double>());
        move = (lattice.difference(shift.at(line, next).cast<double>()) - moved) / static_cast<float>(next - s);
      }
      p += moved;
      moved += move;
    }
    const std::complex<float> noise = lattice.at(p);
    share *= spread.noise_scale(s);
    real[s] = share * noise.real();
    imaginary[s] = share * noise.imag();
  }
}

void UltrasoundScanner::Parts::note_border(const BeamSpan& span) {
  if (span.behind < 0 || hits.size() == hits.capacity()) return;
  const int here = mesh.tet_region[static_cast<std::size_t>(span.tet)];
  const int there = mesh.tet_region[static_cast<std::size_t>(span.behind)];
  if (here == there) return;
  const InterfaceEcho echo =
      interface_echo(roles[static_cast<std::size_t>(here)], roles[static_cast<std::size_t>(there)]);
  const auto facing = static_cast<float>(std::abs(span.cosine));
  hits.push_back({span.line, static_cast<float>(span.to_mm),
                  amplitude_of_dB(echo.level_dB) * std::pow(facing, echo.falloff), echo.roughness_mm,
                  span.undeformed_mm + span.to_mm * span.course});
}

void UltrasoundScanner::Parts::add_borders() {
  const std::span<const float> gain = attenuation.gain();
  for (const BorderHit& hit : hits) {
    const double sample = static_cast<double>(hit.depth_mm) / beams.sample_mm;
    const auto at = static_cast<std::size_t>(std::clamp(static_cast<int>(sample), 0, beams.samples - 1));
    const float passed = gain[static_cast<std::size_t>(hit.line) * static_cast<std::size_t>(beams.samples) + at];
    // A border is not equally smooth everywhere.
    const std::complex<float> patch = lattice.at(lattice.position(kPatch * hit.at));
    const float strength = hit.amplitude * passed / spread.axial()[0];
    const double rough = hit.roughness_mm * static_cast<double>(patch.imag()) / beams.sample_mm;
    field.add(hit.line, sample + rough, strength, 0.5F + 0.6F * patch.real(), 0.4F * patch.imag());
    if (hit.roughness_mm < 0.2) continue;
    // Parts of a rough surface lie deeper, differently from line to line, and echoes are reflected several times before
    // it.
    float part_strength = 0.7F * strength;
    for (int k = 1; k <= kRoughParts; ++k) {
      const std::complex<float> part = lattice.at(lattice.position((1.0 + 0.3 * k) * hit.at));
      field.add(hit.line, sample + std::abs(rough) + kRoughPart_mm * k / beams.sample_mm, part_strength, part.real(),
                part.imag());
      part_strength *= kRoughShare;
    }
  }
}

void UltrasoundScanner::Parts::compress() {
  const auto range = static_cast<float>(settings.dynamic_range_dB);
  const float scale = 255.0F / range;
  if (features.artefacts) artefacts.begin();
  const auto n = static_cast<std::size_t>(beams.lines);
  for (int s = 0; s < beams.samples; ++s) {
    const double share = static_cast<double>(s) / (beams.samples - 1);
    const auto gained = range + static_cast<float>(hand_gain_dB(settings, share) - kWhite_dB);
    float* const row = &power[static_cast<std::size_t>(s) * n];
    float* const real = field.row_real(s);
    float* const imaginary = field.row_imaginary(s);
    for (std::size_t l = 0; l < n; ++l) row[l] = real[l] * real[l] + imaginary[l] * imaginary[l];
    if (features.artefacts) artefacts.add(s, s * beams.sample_mm, real, imaginary, row);
    for (std::size_t l = 0; l < n; ++l) {
      const float dB = kLogUnit_dB * quick_log2(std::max(row[l], 1e-20F));
      const float rounded = std::clamp(scale * (dB + gained) + 0.5F, 0.0F, 255.0F);
      grey[l * static_cast<std::size_t>(beams.samples) + static_cast<std::size_t>(s)] =
          static_cast<std::uint8_t>(rounded);
    }
  }
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
  return UltrasoundScanner(std::make_unique<Parts>(p.mesh, p.echoes, settings, p.features, p.map));
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
  p.beams = beams;
  p.spread.follow(beams);
  p.fill(moment);
  p.attenuation.apply(beams, p.profile.frequency_MHz, p.mesh, p.echoes, p.tets, p.is_concretion, p.field);
  p.add_borders();
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
  p.rods.add_tails(p.artefacts.pattern(), beams.sample_mm, p.field);
  p.field.blur(p.spread);
  p.compress();
  return {beams, p.grey};
}

double UltrasoundScanner::level_dB(int line, int sample) const {
  const auto at =
      static_cast<std::size_t>(sample) * static_cast<std::size_t>(parts_->beams.lines) + static_cast<std::size_t>(line);
  return 10.0 * std::log10(std::max(1e-20, static_cast<double>(parts_->power[at])));
}

Vec3 UltrasoundScanner::material_mm(int line, int sample) const {
  const Parts& p = *parts_;
  const Index tet = p.tets[static_cast<std::size_t>(line) * static_cast<std::size_t>(p.beams.samples) +
                           static_cast<std::size_t>(sample)];
  if (tet < 0) return Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  const double depth = sample * p.beams.sample_mm;
  const Vec4 weights = p.slice.weights(tet, p.beams.start_mm(line) + depth * p.beams.direction(line));
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
