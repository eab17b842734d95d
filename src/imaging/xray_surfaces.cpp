// SPDX-License-Identifier: GPL-3.0-or-later
#include "xray_surfaces.hpp"

#include "stylet/geom/topology.hpp"
#include "stylet/imaging/xray_materials.hpp"
#include "stylet/sim/supports.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace stylet {

namespace {

/// Rows or columns that lie from a value on, within the picture.
int first_from(double value, int pixels) {
  return static_cast<int>(std::clamp(std::ceil(value), 0.0, static_cast<double>(pixels)));
}

/// An edge of a triangle in the picture, from its upper end down. Triangles that share an edge compute the same columns
/// for it, so that each ray crosses exactly one of them.
template <class Vertex>
struct FallingEdge {
  FallingEdge(const Vertex& from, const Vertex& to) : top(from) {
    const double per_row = 1.0 / (to.row - from.row);
    column_step = per_row * (to.column - from.column);
    nearer_step = per_row * (to.nearer - from.nearer);
    shell_step = per_row * (to.shell - from.shell);
  }
  [[nodiscard]] Vertex at(int row) const {
    const double down = row - top.row;
    return {top.column + down * column_step, static_cast<double>(row), top.nearer + down * nearer_step,
            top.shell + down * shell_step};
  }
  Vertex top;
  double column_step = 0.0, nearer_step = 0.0, shell_step = 0.0;
};

}  // namespace

XraySurfaces::XraySurfaces(const TetMesh& mesh, const FluoroscopySettings& settings) {
  std::vector<double> attenuation(mesh.regions.size());
  std::vector<bool> bone(mesh.regions.size());
  for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
    attenuation[r] = region_attenuation_per_mm(mesh.regions[r], settings);
    bone[r] = is_bone(mesh.regions[r]);
  }
  cortex_ = kCortex_mm * (attenuation_per_mm(XrayMaterial::cortical_bone, settings.energy_keV) -
                          spongy_bone_per_mm(settings.energy_keV));
  const auto region_of = [&](Index tet) {
    return static_cast<std::size_t>(mesh.tet_region[static_cast<std::size_t>(tet)]);
  };
  const auto node_at = [&](Index node) -> const Vec3& { return mesh.nodes[static_cast<std::size_t>(node)]; };

  std::vector<Index> corner_of(mesh.nodes.size(), -1);
  std::map<Index, Vec3> normal_of;  // of the bones' nodes, weighted by the areas of the faces around them
  std::vector<std::array<Index, 3>> bone_faces;
  const auto take = [&](const Face& face) {
    const std::size_t inside = region_of(face.tet);
    const bool outer = face.neighbour < 0;
    const std::size_t outside = outer ? inside : region_of(face.neighbour);
    Triangle triangle{face.nodes, attenuation[inside] - (outer ? 0.0 : attenuation[outside]), -1};
    const bool bone_inside = bone[inside];
    const bool is_bone_face = bone_inside != (!outer && bone[outside]);
    if (triangle.step_per_mm == 0.0 && !is_bone_face) return;
    if (is_bone_face) {
      const Vec3 area =
          (node_at(face.nodes[1]) - node_at(face.nodes[0])).cross(node_at(face.nodes[2]) - node_at(face.nodes[0]));
      for (const Index node : face.nodes) normal_of.try_emplace(node, Vec3::Zero()).first->second += area;
      triangle.bone = static_cast<Index>(3 * bone_faces.size());
      bone_faces.push_back(face.nodes);
    }
    for (Index& corner : triangle.corners) {
      Index& number = corner_of[static_cast<std::size_t>(corner)];
      if (number < 0) {
        number = static_cast<Index>(nodes_.size());
        nodes_.push_back(corner);
        at_rest_.push_back(node_at(corner));
      }
      corner = number;
    }
    triangles_.push_back(triangle);
  };
  const Topology topology(mesh);
  for (const Face& face : topology.boundary) take(face);
  for (const Face& face : topology.interfaces) take(face);
  for (const std::array<Index, 3>& face : bone_faces) {
    for (const Index node : face) bone_normals_.push_back(normal_of.at(node).normalized());
  }
  corners_.resize(nodes_.size());
}

void XraySurfaces::add(const XrayGeometry& unit, const Eigen::Matrix3Xf& displacement, std::span<float> sums) {
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const auto place = unit.place(at_rest_[k] + displacement.col(nodes_[k]).cast<double>());
    corners_[k] = {place.column, place.row, 1.0 - unit.source_distance_mm / place.depth_mm};
  }
  for (const Triangle& triangle : triangles_) add_triangle(triangle, unit, sums);
}

/// μ · length of the cortex at a corner, along the central ray. The cortex of a curved bone is met at grazing angles
/// over a few times its thickness only.
double XraySurfaces::shell_at(const Triangle& triangle, int corner, const XrayGeometry& unit) const {
  constexpr double kSteepest = 0.25;
  const Corner& at = corners_[static_cast<std::size_t>(triangle.corners[static_cast<std::size_t>(corner)])];
  const Vec3& normal = bone_normals_[static_cast<std::size_t>(triangle.bone + corner)];
  const Vec3 ray = unit.ray(at.column, at.row);
  return cortex_ / std::max(std::abs(normal.dot(ray)), kSteepest * ray.norm());
}

void XraySurfaces::add_triangle(const Triangle& triangle, const XrayGeometry& unit, std::span<float> sums) {
  const bool bone = triangle.bone >= 0;
  std::array<Vertex, 3> v{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Corner& corner = corners_[static_cast<std::size_t>(triangle.corners[k])];
    v[k] = {corner.column, corner.row, corner.nearer, 0.0};
  }
  // Sort by rows. Each exchange of two corners turns the triangle around.
  bool turned = false;
  const auto order = [&](std::size_t a, std::size_t b) {
    if (v[b].row >= v[a].row) return;
    std::swap(v[a], v[b]);
    turned = !turned;
  };
  std::array<double, 3> shells{};
  if (bone) {
    for (std::size_t k = 0; k < 3; ++k) shells[k] = shell_at(triangle, static_cast<int>(k), unit);
    for (std::size_t k = 0; k < 3; ++k) v[k].shell = shells[k];
  }
  order(0, 1);
  order(1, 2);
  order(0, 1);
  const int first_row = first_from(v[0].row, unit.pixels);
  const int end_row = first_from(v[2].row, unit.pixels);
  if (first_row >= end_row) return;
  const int middle_row = first_from(v[1].row, unit.pixels);
  // A triangle whose corners run clockwise in the picture is seen from inside the picture's side: rays enter there.
  const double step = (turned ? -1.0 : 1.0) * triangle.step_per_mm * unit.source_distance_mm;
  const FallingEdge<Vertex> whole(v[0], v[2]);
  for (int part = 0; part < 2; ++part) {
    const int begin = part == 0 ? first_row : middle_row;
    const int end = part == 0 ? middle_row : end_row;
    if (begin >= end) continue;
    const FallingEdge<Vertex> half(v[static_cast<std::size_t>(part)], v[static_cast<std::size_t>(part) + 1]);
    for (int row = begin; row < end; ++row) {
      Vertex left = whole.at(row);
      Vertex right = half.at(row);
      double sign = -step;
      if (right.column < left.column) {
        std::swap(left, right);
        sign = step;
      }
      const int first = first_from(left.column, unit.pixels);
      const int count = first_from(right.column, unit.pixels) - first;
      if (count <= 0) continue;
      const double per_column = 1.0 / (right.column - left.column);
      const double nearer_step = per_column * (right.nearer - left.nearer);
      const auto nearer = static_cast<float>(left.nearer + (first - left.column) * nearer_step);
      const auto nearer_per_column = static_cast<float>(nearer_step);
      const auto factor = static_cast<float>(sign);
      float* sum = &sums[static_cast<std::size_t>(row) * static_cast<std::size_t>(unit.pixels) +
                         static_cast<std::size_t>(first)];
      for (int k = 0; k < count; ++k) {
        const float e = nearer + static_cast<float>(k) * nearer_per_column;
        sum[k] += factor * e / (1.0F - e);
      }
      if (!bone) continue;
      const double shell_step = per_column * (right.shell - left.shell);
      const auto shell = static_cast<float>(left.shell + (first - left.column) * shell_step);
      const auto shell_per_column = static_cast<float>(shell_step);
      for (int k = 0; k < count; ++k) sum[k] += shell + static_cast<float>(k) * shell_per_column;
    }
  }
}

}  // namespace stylet
