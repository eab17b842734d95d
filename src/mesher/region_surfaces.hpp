// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "anatomy.hpp"
#include "stylet/geom/surface.hpp"

namespace stylet::meshing {

/// The surfaces of the structures as they were given, for pictures: smooth, whatever the size of the mesh's elements.
/// Each is closed and oriented, and shares no point with another one. What belongs inside a structure, as the urethra
/// does in the gland and everything in fat and body, is not cut out of it: where surfaces overlap, the structure of
/// higher priority is meant.
/// @param regions names of the structures, in the order of the result
std::vector<Surface> region_surfaces(const Anatomy& anatomy, std::span<const std::string> regions,
                                     const Progress& progress);

}  // namespace stylet::meshing
