// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"

#include <string>

/// How far from the scanner's origin, how fine and how large a patient's data may be. Generous for what scanners
/// produce, and far within what geometry can be computed with: at 1e5 mm a double still resolves 1e-11 mm.
namespace stylet::detail {

inline constexpr double kFarthest_mm = 1e5;       ///< |x|, |y|, |z| of any point
inline constexpr double kFinestVoxel_mm = 1e-3;   ///< between neighbouring voxels
inline constexpr double kCoarsestVoxel_mm = 100;  ///< between neighbouring voxels
inline constexpr double kLongestImage_mm = 1e4;   ///< along an image axis

/// Whether a position [mm] LPS is finite and in reach.
bool is_in_reach(const Vec3& position);

/// Refuses a position that is not finite or out of reach.
/// @param where file, and field or place in it
/// @param position [mm] LPS
/// @param name what lies there, e.g. "the origin"
Result<> check_reach(const std::string& where, const Vec3& position, const std::string& name);

}  // namespace stylet::detail
