// SPDX-License-Identifier: GPL-3.0-or-later
#include "voxel_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace stylet {

VoxelGrid::VoxelGrid(const TetMesh& mesh, const Eigen::AlignedBox3d& box, double voxel_mm)
    : low_(box.min()), voxel_mm_(voxel_mm) {
  count_ = (box.sizes() / voxel_mm).array().ceil().cast<int>() + 1;
  regions_.assign(static_cast<std::size_t>(count_.x()) * static_cast<std::size_t>(count_.y()) *
                      static_cast<std::size_t>(count_.z()),
                  -1);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) fill(mesh, t);
}

void VoxelGrid::fill(const TetMesh& mesh, std::size_t tet) {
  const auto& corners = mesh.tets[tet];
  const Eigen::Matrix<double, 3, 4> gradients = barycentric_gradients(mesh, static_cast<Index>(tet));
  const Vec3 first = mesh.nodes[static_cast<std::size_t>(corners[0])];
  Eigen::AlignedBox3d box;
  for (const Index node : corners) box.extend(mesh.nodes[static_cast<std::size_t>(node)]);
  const Eigen::Vector3i from = ((box.min() - low_) / voxel_mm_).array().ceil().max(0.0).cast<int>();
  const Eigen::Vector3i to =
      ((box.max() - low_) / voxel_mm_).array().floor().min((count_.array() - 1).cast<double>()).cast<int>();
  for (int k = from.z(); k <= to.z(); ++k) {
    for (int j = from.y(); j <= to.y(); ++j) {
      for (int i = from.x(); i <= to.x(); ++i) {
        Vec4 weights = gradients.transpose() * (centre(i, j, k) - first);
        weights[0] += 1.0;
        if (weights.minCoeff() >= -1e-9) regions_[index(i, j, k)] = static_cast<std::int16_t>(mesh.tet_region[tet]);
      }
    }
  }
}

void VoxelGrid::spread_distance(std::vector<float>& field, const Block& block) const {
  struct Step {
    int i, j, k;
    float length;
  };
  std::array<Step, 13> steps{};  // to the neighbours that come earlier in the order of voxels
  std::size_t n = 0;
  for (int k = -1; k <= 0; ++k) {
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) {
        if (k < 0 || j < 0 || (j == 0 && i < 0)) {
          steps[n++] = {i, j, k, static_cast<float>(voxel_mm_ * std::sqrt(i * i + j * j + k * k))};
        }
      }
    }
  }
  const Eigen::Vector3i &from = block.first, &to = block.last;
  const auto relax = [&](int i, int j, int k, int sign) {
    float& here = field[index(i, j, k)];
    for (const Step& s : steps) {
      const int a = i + sign * s.i, b = j + sign * s.j, c = k + sign * s.k;
      if (a < from.x() || b < from.y() || c < from.z() || a > to.x() || b > to.y() || c > to.z()) continue;
      here = std::min(here, field[index(a, b, c)] + s.length);
    }
  };
  for (int k = from.z(); k <= to.z(); ++k)
    for (int j = from.y(); j <= to.y(); ++j)
      for (int i = from.x(); i <= to.x(); ++i) relax(i, j, k, 1);
  for (int k = to.z(); k >= from.z(); --k)
    for (int j = to.y(); j >= from.y(); --j)
      for (int i = to.x(); i >= from.x(); --i) relax(i, j, k, -1);
}

std::vector<float> VoxelGrid::depth_mm(const std::function<bool(int)>& chosen, double reach_mm) const {
  const auto reach = static_cast<float>(reach_mm);
  std::vector<float> depth(size(), -reach);
  Block block{count_, Eigen::Vector3i::Constant(-1)};  // around the chosen voxels
  for (int k = 0; k < count_.z(); ++k) {
    for (int j = 0; j < count_.y(); ++j) {
      for (int i = 0; i < count_.x(); ++i) {
        if (!chosen(regions_[index(i, j, k)])) continue;
        depth[index(i, j, k)] = reach;
        block.first = block.first.cwiseMin(Eigen::Vector3i(i, j, k));
        block.last = block.last.cwiseMax(Eigen::Vector3i(i, j, k));
      }
    }
  }
  if (block.last.x() < 0) return depth;
  const int margin = static_cast<int>(std::ceil(reach_mm / voxel_mm_));
  block.first = (block.first.array() - margin).max(0).matrix();
  block.last = (block.last.array() + margin).min(count_.array() - 1).matrix();
  std::vector<float> inside(depth), outside(depth);
  for (std::size_t v = 0; v < size(); ++v) {
    inside[v] = depth[v] > 0.0F ? reach : 0.0F;
    outside[v] = depth[v] > 0.0F ? 0.0F : reach;
  }
  spread_distance(inside, block);
  spread_distance(outside, block);
  // The surface lies in the middle between two voxels.
  const auto half = static_cast<float>(0.5 * voxel_mm_);
  for (std::size_t v = 0; v < size(); ++v)
    depth[v] = inside[v] > 0.0F ? std::min(reach, inside[v] - half) : std::max(-reach, half - outside[v]);
  smooth(depth, block, [](std::size_t) { return false; });
  return depth;
}

void VoxelGrid::smooth(std::vector<float>& field, const std::function<bool(int)>& kept) const {
  smooth(field, {Eigen::Vector3i::Zero(), (count_.array() - 1).matrix()},
         [&](std::size_t v) { return kept(regions_[v]); });
}

template <class Kept>
void VoxelGrid::smooth(std::vector<float>& field, const Block& block, Kept&& kept) const {
  const std::array<std::size_t, 3> strides{1, index(0, 1, 0), index(0, 0, 1)};
  std::vector<float> before;
  for (int axis = 0; axis < 3; ++axis) {
    before = field;
    const std::size_t d = strides[static_cast<std::size_t>(axis)];
    for (int k = block.first.z(); k <= block.last.z(); ++k) {
      for (int j = block.first.y(); j <= block.last.y(); ++j) {
        for (int i = block.first.x(); i <= block.last.x(); ++i) {
          const int at = axis == 0 ? i : axis == 1 ? j : k;
          const std::size_t v = index(i, j, k);
          if (at == block.first[axis] || at == block.last[axis] || kept(v)) continue;
          field[v] = 0.25F * before[v - d] + 0.5F * before[v] + 0.25F * before[v + d];
        }
      }
    }
  }
}

}  // namespace stylet
