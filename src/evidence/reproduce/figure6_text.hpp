// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/evidence/reproduce/figure6.hpp"
#include "stylet/measure/remesh_cost.hpp"

#include <string>

/// What the page says of figure 6, as HTML; every statement about this run is computed from it.
namespace stylet::reproduce {

/// What is done, and by which variants.
std::string figure6_intro(const Figure6& figure);

/// Times of iterations with and without changes of the mesh.
/// @param inside what one of the default's changes costs by itself
std::string cumulative_caption(const Figure6& figure, const measure::RemeshCost& inside);

/// Features of the force curves, peaks, and how far the variants differ.
/// @param organ region whose puncture counts as the penetration of the target
std::string forces_caption(const Figure6& figure, const std::string& organ);

/// Order of ΔK, and why nodes were not moved.
std::string dimensions_caption(const Figure6& figure);

}  // namespace stylet::reproduce
