// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/imaging/moment.hpp"
#include "stylet/imaging/ultrasound_beams.hpp"

#include <cstdint>
#include <memory>
#include <span>

namespace stylet {

/// Parts of a picture besides speckle, attenuation, interfaces, needles and seeds.
struct UltrasoundFeatures {
  bool anatomy = true;    ///< detail inside the regions: texture, layers of the rectal wall, assumed zones, concretions
  bool artefacts = true;  ///< rings near the transducer, clutter, side lobes, and the receiver's noise
};

/// An ultrasound picture by lines and samples. Valid until the scanner's next picture.
struct PolarPicture {
  UltrasoundBeams beams;
  std::span<const std::uint8_t> grey;  ///< (lines × samples) line by line from the probe's surface outwards; 0 is black
};

/// Width of the beam and where it is narrowest.
struct BeamProfile {
  double frequency_MHz = 6.5;
  double focus_mm = 30.0;
  double focal_elevation_mm = 5.0;

  static constexpr double kSpeed_mm_per_us = 1.54;
  static constexpr double kF = 2.5;               ///< focal length over aperture
  static constexpr double kAxial_mm = 0.30;       ///< full width at half maximum of a point's echo along the line
  static constexpr double kFocalRange_mm = 20.0;  ///< from the focus to where the beam is √2 times as wide

  [[nodiscard]] double wavelength_mm() const { return kSpeed_mm_per_us / frequency_MHz; }
  /// Full width at half maximum of a point's echo across the lines, in the plane [mm]: λF √(1 + ((z − focus)/range)²).
  [[nodiscard]] double lateral_mm(double depth_mm) const;
  /// Full thickness of the slice [mm]; at half of it from the plane an echo is a tenth.
  [[nodiscard]] double elevation_mm(double depth_mm) const;
};

/// Gain of the receiver that is set by hand [dB]: gain_dB, and tgc_dB, which is linear between its depths.
/// @param share of the picture's depth, 0 at the probe … 1
[[nodiscard]] double hand_gain_dB(const UltrasoundSettings& settings, double share);

/// Makes B-mode pictures of the deformed patient.
///
/// The deformed mesh is cut by the plane of the picture; each sample is traced back to its material point, where the
/// speckle is fixed. The method and its sources: docs/theory/ultrasound.md. The constructor allocates, scan() does not.
/// One object is for one thread at a time. The same mesh, settings and moment give the same bits.
class UltrasoundScanner {
 public:
  /// @param mesh undeformed; it must outlive the scanner
  /// @param echoes (regions of the mesh)
  /// Errors: another number of echoes than regions; fewer than 2 lines or samples.
  static Result<UltrasoundScanner> create(const TetMesh& mesh, std::span<const TissueEcho> echoes,
                                          const UltrasoundSettings& settings, const UltrasoundFeatures& features = {});
  /// A scanner of the same patient with other settings. It shares the anatomy, whose painting takes most of the time of
  /// create(), unless settings.random differs. Errors: as create().
  [[nodiscard]] Result<UltrasoundScanner> tuned(const UltrasoundSettings& settings) const;
  ~UltrasoundScanner();
  UltrasoundScanner(UltrasoundScanner&&) noexcept;
  UltrasoundScanner& operator=(UltrasoundScanner&&) noexcept;
  UltrasoundScanner(const UltrasoundScanner&) = delete;
  UltrasoundScanner& operator=(const UltrasoundScanner&) = delete;

  /// The picture of an array of a biplane or endfire probe. @param moment its displacement belongs to the mesh
  PolarPicture scan(const Moment& moment, ProbeKind kind, const ProbePlace& place, UltrasoundArray array);
  /// The picture along given lines, whose numbers of lines and samples are those of the settings.
  PolarPicture scan(const Moment& moment, const UltrasoundBeams& beams);

  /// Power of the echo at a sample of the last picture [dB], before gain and compression: 0 is the mean of the gland's
  /// peripheral zone.
  [[nodiscard]] double level_dB(int line, int sample) const;
  /// The undeformed place [mm] LPS of what the last picture shows at a sample; NaN where no tissue is.
  [[nodiscard]] Vec3 material_mm(int line, int sample) const;

  [[nodiscard]] const BeamProfile& profile() const;
  [[nodiscard]] const UltrasoundSettings& settings() const;
  [[nodiscard]] const TetMesh& mesh() const;

  /// Gain of the receiver with depth: compensates this attenuation [dB/(cm MHz)], one way.
  static constexpr double kCompensated_dB_per_cm_MHz = 0.6;
  /// Level [dB] that is white at a gain of 0.
  static constexpr double kWhite_dB = 24.0;

 private:
  struct Parts;
  explicit UltrasoundScanner(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet
