// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// Published measurements with which rows are compared. Each states how it was read: in its source, in the source's
/// abstract, or at second hand, that is in other people's notes on the source. docs/validation.md has the list.
namespace stylet::validate::published {

struct Measured {
  double mean;
  double deviation;  ///< one standard deviation
};

/// Bovine liver ex vivo, bevelled 18G needle, 3 mm/s. A. M. Okamura, C. Simone, M. D. O'Leary, Force modeling for
/// needle insertion into soft tissue, IEEE Trans. Biomed. Eng. 51 (2004) 1707–1716. Second hand. @cite Okamura2004
namespace okamura {
inline constexpr Measured kPuncture{2.304, 0.829};      ///< [N] 19 insertions
inline constexpr Measured kPunctureDepth{16.65, 3.55};  ///< [mm]
inline constexpr Measured kDrop{0.658, 0.564};          ///< [N] drop of the force at the puncture
inline constexpr Measured kCutting{0.94, 0.36};         ///< [N] 5 insertions
inline constexpr double kStatic_N_per_m = 18.45;
inline constexpr double kCoulomb_N_per_m = 10.57;
inline constexpr double kViscous_Ns_per_m2 = 212.3;
inline constexpr double kSpeed_mm_per_s = 3.0;

/// Force [N] on the tip before the puncture, at a depth [mm].
inline double stiffness_N(double z_mm) { return 0.0480 * z_mm + 0.0052 * z_mm * z_mm; }

/// The same for another set of insertions, whose depth of puncture is not known.
inline double other_stiffness_N(double z_mm) { return 0.0020 * z_mm + 0.0023 * z_mm * z_mm; }

/// Modulus of linear tissue in which a flat punch of the needle's diameter has the same force at the mean depth of the
/// puncture: F/z = 2 R E / (1 − ν²).
inline double modulus_kPa(double diameter_mm, double poisson) {
  const double z = kPunctureDepth.mean;
  return 1e3 * stiffness_N(z) / z * (1.0 - poisson * poisson) / diameter_mm;
}
}  // namespace okamura

/// PVC gel, 17G, 1 mm/s. S. P. DiMaio, S. E. Salcudean, Needle insertion modeling and simulation, IEEE Trans. Robot.
/// Autom. 19 (2003) 864–875. Second hand. @cite DiMaio2003
namespace dimaio {
inline constexpr double kYoung_kPa = 25.3;
inline constexpr double kPoisson = 0.48;
inline constexpr double kPuncture_N = 0.7;
inline constexpr double kFriction_N_per_m = 34.0;
inline constexpr double kSpeed_mm_per_s = 1.0;
inline constexpr double kDepth_mm = 70.0;
/// Additional force of the tip: near the tip, over about 5 mm, the force density reaches 68 N/m instead of 34 N/m.
inline constexpr double kTipExcess_N = (68.0 - 34.0) * 5e-3;
}  // namespace dimaio

/// Medians over 99 papers. D. J. van Gerwen, J. Dankelman, J. J. van den Dobbelsteen, Needle–tissue interaction forces:
/// a survey of experimental data, Med. Eng. Phys. 34 (2012) 665–680. Second hand. @cite vanGerwen2012
namespace vanGerwen {
inline constexpr double kPuncture_N = 1.22;
inline constexpr double kCutting_N = 0.95;
}  // namespace vanGerwen

/// Prostate in vivo and in a phantom.
namespace prostate {
/// Mean motion of the gland for one needle that is pushed, and for one that is tapped in. Lagerburg et al.,
/// Radiother. Oncol. (2006). NOT VERIFIED: the source has not been read.
inline constexpr double kPushedShift_mm = 5.6;
inline constexpr double kTappedShift_mm = 0.9;
/// Displacement towards the head in a phantom that was built to be movable: the largest value with needles placed at
/// high speed, and the value to which a pneumatic device reduced it. There is no value for slow needles. P. McLaughlin
/// et al., The challenge of base depth needle placement in prostate brachytherapy, AAPM 2022. Abstract.
inline constexpr double kPhantomHighSpeed_mm = 20.0;
inline constexpr double kPhantomPneumatic_mm = 1.0;
/// Mean seed misplacement by axis [cm]: lateral, sagittal, axial (1,197 seeds of 357 needles in 15 patients, all causes
/// together). Abstract.
inline constexpr double kSeedX_cm = 0.13;
inline constexpr double kSeedY_cm = 0.15;
inline constexpr double kSeedZ_cm = 0.38;
/// Largest displacement of gold markers in the gland [mm] per axis in 18 patients, between two scans that were two
/// weeks apart and registered by the gland, with an implant of many needles between them (Radiat. Oncol. 7 (2012) 24).
/// Abstract.
inline constexpr double kMarkerLateral_mm = 7.0;
inline constexpr double kMarkerSagittal_mm = 5.0;
inline constexpr double kMarkerAxial_mm = 12.0;
}  // namespace prostate

/// Displacement of the prostate's base with 12 to 19 needles in place. N. N. Stone and others, 2004, PubMed 15090279.
/// Abstract.
namespace base {
inline constexpr double kMedian_mm = 15.0;
}  // namespace base

/// Plans of permanent seeds of I-125 for three glands and three strengths, 9,000 in all, with random errors of the
/// seeds' places: the standard deviation on each axis, and the least share of the prescribed dose that D90 was in all
/// of them
/// ("acceptable target coverage under the D90/90 criterion"). PubMed 16515813. Abstract.
namespace d90 {
inline constexpr double kSigma_mm = 4.0;
inline constexpr double kLeast = 0.9;
}  // namespace d90

/// Change of the gland's extents and volume [%] by an endorectal coil, 79 patients. M. Osman et al. 2014. Second hand.
namespace osman {
inline constexpr Measured kDepth{-8.6, 7.8};  ///< anterior-posterior
inline constexpr Measured kWidth{4.5, 5.8};   ///< left-right
inline constexpr Measured kLength{8.8, 6.9};  ///< superior-inferior
inline constexpr Measured kVolume{0.6, 5.7};
}  // namespace osman

/// The same by an endorectal balloon of 50 ml, 44 patients; means. Second hand, not verified.
namespace balloon50 {
inline constexpr double kDepth_percent = 15.7;  ///< flatter, 5.5 mm
inline constexpr double kWidth_percent = 7.7;
inline constexpr double kLength_percent = 6.3;
}  // namespace balloon50

}  // namespace stylet::validate::published
