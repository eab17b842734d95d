// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sizing.hpp"
#include "tetrahedraliser.hpp"

namespace stylet::meshing {

/// Points on every surface between two regions, from which meshing starts. They are dense enough for thin and small
/// structures, but not closer together than `spacing` × wanted edge length.
std::vector<SurfaceSeed> surface_seeds(const Anatomy& anatomy, const SizeField& size, double scale, double spacing);

}  // namespace stylet::meshing
