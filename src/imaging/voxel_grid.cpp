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

std::vector<float> VoxelGrid::distance_mm(const std::function<bool(int)>& chosen) const {
  struct Step {
    int i, j, k;
    float length;
  };
  std::vector<float> distance(size(), 1e6F);
  for (std::size_t v = 0; v < size(); ++v) {
    if (chosen(regions_[v])) distance[v] = 0.0F;
  }
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
  const auto relax = [&](int i, int j, int k, int sign) {
    float& here = distance[index(i, j, k)];
    for (const Step& s : steps) {
      const int a = i + sign * s.i, b = j + sign * s.j, c = k + sign * s.k;
      if (a < 0 || b < 0 || c < 0 || a >= count_.x() || b >= count_.y() || c >= count_.z()) continue;
      here = std::min(here, distance[index(a, b, c)] + s.length);
    }
  };
  for (int k = 0; k < count_.z(); ++k)
    for (int j = 0; j < count_.y(); ++j)
      for (int i = 0; i < count_.x(); ++i) relax(i, j, k, 1);
  for (int k = count_.z() - 1; k >= 0; --k)
    for (int j = count_.y() - 1; j >= 0; --j)
      for (int i = count_.x() - 1; i >= 0; --i) relax(i, j, k, -1);
  return distance;
}

}  // namespace stylet
