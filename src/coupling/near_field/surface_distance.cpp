// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/near_field/surface_distance.hpp"

#include <Eigen/Dense>
#include <unsupported/Eigen/BVH>

#include <numeric>

namespace stylet {

namespace {

using Box = Eigen::AlignedBox3d;

/// Barycentric weights of the point of a triangle that is nearest to x. @cite Ericson2005 section 5.1.5, by Voronoi
/// regions
Vec3 nearest_weights(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const double d1 = ab.dot(x - a);
  const double d2 = ac.dot(x - a);
  if (d1 <= 0.0 && d2 <= 0.0) return {1, 0, 0};
  const double d3 = ab.dot(x - b);
  const double d4 = ac.dot(x - b);
  if (d3 >= 0.0 && d4 <= d3) return {0, 1, 0};
  const double d5 = ab.dot(x - c);
  const double d6 = ac.dot(x - c);
  if (d6 >= 0.0 && d5 <= d6) return {0, 0, 1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return {1.0 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return {1.0 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1.0 - w, w};
  }
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

}  // namespace

struct SurfaceDistance::Tree {
  const std::vector<Vec3>* nodes = nullptr;
  std::vector<std::array<Index, 3>> triangles;
  std::vector<Vec3> normal;   ///< (n) at the nodes: mean of the triangles' normals, weighted by area
  std::vector<double> value;  ///< (n) mean of the quantity in the same way; or empty
  Eigen::KdBVH<double, 3, int> boxes;

  [[nodiscard]] Vec3 corner(int triangle, int k) const {
    return (
        *nodes)[static_cast<std::size_t>(triangles[static_cast<std::size_t>(triangle)][static_cast<std::size_t>(k)])];
  }
  [[nodiscard]] Vec3 weights(int triangle, const Vec3& x) const {
    return nearest_weights(x, corner(triangle, 0), corner(triangle, 1), corner(triangle, 2));
  }
  /// Unit normal out of the tissue.
  [[nodiscard]] Vec3 outwards(int triangle, const Vec3& w) const {
    Vec3 sum = Vec3::Zero();
    const auto& corners = triangles[static_cast<std::size_t>(triangle)];
    for (int k = 0; k < 3; ++k) sum += w[k] * normal[static_cast<std::size_t>(corners[static_cast<std::size_t>(k)])];
    return sum.normalized();
  }
  [[nodiscard]] Value value_at(int triangle, const Vec3& w) const {
    Value sum{0.0, triangle};
    const auto& corners = triangles[static_cast<std::size_t>(triangle)];
    for (int k = 0; k < 3; ++k)
      sum.value += w[k] * value[static_cast<std::size_t>(corners[static_cast<std::size_t>(k)])];
    return sum;
  }
  [[nodiscard]] Vec3 point(int triangle, const Vec3& w) const {
    return w[0] * corner(triangle, 0) + w[1] * corner(triangle, 1) + w[2] * corner(triangle, 2);
  }
};

namespace {

/// Search by Eigen::BVMinimize for the triangle with the least squared distance.
template <class Tree>
struct Nearest {
  using Scalar = double;
  const Tree* tree;
  Vec3 x;
  double best = std::numeric_limits<double>::infinity();
  int triangle = -1;

  [[nodiscard]] double minimumOnVolume(const Box& box) const { return box.squaredExteriorDistance(x); }
  double minimumOnObject(int candidate) {
    const double distance = (tree->point(candidate, tree->weights(candidate, x)) - x).squaredNorm();
    if (distance < best) {
      best = distance;
      triangle = candidate;
    }
    return distance;
  }
};

/// The same for surfaces that face `direction`: minimises the squared distance over the squared cosine between the
/// direction and the normal.
template <class Tree>
struct NearestFacing {
  using Scalar = double;
  const Tree* tree;
  Vec3 x;
  Vec3 direction;
  double best = std::numeric_limits<double>::infinity();
  int triangle = -1;

  [[nodiscard]] double minimumOnVolume(const Box& box) const { return box.squaredExteriorDistance(x); }
  double minimumOnObject(int candidate) {
    const Vec3 weights = tree->weights(candidate, x);
    const double cosine = tree->outwards(candidate, weights).dot(direction);
    if (cosine <= 0.0) return std::numeric_limits<double>::infinity();
    const double distance = (tree->point(candidate, weights) - x).squaredNorm() / (cosine * cosine);
    if (distance < best) {
      best = distance;
      triangle = candidate;
    }
    return distance;
  }
};

}  // namespace

SurfaceDistance::SurfaceDistance(const std::vector<Vec3>& nodes, std::vector<std::array<Index, 3>> triangles,
                                 const std::vector<double>& values)
    : tree_(std::make_unique<Tree>()) {
  Tree& tree = *tree_;
  tree.nodes = &nodes;
  tree.triangles = std::move(triangles);
  const auto count = static_cast<int>(tree.triangles.size());
  tree.normal.assign(nodes.size(), Vec3::Zero());
  std::vector<Box> boxes(tree.triangles.size());
  std::vector<double> areas(values.empty() ? 0 : nodes.size(), 0.0);
  tree.value.assign(areas.size(), 0.0);
  for (int t = 0; t < count; ++t) {
    const Vec3 area = (tree.corner(t, 1) - tree.corner(t, 0)).cross(tree.corner(t, 2) - tree.corner(t, 0));
    for (int k = 0; k < 3; ++k) {
      boxes[static_cast<std::size_t>(t)].extend(tree.corner(t, k));
      tree.normal[static_cast<std::size_t>(tree.triangles[static_cast<std::size_t>(t)][static_cast<std::size_t>(k)])] +=
          area;
      if (values.empty()) continue;
      const auto node =
          static_cast<std::size_t>(tree.triangles[static_cast<std::size_t>(t)][static_cast<std::size_t>(k)]);
      areas[node] += area.norm();
      tree.value[node] += area.norm() * values[static_cast<std::size_t>(t)];
    }
  }
  for (std::size_t node = 0; node < areas.size(); ++node) {
    if (areas[node] > 0.0) tree.value[node] /= areas[node];
  }
  for (Vec3& normal : tree.normal) normal.normalize();
  std::vector<int> numbers(tree.triangles.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  tree.boxes.init(numbers.begin(), numbers.end(), boxes.begin(), boxes.end());
}

SurfaceDistance::~SurfaceDistance() = default;
SurfaceDistance::SurfaceDistance(SurfaceDistance&&) noexcept = default;
SurfaceDistance& SurfaceDistance::operator=(SurfaceDistance&&) noexcept = default;

NearSurface SurfaceDistance::nearest(const Vec3& x, Value* value) const {
  if (tree_->triangles.empty()) return {};
  Nearest<Tree> search{.tree = tree_.get(), .x = x};
  const double distance = std::sqrt(Eigen::BVMinimize(tree_->boxes, search));
  const Vec3 weights = tree_->weights(search.triangle, x);
  if (value != nullptr) *value = tree_->value_at(search.triangle, weights);
  constexpr double on_surface_mm = 1e-9;
  if (distance > on_surface_mm) return {distance, (x - tree_->point(search.triangle, weights)) / distance};
  return {0.0, -tree_->outwards(search.triangle, weights)};
}

NearSurface SurfaceDistance::opposite(const Vec3& x, const Vec3& inwards, Value* value) const {
  if (tree_->triangles.empty()) return {};
  NearestFacing<Tree> search{.tree = tree_.get(), .x = x, .direction = inwards};
  const double distance = std::sqrt(Eigen::BVMinimize(tree_->boxes, search));
  if (search.triangle < 0) return {};
  const Vec3 weights = tree_->weights(search.triangle, x);
  if (value != nullptr) *value = tree_->value_at(search.triangle, weights);
  return {distance, -tree_->outwards(search.triangle, weights)};
}

}  // namespace stylet
