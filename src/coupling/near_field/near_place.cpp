// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/near_field/near_place.hpp"

#include <algorithm>

namespace stylet {

namespace {

/// Beyond so many edges the mesh represents the field as it is: what is left is its error of interpolation, of relative
/// size (edge / distance)² / 8.
constexpr double kMostEdges = 5.0;

/// Size of the elements, the free surface and the share that is not held, as the nodes have them.
template <class NodeAt>
void describe_surroundings(const Tissue& tissue, const MeshKernel& kernel, int count, const NodeAt& node_at,
                           NearPlace& place) {
  const bool has_skin = std::isfinite(kernel.skin(node_at(0).first).depth);
  place.skin = {0.0, Vec3::Zero(), 0.0};
  place.moves = 0.0;
  for (int i = 0; i < count; ++i) {
    const auto [node, weight] = node_at(i);
    place.edge += weight * kernel.edge(node);
    if (!tissue.is_fixed(node)) place.moves += weight;
    if (!has_skin) continue;
    const NearSurface& there = kernel.skin(node);
    place.skin.depth += weight * there.depth;
    place.skin.inwards += weight * there.inwards;
    place.skin.share += weight * there.share;
  }
  place.moves = std::clamp(place.moves, 0.0, 1.0);
  place.skin.inwards.normalize();
  place.skin.depth = std::max(0.0, place.skin.depth);
  if (!has_skin) place.skin = {};
}

bool touch(const MeshKernel& kernel, const Shape& at, const Shape& on) {
  for (int i = 0; i < at.count; ++i) {
    for (int j = 0; j < on.count; ++j) {
      if (kernel.neighbours(at.node[static_cast<std::size_t>(i)], on.node[static_cast<std::size_t>(j)])) return true;
    }
  }
  return false;
}

}  // namespace

NearPlace near_place(const Tissue& tissue, const MeshKernel& kernel, const MaterialPoint& at, const Vec3& x) {
  const int region = tissue.mesh().tet_region[static_cast<std::size_t>(at.tet)];
  NearPlace place;
  place.shape = tissue.shape(at.tet, at.weights);
  place.piece.centre = x;
  place.medium = kernel.medium_of(region);
  place.young_MPa = tissue.material(region).young_MPa;
  const auto& corners = tissue.mesh().tets[static_cast<std::size_t>(at.tet)];
  describe_surroundings(
      tissue, kernel, 4,
      [&](int i) {
        return std::pair{corners[static_cast<std::size_t>(i)], static_cast<double>(at.weights[i])};
      },
      place);
  return place;
}

NearPlace passive_place(const Tissue& tissue, const MeshKernel& kernel, const Shape& between, const Vec3& x) {
  NearPlace place;
  place.shape = between;
  place.piece.centre = x;
  describe_surroundings(
      tissue, kernel, between.count,
      [&](int i) {
        return std::pair{between.node[static_cast<std::size_t>(i)], between.weight[static_cast<std::size_t>(i)]};
      },
      place);
  return place;
}

NearPlace acted_on_by(NearPlace here, const NearPlace& on) {
  here.epsilon = on.epsilon;
  here.medium = on.medium;
  here.young_MPa = on.young_MPa;
  return here;
}

bool needs_correction(const MeshKernel& kernel, const NearPlace& at, const NearPlace& on) {
  const double edge = 0.5 * (at.edge + on.edge);
  const double distance2 = (at.piece.centre - on.piece.centre).squaredNorm();
  if (distance2 > kMostEdges * kMostEdges * edge * edge) return false;
  if (at.moves * on.moves == 0.0) return false;
  return distance2 >= edge * edge || touch(kernel, at.shape, on.shape);
}

Mat3 mesh_kernel_between(const MeshKernel& kernel, const Shape& at, const Shape& on, int medium) {
  Mat3 sum = Mat3::Zero();
  for (int i = 0; i < at.count; ++i) {
    for (int j = 0; j < on.count; ++j) {
      const auto a = static_cast<std::size_t>(i);
      const auto b = static_cast<std::size_t>(j);
      const double weight = at.weight[a] * on.weight[b];
      if (weight != 0.0) sum += weight * kernel(at.node[a], on.node[b], medium);
    }
  }
  return sum;
}

}  // namespace stylet
