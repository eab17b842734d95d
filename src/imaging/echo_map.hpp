// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"
#include "stylet/sim/imaging_settings.hpp"

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace stylet {

/// Strength of the speckle around the gland, painted in the undeformed patient on a grid of voxels: the regions' values
/// with soft borders, and what regions do not have. That is texture at several scales, the layers of the rectal wall,
/// fasciae and veins around the gland, septa in fat and, where the mesh has no zones, an assumed transition zone with
/// calcifications along its border (docs/ultrasound.md).
class EchoMap {
 public:
  /// The map of a patient; empty for a mesh without a gland.
  /// @param echoes (regions)
  static std::optional<EchoMap> paint(const TetMesh& mesh, std::span<const TissueEcho> echoes, std::uint32_t seed);

  static constexpr double kVoxel_mm = 0.8;
  /// Levels are stored as whole numbers: level 0 is kDarkest_dB, each step is kStep_dB.
  static constexpr double kDarkest_dB = -70.0;
  static constexpr double kStep_dB = 0.5;
  /// Soft tissue stays below this level. Above it are calcifications, which cast a shadow.
  static constexpr float kCalcified = static_cast<float>((15.0 - kDarkest_dB) / kStep_dB);

  /// Transform of a material point [mm] LPS to a position on the grid.
  [[nodiscard]] Eigen::Vector3f position(const Vec3& x) const { return ((x - low_) / kVoxel_mm).cast<float>(); }
  [[nodiscard]] static Eigen::Vector3f difference(const Vec3& dx) { return (dx / kVoxel_mm).cast<float>(); }

  /// Level at a position on the grid; negative outside of the map.
  [[nodiscard]] float at(const Eigen::Vector3f& position) const;
  /// Level of the mean power at two positions; that of one if the other is outside, negative if both are.
  [[nodiscard]] float mean_power(const Eigen::Vector3f& a, const Eigen::Vector3f& b) const;

 private:
  EchoMap() = default;

  Vec3 low_ = Vec3::Zero();
  Eigen::Vector3i count_ = Eigen::Vector3i::Zero();
  std::vector<std::uint8_t> levels_;
  std::array<float, 256> above_mean_{};  ///< (difference of two levels) level of their mean power above their mean
};

}  // namespace stylet
