// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/locator.hpp"

namespace stylet {

/// Displacement [mm] of the nodes of a mesh, LPS (3 × nodes), which is linear in every tetrahedron.
using NodalDisplacement = Eigen::Ref<const Eigen::Matrix3Xf>;

/// Displacement [mm] of a material point.
Vec3 displacement_of(const TetMesh& mesh, const NodalDisplacement& displacement, const MaterialPoint& at);

/// Where a displacement takes the material point that lies at x [mm] LPS undeformed; x itself outside of the mesh.
Vec3 displaced_place(const Locator& locator, const NodalDisplacement& displacement, const Vec3& x);

/// The undeformed place [mm] LPS of the material point that a displacement has carried to x, to 1e-4 mm, by fixed-point
/// iteration; x itself outside of the tissue.
Vec3 undeformed(const Locator& locator, const NodalDisplacement& displacement, const Vec3& x);

}  // namespace stylet
