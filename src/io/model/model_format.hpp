// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/model_file.hpp"

/// The format of a model file (docs/models.md), shared by its writer and its reader.
namespace stylet::detail {

inline constexpr int kModelFileVersion = 4;
inline constexpr const char* kModelFileFormat = "stylet-model";
inline constexpr const char* kModelExtension = ".stylet";
/// Number of columns of the compliance that are written and read at once.
inline constexpr Eigen::Index kPanel = 64;
/// Number of values in a row of /motions/N: time, position, quaternion x y z w.
inline constexpr std::size_t kMotionNumbers = 8;

/// Digest of the data on which the compliance of a corridor depends: mesh, materials, supports, element, corridor.
std::string compliance_origin(const Tissue& tissue);

/// Converts a motion to rows of numbers, and back.
std::vector<double> motion_rows(const std::vector<MotionSample>& motion);
std::vector<MotionSample> motion_of(const std::vector<double>& rows);

}  // namespace stylet::detail
