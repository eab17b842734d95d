// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/tet_mesh.hpp"

#include <Eigen/Geometry>

#include <cstdint>
#include <functional>
#include <vector>

namespace stylet {

/// A grid of voxels in the undeformed patient, with the region of each.
class VoxelGrid {
 public:
  VoxelGrid(const TetMesh& mesh, const Eigen::AlignedBox3d& box, double voxel_mm);

  [[nodiscard]] const Vec3& low() const { return low_; }
  [[nodiscard]] const Eigen::Vector3i& count() const { return count_; }
  [[nodiscard]] std::size_t size() const { return regions_.size(); }
  [[nodiscard]] std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(count_.y()) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(count_.x()) +
           static_cast<std::size_t>(i);
  }
  [[nodiscard]] Vec3 centre(int i, int j, int k) const { return low_ + voxel_mm_ * Vec3(i, j, k); }
  /// Region of a voxel's centre; -1 outside of the mesh.
  [[nodiscard]] int region(std::size_t voxel) const { return regions_[voxel]; }

  /// Depth of each voxel's centre below the surface of the chosen regions [mm], negative outside of them; between
  /// −reach and reach. Smooth, and exact within 8 %.
  /// @param chosen gets the region's number, or -1
  [[nodiscard]] std::vector<float> depth_mm(const std::function<bool(int)>& chosen, double reach_mm) const;

  /// Smooths a field (voxels) by the weights 1, 2, 1 along each axis, except in regions that are kept.
  /// @param kept gets the region's number, or -1
  void smooth(std::vector<float>& field, const std::function<bool(int)>& kept) const;

 private:
  /// Voxels from first to last along each axis.
  struct Block {
    Eigen::Vector3i first, last;
  };
  void fill(const TetMesh& mesh, std::size_t tet);
  /// Distance of the block's voxels from the nearest one that is 0, by steps to the 26 neighbours. @param field 0 or
  /// more
  void spread_distance(std::vector<float>& field, const Block& block) const;
  template <class Kept>
  void smooth(std::vector<float>& field, const Block& block, Kept&& kept) const;

  Vec3 low_;
  double voxel_mm_;
  Eigen::Vector3i count_;
  std::vector<std::int16_t> regions_;
};

}  // namespace stylet
