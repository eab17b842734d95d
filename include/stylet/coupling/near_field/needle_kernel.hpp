// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/near_field/kelvinlet.hpp"
#include "stylet/coupling/near_field/surface_distance.hpp"

#include <array>
#include <limits>
#include <span>

namespace stylet {

/// A border near a place, as a plane: an interface with tissue of another modulus, or a free surface.
struct NearBorder {
  double depth = std::numeric_limits<double>::infinity();  ///< [mm] distance of the place from the border
  Vec3 inwards = Vec3::UnitZ();                            ///< unit normal, towards the place
  double contrast = 0.0;  ///< δ = (E − E′)/(E + E′), E′ beyond the border: 1 for a free surface, −1 for a rigid wall
  int beyond = -1;  ///< region beyond the border

  /// Share 0 … 1 of a force spread over epsilon [mm] at the place that acts as a force on the border itself.
  [[nodiscard]] double weight(double epsilon) const;
};

/// The nearest border, and the nearest one that faces it: in a thin layer both matter.
using NearBorders = std::array<NearBorder, 2>;

/// The needle's kernel: how a force of the needle moves the tissue near it.
struct NeedleKernel {
  double radius_mm = 0.635;
  double segment_mm = 4.0;  ///< length of shaft that a contact stands for: the spacing of contacts

  /// [mm] Radius that separates the wide part of the tip's field from the narrow part. A force that is spread over this
  /// radius strains tissue by a few hundredths, where tissue is still linear. The field of such a force belongs to the
  /// organs; the rest has the needle's own scale and stiffens (docs/theory/stiffening.md). With a larger value
  /// more of the tip's compliance stiffens.
  static constexpr double kScale_mm = 10.0;

  /// [mm] ε of the shaft, √e R: a line of regularised forces on the axis with this ε moves the medium like a bonded
  /// rigid cylinder of radius R, laterally and axially, for every Poisson ratio (docs/theory/near_field.md §2).
  [[nodiscard]] double shaft_epsilon() const;

  /// [mm] ε of the tip for the displacement of other places. The tip is the flat end of a rod that slides in its hole;
  /// on a free surface it is a flat punch of stiffness 2RE/(1−ν²).
  /// @param skin the free surface near the tip
  [[nodiscard]] double tip_epsilon(const NearSurface& skin, double poisson) const;
  /// [mm] ε of the tip for its own displacement, for tip_kernel(). Near an interface it approaches the ε of the
  /// flat punch as well, and the more so the softer the tissue on one side is.
  [[nodiscard]] double own_tip_epsilon(const NearSurface& skin, const NearBorders& borders, double poisson) const;

  /// The tip's own compliance minus the half space's compliance [mm/N], at a depth below the free surface through which
  /// the tip entered. In the half space a dent would be so steep that it turned the tissue under it inside out, and the
  /// force on a tip that has broken the surface would grow. The tip's compliance therefore falls with depth no faster
  /// than by equation (4) of docs/theory/near_field.md §5, until it equals the half space's compliance. The difference
  /// is zero at the surface and beyond the depth of equality. It does not depend on surface.share.
  /// @param press [N] force that made the dent
  /// @param stiffening_MPa k₂ of DentLaw there, 0: linear tissue
  [[nodiscard]] Mat3 dent(const NearSurface& surface, double press, const Medium& medium,
                          double stiffening_MPa = 0.0) const;

 private:
  [[nodiscard]] Mat3 tip_self(const NearSurface& surface, const Medium& medium) const;
};

/// Displacement of the tip per force on itself, with the borders near it [mm/N] (docs/theory/near_field.md §4). With
/// one border it is exact for a Poisson ratio of ½, far from the border and on it; of several borders, each adds the
/// stiffness that it would add alone.
/// @param epsilon [mm] own_tip_epsilon(), or the radius of a force that is spread wider
Mat3 tip_kernel(const NearSurface& skin, const NearBorders& borders, double epsilon, const Medium& medium);

/// The mesh kernel g, which includes the image of the skin, corrected for the borders between organs [mm/N].
/// @param epsilon [mm] radius over which g spreads a force
Mat3 with_borders(const Mat3& g, const NearSurface& skin, const NearBorders& borders, double epsilon, double poisson);

/// Displacement of a place by its own force, spread over epsilon [mm], divided by the displacement without the
/// borders, in the direction in which this ratio is least. On a border it equals the ratio for the tissue beyond.
double least_share(const NearBorders& borders, double epsilon, double poisson);

/// least_share() for a kernel that already has the image of a free surface: the ratio with surface and borders over the
/// ratio with the surface alone. A surface that lies beyond softer tissue adds less than it would in one medium.
double least_share_below(const NearSurface& skin, const NearBorders& borders, double epsilon, double poisson);

/// The medium's kernel between two points for a force spread over epsilon [mm], with the image of a free surface near
/// them [mm/N].
/// @param r [mm] vector from the force to the displaced point
/// @param skin_at surface nearest to the displaced point
Mat3 point_kernel(const Vec3& r, const NearSurface& skin_at, const NearSurface& skin_on, double epsilon,
                  const Medium& medium);

/// ⟨G⟩: the medium's kernel averaged over two pieces of the needle, with the image of a free surface near them [mm/N].
/// @param skin_at surface nearest to the centre of the piece `at`
Mat3 needle_kernel(const Segment& at, const NearSurface& skin_at, const Segment& on, const NearSurface& skin_on,
                   double epsilon, const Medium& medium);

}  // namespace stylet
