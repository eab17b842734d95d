// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/model_file.hpp"

/// What a model file looks like inside (docs/models.md): shared by its writer and its reader.
namespace stylet::detail {

inline constexpr int kModelFileVersion = 3;
inline constexpr const char* kModelFileFormat = "stylet-model";
inline constexpr const char* kModelExtension = ".stylet";
/// Columns of the compliance that are written and read together.
inline constexpr Eigen::Index kPanel = 64;
/// Numbers of a row of /motions/N: time, place, quaternion x y z w.
inline constexpr std::size_t kMotionNumbers = 8;

/// Digest of what the compliance of a corridor depends on: mesh, materials, supports, element, corridor.
std::string compliance_origin(const Tissue& tissue);

/// A motion as rows of numbers, and back.
std::vector<double> motion_rows(const std::vector<MotionSample>& motion);
std::vector<MotionSample> motion_of(const std::vector<double>& rows);

}  // namespace stylet::detail
