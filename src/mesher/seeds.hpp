// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sizing.hpp"
#include "tetrahedraliser.hpp"

namespace stylet::meshing {

/// Points on every surface between two regions, dense enough that no thin or small structure is missed, and no closer
/// than `spacing` wanted edge lengths.
std::vector<SurfaceSeed> surface_seeds(const Anatomy& anatomy, const SizeField& size, double scale, double spacing);

}  // namespace stylet::meshing
