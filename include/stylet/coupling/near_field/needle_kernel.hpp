// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/near_field/kelvinlet.hpp"
#include "stylet/coupling/near_field/surface_distance.hpp"

namespace stylet {

/// The needle as the tissue near it feels it.
struct NeedleKernel {
  double radius_mm = 0.635;
  double segment_mm = 4.0;  ///< of shaft that a contact stands for: the spacing of contacts

  /// √e R: a line of regularised forces on the axis with this radius moves the medium like a bonded rigid cylinder of
  /// radius R, laterally and axially, for every Poisson ratio (docs/theory/near_field.md §2).
  [[nodiscard]] double shaft_epsilon() const;

  /// The tip: 1.5 R deep inside; at a free surface the radius that gives a flat punch its stiffness 2RE/(1−ν²).
  [[nodiscard]] double tip_epsilon(double depth, double poisson) const;

  /// What the tip's own compliance is more than the half space's at a depth below a free surface it was pressed on
  /// [mm/N]. The linear dent is so steep that it would turn the tissue under it inside out, and a tip that has broken
  /// the surface would meet a growing force. So the compliance falls over depth no faster than to let the tip through,
  /// until it has come down to the half space's (docs/theory/near_field.md §5). Zero at the surface and from there on.
  /// Does not depend on surface.share.
  /// @param press [N] force that made the dent
  [[nodiscard]] Mat3 dent(const NearSurface& surface, double press, const Medium& medium) const;

 private:
  [[nodiscard]] Mat3 tip_self(const NearSurface& surface, const Medium& medium) const;
};

/// ⟨G⟩: the medium's kernel averaged over two pieces of needle, with the image of a free surface near them [mm/N].
/// @param skin_at surface nearest to the centre of the piece `at`
Mat3 needle_kernel(const Segment& at, const NearSurface& skin_at, const Segment& on, const NearSurface& skin_on,
                   double epsilon, const Medium& medium);

}  // namespace stylet
