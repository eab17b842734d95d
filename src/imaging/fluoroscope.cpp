// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/imaging/fluoroscope.hpp"

#include "sim/planning.hpp"
#include "stylet/geom/centroid.hpp"
#include "stylet/imaging/xray_materials.hpp"
#include "xray_catheter.hpp"
#include "xray_detector.hpp"
#include "xray_rods.hpp"
#include "xray_surfaces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace stylet {

namespace {

/// Refuses a source or a detector inside the patient at rest, or too near for what moves.
Result<> check_distances(const TetMesh& mesh, const FluoroscopySettings& settings, const XrayGeometry& unit) {
  constexpr double kRoom_mm = 20.0;
  double nearest = unit.source_distance_mm;
  double farthest = unit.source_distance_mm;
  for (const Vec3& x : mesh.nodes) {
    const double depth = unit.place(x).depth_mm;
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  if (nearest < kRoom_mm)
    return input_error(
        "fluoroscopy.source_mm",
        fmt::format("the source of X-rays, {:g} mm from the detector and {:g} mm from the gland, would be "
                    "in the patient or less than {:g} mm from the skin",
                    settings.source_mm, unit.source_distance_mm, kRoom_mm),
        fmt::format("Give {:.0f} mm or more, or a smaller fluoroscopy.detector_mm",
                    std::ceil(settings.source_mm + kRoom_mm - nearest)));
  const double behind = farthest - unit.source_distance_mm;
  if (behind + kRoom_mm > settings.detector_mm)
    return input_error("fluoroscopy.detector_mm",
                       fmt::format("the detector, {:g} mm from the gland, would be in the patient or less than {:g} mm "
                                   "from the skin",
                                   settings.detector_mm, kRoom_mm),
                       fmt::format("Give {:.0f} mm or more", std::ceil(behind + kRoom_mm)));
  return Ok{};
}

/// The empty picture of an X-ray unit, in the plane through its centre.
GreyPicture picture_of_unit(const XrayGeometry& unit) {
  GreyPicture picture;
  picture.columns = picture.rows = unit.pixels;
  picture.mm_per_pixel = unit.pixel_mm;
  picture.right = unit.right;
  picture.down = -unit.up;
  picture.corner_mm = unit.centre_mm - unit.middle() * unit.pixel_mm * (picture.right + picture.down);
  picture.pixels.resize(static_cast<std::size_t>(unit.pixels) * static_cast<std::size_t>(unit.pixels));
  return picture;
}

}  // namespace

struct Fluoroscope::Parts {
  Parts(const TetMesh& mesh, const FluoroscopySettings& s, const XrayGeometry& u)
      : settings(s),
        unit(u),
        surfaces(mesh, s),
        catheter(mesh, s),
        detector(s),
        steel_per_mm(attenuation_per_mm(XrayMaterial::iron, s.energy_keV)),
        seed{attenuation_per_mm(XrayMaterial::titanium, s.energy_keV),
             attenuation_per_mm(XrayMaterial::silver, s.energy_keV)},
        picture(picture_of_unit(u)),
        transmission(picture.pixels.size()) {}

  /// Turns sums of μ · length along the central ray into the share of photons that come through.
  void transmit() {
    const double per_pixel = unit.pixel_mm / unit.source_distance_mm;
    const Eigen::Index n = unit.pixels;
    for (Eigen::Index row = 0; row < n; ++row) {
      Eigen::Map<Eigen::ArrayXf> sums(&transmission[static_cast<std::size_t>(row * n)], n);
      const auto down = static_cast<float>(per_pixel * (static_cast<double>(row) - unit.middle()));
      const auto half = static_cast<float>(per_pixel * unit.middle());
      const auto across = Eigen::ArrayXf::LinSpaced(n, -half, half);
      sums = (-sums * (1.0F + down * down + across.square()).sqrt()).exp();
    }
  }

  FluoroscopySettings settings;
  XrayGeometry unit;
  XraySurfaces surfaces;
  XrayCatheter catheter;
  XrayDetector detector;
  double steel_per_mm;
  SeedAttenuation seed;
  GreyPicture picture;
  std::vector<float> transmission;  ///< sums of μ · length while a picture is made
};

Fluoroscope::Fluoroscope(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Fluoroscope::~Fluoroscope() = default;

Result<std::unique_ptr<Fluoroscope>> Fluoroscope::create(const TetMesh& mesh, const FluoroscopySettings& settings) {
  const XrayGeometry unit = xray_geometry(settings, centroid(mesh, find_target(mesh)));
  if (const Result<> checked = check_distances(mesh, settings, unit); !checked) return checked.error();
  return std::unique_ptr<Fluoroscope>(new Fluoroscope(std::make_unique<Parts>(mesh, settings, unit)));
}

const GreyPicture& Fluoroscope::expose(const Moment& moment) {
  Parts& p = *parts_;
  std::fill(p.transmission.begin(), p.transmission.end(), 0.0F);
  p.surfaces.add(p.unit, moment.displacement, p.transmission);
  p.catheter.add(p.unit, moment.displacement, p.transmission);
  for (const ShownNeedle& needle : moment.needles)
    add_tube(p.unit, needle.centreline_mm, needle.diameter_mm, needle.lumen_diameter_mm, p.steel_per_mm,
             p.transmission);
  for (const ShownSeed& seed : moment.seeds) add_seed(p.unit, seed, p.seed, p.transmission);
  p.transmit();
  p.detector.detect(p.transmission, std::bit_cast<std::uint64_t>(moment.time_s));
  XrayDetector::shade(p.unit.pixels, p.detector.optical_depth(), p.picture.pixels);
  p.picture.time_s = moment.time_s;
  return p.picture;
}

const GreyPicture& Fluoroscope::picture() const { return parts_->picture; }
std::span<const float> Fluoroscope::transmission() const { return parts_->transmission; }
std::span<const float> Fluoroscope::optical_depth() const { return parts_->detector.optical_depth(); }
const XrayGeometry& Fluoroscope::geometry() const { return parts_->unit; }
const FluoroscopySettings& Fluoroscope::settings() const { return parts_->settings; }

Result<GreyPicture> without_soft_tissue(const Fluoroscope& low, const Fluoroscope& high) {
  FluoroscopySettings same = high.settings();
  same.energy_keV = low.settings().energy_keV;
  same.random = low.settings().random;
  same.photons = low.settings().photons;
  if (!(same == low.settings()) || low.picture().time_s != high.picture().time_s)
    return input_error("dual-energy subtraction", "the two pictures do not show the same moment from the same place",
                       "Use settings that differ in the energy only");
  if (high.settings().energy_keV <= low.settings().energy_keV)
    return input_error("dual-energy subtraction",
                       fmt::format("the second energy, {:g} keV, is not above the first, {:g} keV",
                                   high.settings().energy_keV, low.settings().energy_keV),
                       "Give a higher second energy");
  const double ratio = attenuation_per_mm(XrayMaterial::soft_tissue, low.settings().energy_keV) /
                       attenuation_per_mm(XrayMaterial::soft_tissue, high.settings().energy_keV);
  const std::span<const float> a = low.optical_depth();
  const std::span<const float> b = high.optical_depth();
  std::vector<float> left(a.size());
  // Soft tissue is put at an optical depth of 1, so that the window takes it for the patient.
  for (std::size_t k = 0; k < left.size(); ++k) left[k] = 1.0F + a[k] - static_cast<float>(ratio) * b[k];
  GreyPicture picture = low.picture();
  XrayDetector::shade(picture.columns, left, picture.pixels);
  return picture;
}

}  // namespace stylet
