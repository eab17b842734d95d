// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/near_field/kelvinlet.hpp"
#include "stylet/coupling/near_field/surface_distance.hpp"

#include <array>
#include <limits>
#include <span>

namespace stylet {

/// A border near a place, as a plane: an interface to tissue of another modulus, or a free surface.
struct NearBorder {
  double depth = std::numeric_limits<double>::infinity();  ///< [mm]
  Vec3 inwards = Vec3::UnitZ();                            ///< unit normal, towards the place
  double contrast = 0.0;  ///< δ = (E − E′)/(E + E′), E′ beyond: 1 a free surface, −1 a rigid wall
  int beyond = -1;        ///< region there

  /// 0…1: how much of a force that is spread over epsilon [mm] is felt as one on the interface.
  [[nodiscard]] double weight(double epsilon) const;
};

/// The nearest border, and the nearest that faces it: of a thin layer both count.
using NearBorders = std::array<NearBorder, 2>;

/// The needle as the tissue near it feels it.
struct NeedleKernel {
  double radius_mm = 0.635;
  double segment_mm = 4.0;  ///< of shaft that a contact stands for: the spacing of contacts

  /// [mm] A force that is spread over this radius strains tissue by a few hundredths, where it is still linear. So much
  /// of the tip's field as such a force has belongs to the organs; the rest is of the needle's own scale, and stiffens
  /// (docs/theory/stiffening.md). Raised, more of the tip's compliance stiffens.
  static constexpr double kScale_mm = 10.0;

  /// √e R: a line of regularised forces on the axis with this radius moves the medium like a bonded rigid cylinder of
  /// radius R, laterally and axially, for every Poisson ratio (docs/theory/near_field.md §2).
  [[nodiscard]] double shaft_epsilon() const;

  /// The tip as the flat end of a rod that slides in its hole, on a free surface a flat punch of stiffness 2RE/(1−ν²):
  /// as other places feel it. @param skin near the tip
  [[nodiscard]] double tip_epsilon(const NearSurface& skin, double poisson) const;
  /// The same as the tip feels itself, by tip_kernel(): before an interface like the flat punch as well, the more so
  /// the softer the tissue on one side.
  [[nodiscard]] double own_tip_epsilon(const NearSurface& skin, const NearBorders& borders, double poisson) const;

  /// What the tip's own compliance is more than the half space's at a depth below a free surface it was pressed on
  /// [mm/N]. The linear dent is so steep that it would turn the tissue under it inside out, and a tip that has broken
  /// the surface would meet a growing force. So the compliance falls over depth no faster than to let the tip through,
  /// until it has come down to the half space's (docs/theory/near_field.md §5). Zero at the surface and from there on.
  /// Does not depend on surface.share.
  /// @param press [N] force that made the dent @param stiffening_MPa k₂ of DentLaw there, 0 = linear tissue
  [[nodiscard]] Mat3 dent(const NearSurface& surface, double press, const Medium& medium,
                          double stiffening_MPa = 0.0) const;

 private:
  [[nodiscard]] Mat3 tip_self(const NearSurface& surface, const Medium& medium) const;
};

/// Displacement of a tip per force on itself, with the borders near it [mm/N] (docs/theory/near_field.md, section 4).
/// With one border exact for a Poisson ratio of ½ far from it and on it; of several each adds as much stiffness as it
/// would alone.
/// @param epsilon own_tip_epsilon(), or of a force that is spread wider
Mat3 tip_kernel(const NearSurface& skin, const NearBorders& borders, double epsilon, const Medium& medium);

/// The kernel g, which knows of the skin, corrected for the borders between organs [mm/N].
/// @param epsilon [mm] over which g spreads a force
Mat3 with_borders(const Mat3& g, const NearSurface& skin, const NearBorders& borders, double epsilon, double poisson);

/// How many times as far as without the borders a force that is spread over epsilon [mm] moves its own place, in the
/// direction in which that is least; on a border as far as it moves the tissue beyond.
double least_share(const NearBorders& borders, double epsilon, double poisson);

/// least_share() of a kernel that has the image of a free surface already: with both, over that with the surface alone.
/// A surface that lies beyond softer tissue adds less than it would in one medium.
double least_share_below(const NearSurface& skin, const NearBorders& borders, double epsilon, double poisson);

/// The medium's kernel between two points, of a force spread over epsilon [mm], with the image of a free surface near
/// them [mm/N]. @param r [mm] from the force to the point that it moves @param skin_at surface nearest to that point
Mat3 point_kernel(const Vec3& r, const NearSurface& skin_at, const NearSurface& skin_on, double epsilon,
                  const Medium& medium);

/// ⟨G⟩: the medium's kernel averaged over two pieces of needle, with the image of a free surface near them [mm/N].
/// @param skin_at surface nearest to the centre of the piece `at`
Mat3 needle_kernel(const Segment& at, const NearSurface& skin_at, const Segment& on, const NearSurface& skin_on,
                   double epsilon, const Medium& medium);

}  // namespace stylet
