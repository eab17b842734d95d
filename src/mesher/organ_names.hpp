// SPDX-License-Identifier: GPL-3.0-or-later
// The names of organs in several languages.
#pragma once

#include <string>
#include <string_view>

namespace stylet::meshing {

/// Letters and digits of a name, folded (geom/structure_names.hpp) and in lower case: "Femoral Head_Lt" →
/// "femoralheadlt", "Harnröhre" → "harnrohre".
std::string plain(std::string_view name);

/// The region of an organ; empty if the name is no organ's.
/// @param plain_name whole name as plain() gives it
std::string_view organ_named(std::string_view plain_name);

/// The side of a femoral head: "femur_left" or "femur_right"; empty for other names and without a side.
std::string femur_named(std::string_view name);

/// A zone of the gland, or one half of it, as users of 3D Slicer and the coded terms of DICOM write it: "peripheral",
/// "PZ_left", "Transition Zone", "Structure of peripheral zone of prostate", "AFS".
std::string_view zone_named(std::string_view name);

/// "left", "right" or "", by the words of a name.
std::string_view side_of(std::string_view name);

}  // namespace stylet::meshing
