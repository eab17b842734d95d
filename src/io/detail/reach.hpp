// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"

#include <string>

/// Limits on the coordinates, the resolution and the size of a patient's data. They are generous for scanners and safe
/// for geometric computations: at 1e5 mm a double still resolves 1e-11 mm.
namespace stylet::detail {

inline constexpr double kFarthest_mm = 1e5;       ///< largest |x|, |y|, |z| of any point
inline constexpr double kFinestVoxel_mm = 1e-3;   ///< smallest distance between neighbouring voxels
inline constexpr double kCoarsestVoxel_mm = 100;  ///< largest distance between neighbouring voxels
inline constexpr double kLongestImage_mm = 1e4;   ///< largest length along an image axis

/// Whether a position [mm] LPS is finite and in reach.
bool is_in_reach(const Vec3& position);

/// Error if a position is not finite or out of reach.
/// @param where file, and field or place in it, for the message
/// @param position [mm] LPS
/// @param name of the point in the message, e.g. "the origin"
Result<> check_reach(const std::string& where, const Vec3& position, const std::string& name);

}  // namespace stylet::detail
