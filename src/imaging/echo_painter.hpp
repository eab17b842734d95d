// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smooth_noise.hpp"
#include "stylet/imaging/tissue_role.hpp"

#include <Eigen/Geometry>

#include <cstdint>

namespace stylet {

/// Where a point lies in the undeformed patient. Depths below an organ's surface are negative outside of the organ, and
/// at least −kReach_mm.
struct EchoSpot {
  static constexpr double kReach_mm = 12.0;
  Vec3 x;  ///< [mm] LPS
  double gland_mm = -kReach_mm, urethra_mm = -kReach_mm, bladder_mm = -kReach_mm;
  double rectum_mm = -kReach_mm;  ///< depth below the outer surface of the rectum's wall
  double lumen_mm = -kReach_mm;   ///< of the rectum
};

/// Strength of the speckle from place to place: the value of a region, and the detail that regions lack.
class EchoPainter {
 public:
  /// @param gland box around the gland
  /// @param has_zones whether the mesh has zones of the gland; without them a transition zone is assumed
  /// @param has_vesicles whether the mesh has seminal vesicles; without them they are assumed
  EchoPainter(const Eigen::AlignedBox3d& gland, bool has_zones, bool has_vesicles, std::uint64_t seed);

  /// Level [dB] of soft tissue, at most kSoft_dB. @param own_dB that of the region
  [[nodiscard]] double level_dB(TissueRole role, double own_dB, const EchoSpot& spot) const;
  /// Level [dB] of a concretion of the gland; kNone_dB where there is none.
  [[nodiscard]] double concretion_dB(TissueRole role, const EchoSpot& spot) const;

  static constexpr double kSoft_dB = 13.0;
  static constexpr double kNone_dB = -200.0;

 private:
  /// The assumed transition zone, in coordinates of the gland.
  struct Zone {
    Vec3 q;        ///< place relative to the middle of the gland's box, in its half sides
    double f;      ///< 1 at the border of the zone, less inside
    double back;   ///< 1 at the zone's posterior border, 0 at its anterior one
    double share;  ///< 1 inside of the zone
  };
  [[nodiscard]] Zone zone(const EchoSpot& spot) const;
  [[nodiscard]] Vec3 relative(const Vec3& x) const;
  [[nodiscard]] static double capsule_dB(const EchoSpot& spot);
  [[nodiscard]] double gland_dB(const EchoSpot& spot) const;
  [[nodiscard]] double urethra_dB(const EchoSpot& spot) const;
  [[nodiscard]] static double wall_dB(const EchoSpot& spot);
  [[nodiscard]] double around_dB(double level, const EchoSpot& spot) const;
  [[nodiscard]] double fat_dB(const EchoSpot& spot) const;
  [[nodiscard]] double muscle_dB(const EchoSpot& spot) const;

  Eigen::AlignedBox3d gland_;
  bool has_zones_, has_vesicles_;
  double transition_dB_, vesicles_dB_;
  SmoothNoise fine_, coarse_, third_;
};

}  // namespace stylet
