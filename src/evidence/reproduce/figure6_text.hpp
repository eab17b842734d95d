// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/evidence/reproduce/figure6.hpp"
#include "stylet/measure/remesh_cost.hpp"

#include <string>

/// The text of the page about figure 6, as HTML. Every statement about the run is computed from its data.
namespace stylet::reproduce {

/// Describes the insertions and the variants.
std::string figure6_intro(const Figure6& figure);

/// Describes the times of iterations with and without changes of the mesh.
/// @param inside times of a single change of the mesh with the default's rule
std::string cumulative_caption(const Figure6& figure, const measure::RemeshCost& inside);

/// Describes the features of the force curves, their peaks, and the differences between the variants.
/// @param organ region whose puncture counts as the penetration of the target
std::string forces_caption(const Figure6& figure, const std::string& organ);

/// Describes the order of ΔK and the reasons why nodes were not moved.
std::string dimensions_caption(const Figure6& figure);

}  // namespace stylet::reproduce
