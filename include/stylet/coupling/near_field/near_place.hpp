// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/near_field/mesh_kernel.hpp"
#include "stylet/coupling/near_field/needle_kernel.hpp"
#include "stylet/fem/tissue.hpp"
#include "stylet/geom/locator.hpp"

#include <cmath>

namespace stylet {

/// A place in the tissue, with the values that the kernels of needle and mesh take from it.
struct NearPlace {
  Shape shape;
  Segment piece;
  double epsilon = 0.0;  ///< [mm] of the needle there
  int medium = 0;
  double young_MPa = 0.0;  ///< 0: the place belongs to no medium of its own
  NearSurface skin;
  double edge = 0.0;   ///< [mm] size of the elements there
  double moves = 1.0;  ///< 0…1: weight of the element's nodes that are not held
};

/// The place of a material point at x [mm], undeformed; its epsilon is the caller's to say. The kernel must have the
/// corners of its element.
NearPlace near_place(const Tissue& tissue, const MeshKernel& kernel, const MaterialPoint& at, const Vec3& x);

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

/// Difference of the needle's kernel from the mesh's: displacement of `at` per force on `on` [mm/N] (docs/theory/
/// near_field.md, section 1). @param g g(at, on) for E = 1 MPa in a medium
template <class OfMesh>
Mat3 near_correction(const MeshKernel& kernel, const NearPlace& at, const NearPlace& on, const OfMesh& g) {
  if (!needs_correction(kernel, at, on)) return Mat3::Zero();
  const double share = at.moves * on.moves;
  const double epsilon = std::sqrt(at.epsilon * on.epsilon);
  const auto for_unit = [&](int medium) -> Mat3 {  // both are inversely proportional to Young's modulus
    return needle_kernel(at.piece, at.skin, on.piece, on.skin, epsilon, kernel.medium(medium)) - g(medium);
  };
  const double of_at = 0.5 * share / at.young_MPa;
  const double of_on = 0.5 * share / on.young_MPa;
  if (at.medium == on.medium) return (of_at + of_on) * for_unit(at.medium);
  return of_at * for_unit(at.medium) + of_on * for_unit(on.medium);
}

}  // namespace stylet
