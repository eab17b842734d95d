// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/io/recording_io.hpp"

#include <filesystem>
#include <functional>

/// The files for ParaView and 3D Slicer.
namespace stylet::results {

/// Writes tissue_0000.vtu … for all frames, and tissue.pvd with their times. Positions are those of the undeformed
/// tissue; arrays are displacement_mm (3 × nodes), region and, if `stress_of` is given, stress_kPa (6 × tets).
/// @param stress_of function that computes the stress [MPa] (6 × tets) xx yy zz xy yz zx of a displacement [mm] (3n);
///   may be empty
Result<> write_tissue(const RunRecording& run, const std::function<MatX(const VecX&)>& stress_of,
                      const std::filesystem::path& folder, const Progress& progress);

/// Writes needle_0000.vtp … for all frames, needle.pvd with their times, and needle.vtp with the deepest frame.
/// @param deepest index of the deepest frame
Result<> write_needle(const RunRecording& run, std::size_t deepest, const std::filesystem::path& folder);

}  // namespace stylet::results
