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

  /// Distance of each voxel from the nearest voxel whose region is chosen [mm], by steps to the 26 neighbours; exact
  /// within 8 %.
  /// @param chosen gets the region's number, or -1
  [[nodiscard]] std::vector<float> distance_mm(const std::function<bool(int)>& chosen) const;

 private:
  void fill(const TetMesh& mesh, std::size_t tet);

  Vec3 low_;
  double voxel_mm_;
  Eigen::Vector3i count_;
  std::vector<std::int16_t> regions_;
};

}  // namespace stylet
