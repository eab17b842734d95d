// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/split_mesh.hpp"
#include "stylet/fem/tissue.hpp"

namespace stylet {

/// What one of the elements that an added node p splits has of the elastic energy's bilinear form a(·,·) with the
/// node's hat b_p (docs/theory/coupling.md 2b), in three directions at once.
struct HatStiffness {
  Mat3 own = Mat3::Zero();     ///< k_pp = a(b_p, b_p) [N/mm]
  std::array<Mat3, 4> border;  ///< k_jp = a(φ_j, b_p) for the element's vertices j [N/mm]; zero of a node inside it
};

/// @param mesh before the split
HatStiffness hat_stiffness(const SplitMesh& mesh, const SplitMesh::Part& part, const Material& material);

}  // namespace stylet
