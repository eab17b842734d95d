// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace stylet {

/// The kind of probe in the rectum while pictures are made.
enum class ProbeKind {
  none,
  biplane,  ///< a rod with a transverse and a sagittal array near its rounded end
  endfire,  ///< a rod whose array is in its end and looks along the axis
};

/// The array of the probe that makes the picture.
enum class UltrasoundArray { transverse, sagittal };

/// The transrectal probe and where its stepper holds it: the keys of [probe].
///
/// At rest the axis of the probe is along z, superior, through the middle of the rectum at the level of the gland. The
/// stepper moves it from there: along its axis (depth), anterior (lift), about a left-right axis at the anus (tilt) and
/// about its own axis (roll).
struct ProbeSettings {
  ProbeKind kind = ProbeKind::none;
  double diameter_mm = 20.0;
  double balloon_mm = 0.0;         ///< thickness of the water between probe and wall, all around
  std::optional<double> depth_mm;  ///< LPS z of the transverse array; unset: the middle of the gland
  double step_mm = 5.0;            ///< motion of one click of the stepper
  double lift_mm = 0.0;            ///< anterior motion from rest
  double tilt_deg = 0.0;           ///< positive: the end of the probe goes anterior
  double roll_deg = 0.0;           ///< positive: the sagittal array turns to the patient's left
  /// The contours were drawn with the probe at this lift, tilt and depth: then this place of the probe displaces
  /// nothing.
  bool in_contours = false;
  bool operator==(const ProbeSettings&) const = default;
};

/// The ultrasound scanner: the keys of [ultrasound].
struct UltrasoundSettings {
  UltrasoundArray array = UltrasoundArray::transverse;
  double frequency_MHz = 6.5;
  double depth_mm = 90.0;     ///< from the probe's surface
  double sector_deg = 140.0;  ///< width of the transverse picture
  double length_mm = 65.0;    ///< of the sagittal array
  int lines = 256;
  int samples = 560;          ///< along a line
  double focus_mm = 30.0;     ///< from the probe's surface
  double elevation_mm = 5.0;  ///< full thickness of the slice at the focus
  double gain_dB = 0.0;
  /// Additional gain by depth (time gain compensation), at four depths from the probe's surface to the far end.
  std::array<double, 4> tgc_dB{0.0, 0.0, 0.0, 0.0};
  double dynamic_range_dB = 60.0;
  int random = 1;  ///< seed of the speckle
  bool operator==(const UltrasoundSettings&) const = default;
};

/// The X-ray unit: the keys of [fluoroscopy].
struct FluoroscopySettings {
  double angle_deg = 0.0;  ///< of the C-arm about the patient's axis; positive: the detector goes to the patient's left
  double cranial_deg = 0.0;                ///< positive: the detector goes superior
  double energy_keV = 60.0;                ///< of the photons, as if they had one energy
  double source_mm = 1000.0;               ///< distance of source and detector
  double detector_mm = 350.0;              ///< distance of detector and gland
  double field_mm = 200.0;                 ///< width of the square picture, at the gland
  int pixels = 512;                        ///< along a side
  double bladder_iodine_mg_per_ml = 20.0;  ///< contrast in the bladder; 0 = none
  bool catheter = true;                    ///< a catheter with contrast in the urethra
  int photons = 20000;                     ///< per pixel without a patient, which give the noise; 0 = no noise
  int random = 1;                          ///< seed of the noise
  bool operator==(const FluoroscopySettings&) const = default;
};

/// Echo and attenuation of ultrasound in a tissue: keys of [tissue.NAME].
struct TissueEcho {
  double echo_dB = 0.0;                    ///< strength of the speckle, relative to the gland's peripheral zone
  double attenuation_dB_per_cm_MHz = 0.5;  ///< one way
  std::string source;                      ///< where the values come from
  bool operator==(const TissueEcho&) const = default;
};

/// Default values for a region by its canonical name. Unknown names get those of the soft tissue around the gland.
TissueEcho default_echo(const std::string& region);

}  // namespace stylet
