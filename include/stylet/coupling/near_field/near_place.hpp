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

/// A place in the tissue, with the values that the kernels of needle and mesh need there.
struct NearPlace {
  Shape shape;
  Segment piece;
  double epsilon = 0.0;             ///< [mm] radius over which the needle's force is spread there
  double own_epsilon = 0.0;         ///< [mm] only for the tip: as epsilon, for the tip's displacement by its own force
  Mat3 mesh_kernel = Mat3::Zero();  ///< [mm/N] g of the mesh between the place and itself, for E = 1 MPa
  double blur = 0.0;                ///< [mm] radius over which the mesh spreads a force there, from mesh_kernel
  double share = 1.0;               ///< least_share() of the needle there
  double wide_share = 1.0;          ///< least_share() of a force that is spread over NeedleKernel::kScale_mm
  SpreadCompliance::Place spread;   ///< place among the samples of the planned paths, where there are any
  int medium = 0;
  double young_MPa = 0.0;  ///< 0: the place has no medium of its own
  NearSurface skin;
  NearBorders borders;
  int region = -1;     ///< −1: the place has no region of its own
  double edge = 0.0;   ///< [mm] size of the elements there
  double moves = 1.0;  ///< 0 … 1: weight of those nodes of the element that are not held
};

/// The place of a material point at x [mm], undeformed. The caller has to set NearPlace::epsilon. The kernel must have
/// rows for the corners of the element.
NearPlace near_place(const Tissue& tissue, const MeshKernel& kernel, const MaterialPoint& at, const Vec3& x);

/// Sets the radii of a place to those of the needle's tip.
void take_tip_radii(const NeedleKernel& needle, const MeshKernel& kernel, NearPlace& tip);

/// k₂ of DentLaw at the tip. On an interface it is the larger k₂ of the two sides.
/// @param of function: k₂ of a region [MPa]
template <class OfRegion>
double stiffening_of(const NearPlace& tip, const OfRegion& of) {
  const double own = of(tip.region);
  double more = 0.0;
  for (const NearBorder& border : tip.borders) {
    if (border.beyond >= 0) more = std::max(more, border.weight(tip.own_epsilon) * (of(border.beyond) - own));
  }
  return own + more;
}

/// A place without a needle, such as a point of a surface: interpolated between nodes of the mesh, at `x` [mm],
/// undeformed. acted_on_by() gives it the medium of the force that acts on it. The kernel must have rows for these
/// nodes.
NearPlace passive_place(const Tissue& tissue, const MeshKernel& kernel, const Shape& between, const Vec3& x);

/// The passive_place() `here` with the radius and the medium of the place `on` where the force acts, since a passive
/// place has neither.
NearPlace acted_on_by(NearPlace here, const NearPlace& on);

/// Whether near_correction() between two places is applied. It is zero where the places are so far apart that elements
/// represent the field, and across a gap of air.
bool needs_correction(const MeshKernel& kernel, const NearPlace& at, const NearPlace& on);

/// g(at, on) of the mesh for E = 1 MPa [mm/N].
Mat3 mesh_kernel_between(const MeshKernel& kernel, const Shape& at, const Shape& on, int medium);

/// A kernel between two places in one medium or in two: the kernel for E = 1 MPa, averaged over the two media, over the
/// mean of their moduli. This is how a force on one side of a border moves the other side (docs/theory/near_field.md
/// §4). The matrix of 1/(Eᵢ + Eⱼ) is positive definite (Cauchy's), so multiplying by its entries keeps A positive
/// definite.
/// @param for_unit function: the kernel in a medium, for E = 1 MPa
template <class ForUnit>
Mat3 between_media(const NearPlace& at, const NearPlace& on, const ForUnit& for_unit) {
  const double share = 2.0 * at.moves * on.moves / (at.young_MPa + on.young_MPa);
  if (at.medium == on.medium) return share * for_unit(at.medium);
  return 0.5 * share * (for_unit(at.medium) + for_unit(on.medium));
}

/// The needle's kernel minus the mesh's: displacement of `at` per force on `on` [mm/N] (docs/theory/near_field.md §1).
/// @param g function: g(at, on) in a medium, for E = 1 MPa
template <class OfMesh>
Mat3 near_correction(const MeshKernel& kernel, const NearPlace& at, const NearPlace& on, const OfMesh& g) {
  if (!needs_correction(kernel, at, on)) return Mat3::Zero();
  const double epsilon = std::sqrt(at.epsilon * on.epsilon);
  // Scaling rows and columns by the same factors keeps A positive definite.
  const double share = at.region == on.region ? std::sqrt(at.share * on.share) : 1.0;
  return share * between_media(at, on, [&](int medium) -> Mat3 {
           return needle_kernel(at.piece, at.skin, on.piece, on.skin, epsilon, kernel.medium(medium)) - g(medium);
         });
}

/// near_correction() for the tip's own force, with the borders near it.
/// @param g g(tip, tip) of the mesh in the tip's medium, for E = 1 MPa
Mat3 tip_correction(const MeshKernel& kernel, const NearPlace& tip, const Mat3& g);

/// near_correction() for a force that is spread over NeedleKernel::kScale_mm instead of the needle's radius: the part
/// of the wide compliance that the mesh lacks [mm/N]. Symmetric. @param g as in near_correction()
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

/// wide_correction() for the tip's own force. @param g as in tip_correction()
Mat3 tip_wide_correction(const MeshKernel& kernel, const NearPlace& tip, const Mat3& g);

/// Displacement by a force on a piece of the needle, minus the displacement by the same force spread over
/// NeedleKernel::kScale_mm [mm/N], in closed form, between places in one medium or in two. The sum with
/// SpreadCompliance is the compliance.
Mat3 narrow_part(const MeshKernel& kernel, const NearPlace& at, const NearPlace& on);

/// narrow_part() for the tip's own force.
Mat3 tip_narrow_part(const MeshKernel& kernel, const NearPlace& tip);

/// Ratio of the mesh's compliance at a place to the compliance in the place's own medium, as far as the mesh represents
/// it: 1 away from borders. On a border between organs both sides are as soft as a medium with the mean of their
/// moduli, by equation (4a) of near_field.md. In a thin soft layer the place is stiffer than this. The ratio is limited
/// so that the remainder of `far` stays positive when the wide kernel replaces the mesh's kernel.
/// @param far [mm/N] the mesh's compliance between the place and itself
/// @param g of the mesh there, for E = 1 MPa
double softness_in_mesh(const MeshKernel& kernel, const NearPlace& place, const Mat3& far, const Mat3& g);

}  // namespace stylet
