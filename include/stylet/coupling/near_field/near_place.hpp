// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/near_field/mesh_kernel.hpp"
#include "stylet/coupling/near_field/needle_kernel.hpp"
#include "stylet/fem/spread_compliance.hpp"
#include "stylet/fem/tissue.hpp"
#include "stylet/geom/locator.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

/// A place in the tissue, with the values that the kernels of needle and mesh take from it.
struct NearPlace {
  Shape shape;
  Segment piece;
  double epsilon = 0.0;             ///< [mm] of the needle there
  double own_epsilon = 0.0;         ///< [mm] the same as the tip feels itself; of the tip only
  Mat3 mesh_kernel = Mat3::Zero();  ///< [mm/N] g of the mesh there with itself, for E = 1 MPa
  double blur = 0.0;                ///< [mm] over which the mesh spreads a force there, by that
  double share = 1.0;               ///< least_share() of the needle there
  double wide_share = 1.0;          ///< the same of a force that is spread over NeedleKernel::kScale_mm
  SpreadCompliance::Place spread;   ///< among the samples of the ways, where there are such
  int medium = 0;
  double young_MPa = 0.0;  ///< 0: the place belongs to no medium of its own
  NearSurface skin;
  NearBorders borders;
  int region = -1;     ///< −1: the place belongs to none of its own
  double edge = 0.0;   ///< [mm] size of the elements there
  double moves = 1.0;  ///< 0…1: weight of the element's nodes that are not held
};

/// The place of a material point at x [mm], undeformed; its epsilon is the caller's to say. The kernel must have the
/// corners of its element.
NearPlace near_place(const Tissue& tissue, const MeshKernel& kernel, const MaterialPoint& at, const Vec3& x);

/// Makes a place that of the needle's tip.
void take_tip_radii(const NeedleKernel& needle, const MeshKernel& kernel, NearPlace& tip);

/// k₂ of DentLaw where a tip is. On an interface it is that of the tissue that stiffens more.
/// @param of k₂ of a region [MPa]
template <class OfRegion>
double stiffening_of(const NearPlace& tip, const OfRegion& of) {
  const double own = of(tip.region);
  double more = 0.0;
  for (const NearBorder& border : tip.borders) {
    if (border.beyond >= 0) more = std::max(more, border.weight(tip.own_epsilon) * (of(border.beyond) - own));
  }
  return own + more;
}

/// A place where the needle is not, as on a surface: between some nodes of the mesh, at `x` [mm], undeformed, in the
/// medium of whatever acts on it. The kernel must have these nodes.
NearPlace passive_place(const Tissue& tissue, const MeshKernel& kernel, const Shape& between, const Vec3& x);

/// `here`, as a force at `on` sees a place that is passive_place(): such a place has no radius of its own, and no
/// medium.
NearPlace acted_on_by(NearPlace here, const NearPlace& on);

/// Whether the correction between two places is not zero, being further apart than elements need, or across a gap of
/// air.
bool needs_correction(const MeshKernel& kernel, const NearPlace& at, const NearPlace& on);

/// g(at, on) of the mesh for E = 1 MPa [mm/N].
Mat3 mesh_kernel_between(const MeshKernel& kernel, const Shape& at, const Shape& on, int medium);

/// A kernel between two places, which are in the same medium or in two: for E = 1 MPa in either, over the mean of their
/// moduli, as a force on one side of a border moves the other side (docs/theory/near_field.md §3). 1/(Eᵢ + Eⱼ) are the
/// entries of a positive definite matrix (Cauchy's), so multiplying by them makes nothing indefinite.
/// @param for_unit of a medium, for E = 1 MPa
template <class ForUnit>
Mat3 between_media(const NearPlace& at, const NearPlace& on, const ForUnit& for_unit) {
  const double share = 2.0 * at.moves * on.moves / (at.young_MPa + on.young_MPa);
  if (at.medium == on.medium) return share * for_unit(at.medium);
  return 0.5 * share * (for_unit(at.medium) + for_unit(on.medium));
}

/// Difference of the needle's kernel from the mesh's: displacement of `at` per force on `on` [mm/N] (docs/theory/
/// near_field.md, section 1). @param g g(at, on) for E = 1 MPa in a medium
template <class OfMesh>
Mat3 near_correction(const MeshKernel& kernel, const NearPlace& at, const NearPlace& on, const OfMesh& g) {
  if (!needs_correction(kernel, at, on)) return Mat3::Zero();
  const double epsilon = std::sqrt(at.epsilon * on.epsilon);
  // The same factor on rows and columns makes nothing indefinite.
  const double share = at.region == on.region ? std::sqrt(at.share * on.share) : 1.0;
  return share * between_media(at, on, [&](int medium) -> Mat3 {
           return needle_kernel(at.piece, at.skin, on.piece, on.skin, epsilon, kernel.medium(medium)) - g(medium);
         });
}

/// near_correction() of the tip's own force, with the borders near it.
/// @param g g(tip, tip) of the mesh for E = 1 MPa in the tip's medium
Mat3 tip_correction(const MeshKernel& kernel, const NearPlace& tip, const Mat3& g);

/// near_correction() for a force that is spread over NeedleKernel::kScale_mm, instead of the needle's: what the wide
/// part of the compliance has beyond the mesh's [mm/N]. Symmetric. @param g as near_correction()
template <class OfMesh>
Mat3 wide_correction(const MeshKernel& kernel, const NearPlace& at, const NearPlace& on, const OfMesh& g) {
  const bool corrects = needs_correction(kernel, at, on);
  const double epsilon = std::sqrt(at.epsilon * on.epsilon);
  return between_media(at, on, [&](int medium) -> Mat3 {
    const auto spread_over = [&](double radius_mm) {
      return point_kernel(at.piece.centre - on.piece.centre, at.skin, on.skin, radius_mm, kernel.medium(medium));
    };
    return spread_over(NeedleKernel::kScale_mm) - (corrects ? Mat3(g(medium)) : spread_over(epsilon));
  });
}

/// wide_correction() of the tip's own force. @param g as tip_correction()
Mat3 tip_wide_correction(const MeshKernel& kernel, const NearPlace& tip, const Mat3& g);

/// The displacement by a force on a piece of the needle less that by the same force spread over NeedleKernel::kScale_mm
/// [mm/N], in closed form, between places in one medium or in two. Added to SpreadCompliance it gives the compliance.
Mat3 narrow_part(const MeshKernel& kernel, const NearPlace& at, const NearPlace& on);

/// narrow_part() of the tip's own force.
Mat3 tip_narrow_part(const MeshKernel& kernel, const NearPlace& tip);

/// How many times softer than its own medium the mesh has a place, as far as it can tell: 1 away from borders. On a
/// border between organs both sides are as soft as a medium of the mean of their moduli, by equation (4a) of
/// near_field.md; in a thin soft layer a place is stiffer still, and what is left of `far` when the mesh's kernel is
/// replaced by the wide one has to stay positive.
/// @param far the mesh's compliance of the place with itself [mm/N] @param g of the mesh there, for E = 1 MPa
double softness_in_mesh(const MeshKernel& kernel, const NearPlace& place, const Mat3& far, const Mat3& g);

}  // namespace stylet
