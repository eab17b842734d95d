// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/mesher/mesher.hpp"

namespace stylet {

/// Meshes contours as mesh_contours() does. If the environment variable STYLET_CACHE names a folder, the mesh is kept
/// there, and taken from there when this program meshes the same input with the same options again. What cannot be read
/// or written there is made anew and not kept.
Result<MeshedAnatomy> mesh_once(const ContourSet& contours, const MeshOptions& options, const Progress& progress);

/// The same for a label mask; otherwise as mesh_labels().
Result<MeshedAnatomy> mesh_once(const LabelImage& image, const MeshOptions& options, const Progress& progress);

}  // namespace stylet
