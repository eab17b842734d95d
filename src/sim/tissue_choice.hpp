// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/element.hpp"
#include "stylet/fem/material.hpp"
#include "stylet/geom/tet_mesh.hpp"
#include "stylet/sim/scenario.hpp"

#include <span>
#include <vector>

namespace stylet {

/// Largest number of nodes for which tissue.element = "auto" chooses elements with averaged pressure.
inline constexpr Index kMostAveraged = 45000;

/// The parameters of every region of a mesh. Around a probe, a rectum without a lumen of its own is as soft as one.
std::vector<TissueParameters> tissue_parameters(const Scenario& scenario, const TetMesh& mesh);

/// The elastic constants of every region.
std::vector<Material> materials_of(std::span<const TissueParameters> regions);

/// The element of the tissue. The methods of Goksel et al. 2005 are there for comparison, so all of them use linear
/// tetrahedra, which two of them need. Averaged pressure couples two rings of nodes; on meshes above some size its
/// factor does not fit into memory, and locking is small there (docs/theory/tissue.md).
Element element_of(const Scenario& scenario, Index nodes);

}  // namespace stylet
